#include "sample/names/method_spec.h"

namespace trapeze {
namespace {

std::string in_quotes(std::string_view text) {
    return "\"" + std::string(text) + "\"";
}

/// For messages: words with commas between.
template <class Words>
std::string joined(const Words& words) {
    std::string text;
    for (const std::string_view word : words) text += (text.empty() ? "" : ", ") + std::string(word);
    return text;
}

/// Takes the text before a separator, or all; the rest stays.
std::string_view take_until(char separator, std::string_view& rest) {
    const size_t at = rest.find(separator);
    const std::string_view taken = rest.substr(0, at);
    rest = at == std::string_view::npos ? std::string_view() : rest.substr(at + 1);
    return taken;
}

}  // namespace

/// Text is "name" or "name:key=value,key=value"; which names and keys there are is not looked at here.
std::optional<MethodSpec> parse_spec(std::string_view text, std::string* error) {
    MethodSpec spec;
    std::string_view rest = text;
    spec.name = take_until(':', rest);
    while (!rest.empty()) {
        std::string_view value = take_until(',', rest);
        const size_t equals = value.find('=');
        if (equals == std::string_view::npos || equals == 0) {
            *error = in_quotes(value) + " in " + in_quotes(text) + " is not of the form key=value";
            return {};
        }
        const std::string_view key = take_until('=', value);
        if (!spec.options.emplace(key, value).second) {
            *error = "option " + in_quotes(key) + " is given twice in " + in_quotes(text);
            return {};
        }
    }
    return spec;
}

/// Checks what was given, then adds the defaults, an option's first value: later stages find every option
/// there.
bool complete_spec(MethodSpec& spec, const std::vector<SpecOption>& options, std::string* error) {
    for (const auto& [key, value] : spec.options) {
        const SpecOption* option = find_named(options, key);
        if (!option) {
            std::vector<std::string_view> names;
            for (const SpecOption& o : options) names.push_back(o.name);
            *error = in_quotes(spec.name) + " has no option " + in_quotes(key) +
                     (names.empty() ? std::string() : "; it has: " + joined(names));
            return false;
        }
        if (std::find(option->values.begin(), option->values.end(), value) == option->values.end()) {
            *error = "option " + in_quotes(key) + " of " + in_quotes(spec.name) + " is one of " +
                     joined(option->values) + ", not " + in_quotes(value);
            return false;
        }
    }
    for (const SpecOption& option : options)
        spec.options.emplace(option.name, option.values.front());  // keeps what was given
    return true;
}

/// In the table's order, whatever the order was in which options were given: equal specs have equal texts, by
/// which results are filed.
std::string spec_text(const MethodSpec& spec, const std::vector<SpecOption>& options) {
    std::string text = spec.name;
    char separator = ':';
    for (const SpecOption& option : options) {
        const std::string& value = spec[option.name];
        if (value == option.values.front()) continue;
        text += separator + std::string(option.name) + "=" + value;
        separator = ',';
    }
    return text;
}

std::string unknown_name(std::string_view kind, std::string_view name,
                         const std::vector<std::string_view>& names) {
    return "no " + std::string(kind) + " " + in_quotes(name) + "; there are: " + joined(names);
}

}  // namespace trapeze
