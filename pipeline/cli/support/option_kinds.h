/// Kinds of option values, which say their limits when a value is not of them.
#pragma once

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cctype>
#include <charconv>
#include <string>

namespace trapeze {

/// A number from low to high, both included; never NaN.
template <class Number>
CLI::Validator in_range(Number low, Number high) {
    const auto text_of = [](Number value) {
        char text[64];
        return std::string(text, std::to_chars(text, text + sizeof text, value).ptr);
    };
    const std::string limits = " from " + text_of(low) + " to " + text_of(high);
    const std::string what = (std::is_integral_v<Number> ? "a whole number" : "a number") + limits;
    return CLI::Validator(
        [=](std::string& text) {
            Number value{};
            const char* const first = text.data() + (text.size() > 1 && text[0] == '+' ? 1 : 0);
            const auto [end, error] = std::from_chars(first, text.data() + text.size(), value);
            const bool is_right =
                error == std::errc() && end == text.data() + text.size() && value >= low && value <= high;
            return is_right ? std::string() : "\"" + text + "\" is not " + what;
        },
        "in [" + text_of(low) + ", " + text_of(high) + "]");
}

/// A text that is not empty, such as the name of a file or folder.
inline CLI::Validator a_name() {
    return CLI::Validator(
        [](std::string& text) { return text.empty() ? std::string("must not be empty") : std::string(); },
        "");
}

/// A macro for the RIB or the shader, as NAME or NAME=TEXT; NAME is an identifier of C.
inline CLI::Validator a_macro() {
    return CLI::Validator(
        [](std::string& text) {
            const std::string name = text.substr(0, text.find('='));
            const auto is_part = [](unsigned char c) { return std::isalnum(c) != 0 || c == '_'; };
            const bool is_right = !name.empty() && std::isdigit(static_cast<unsigned char>(name[0])) == 0 &&
                                  std::all_of(name.begin(), name.end(), is_part);
            return is_right ? std::string() : "\"" + name + "\" is no name of a macro";
        },
        "");
}

/// Adds an option whose text one of parse_values.h's functions reads into `value`. `form` says in --help and
/// in errors what is read, `limits` within which limits.
template <class Value, class Parse>
CLI::Option* add_parsed(CLI::App& app, const std::string& name, Value& value, Parse parse,
                        const std::string& help, const std::string& form, const std::string& limits = {}) {
    return app
        .add_option_function<std::string>(
            name,
            [&value, parse, name, form, limits](const std::string& text) {
                const auto parsed = parse(text);
                if (!parsed)
                    throw CLI::ValidationError(name.substr(name.rfind("--")),
                                               "\"" + text + "\" is not " + form + limits);
                value = *parsed;
            },
            help)
        ->type_name(form);
}

}  // namespace trapeze
