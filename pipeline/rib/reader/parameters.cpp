/// Parameter lists: name and value pairs at the end of requests.
#include <algorithm>

#include "pipeline/rib/reader/reader.h"

namespace trapeze::rib {
namespace {

constexpr size_t kMostParameters = 1000;  ///< of one request; lists are searched one by one

/// What an undeclared value looks like.
Declaration guessed(size_t numbers, size_t strings) {
    const size_t length = strings > 0 ? strings : numbers;
    return {StorageClass::Uniform, strings > 0 ? ValueType::String : ValueType::Float,
            static_cast<int>(std::clamp<size_t>(length, 1, kLongestArray))};
}

bool fits(const Declaration& declaration, size_t numbers, size_t strings) {
    const size_t item = component_count(declaration.type) * static_cast<size_t>(declaration.array_length);
    const bool is_string = declaration.type == ValueType::String;
    const size_t got = is_string ? strings : numbers;
    return (is_string ? numbers : strings) == 0 && got > 0 && got % item == 0;
}

}  // namespace

ParameterList Reader::parameters(ArgumentCursor& cursor, Undeclared undeclared) {
    ParameterList list;
    while (!cursor.done()) {
        if (!cursor.next_is_string() || cursor.peek()->strings.size() != 1)
            throw RequestError{"a parameter's name is expected", cursor.peek()->at};
        const SourceLocation name_at = cursor.peek()->at;
        const std::string token = cursor.string("a parameter's name");
        if (cursor.done()) throw RequestError{in_quotes(token) + " has no value", name_at};
        if (list.values.size() >= kMostParameters)
            throw RequestError{"more than " + std::to_string(kMostParameters) + " parameters", name_at};
        Argument value = cursor.take("a value");
        std::vector<float> numbers = value.take_numbers();
        // Several bare numbers may stand for an array of a fixed size (a colour, say).
        while (value.kind == Argument::Kind::Number && cursor.next_is_number() && !cursor.next_is_array())
            numbers.push_back(cursor.number("a value"));
        auto declared = declarations_.resolve(token);
        // A shader's or a renderer's own parameter of a name that RISpec gives another type to.
        if (declared && undeclared != Undeclared::LeaveOut && declarations_.is_predeclared(token) &&
            !scope_.color_samples && !fits(declared->second, numbers.size(), value.strings.size()))
            declared = {token, guessed(numbers.size(), value.strings.size())};
        if (!declared && undeclared != Undeclared::LeaveOut && token.find(' ') == std::string::npos) {
            declared = {token, guessed(numbers.size(), value.strings.size())};
        }
        if (!declared) {
            report(Severity::Error, name_at,
                   request_name_ + ": " + in_quotes(token) + " is not declared; left out",
                   "undeclared-" + token);
            continue;
        }
        const auto& [name, declaration] = *declared;
        const bool is_string = declaration.type == ValueType::String;
        if (is_string ? !numbers.empty() : !value.strings.empty()) {
            error(name_at, in_quotes(name) + " wants " + (is_string ? "strings" : "numbers") + "; left out");
            continue;
        }
        const size_t got = is_string ? value.strings.size() : numbers.size();
        const bool is_color = declaration.type == ValueType::Color;
        const size_t components = is_color ? samples_per_color() : component_count(declaration.type);
        const size_t item = components * static_cast<size_t>(declaration.array_length);
        if (got < item) {
            error(name_at, in_quotes(name) + " has " + std::to_string(got) + " values, needs a multiple of " +
                               std::to_string(item) + "; left out");
            continue;
        }
        if (got % item != 0) {
            diagnostics_.warning(name_at,
                                 request_name_ + ": " + in_quotes(name) + " has " + std::to_string(got) +
                                     " values, no multiple of " + std::to_string(item) +
                                     "; the rest is left over",
                                 "surplus-numbers");
            (is_string ? value.strings.resize(got - got % item) : numbers.resize(got - got % item));
        }
        if (list.find(name)) {
            report(Severity::Warning, name_at,
                   request_name_ + ": " + in_quotes(name) + " is given twice; the first counts",
                   "repeated-parameter");
            continue;
        }
        if (is_color) numbers = rgb(std::move(numbers));
        list.values.push_back({name, declaration, std::move(numbers), std::move(value.strings)});
    }
    return list;
}

std::vector<float> Reader::rgb(std::vector<float> colors) const {
    if (!scope_.color_samples) return colors;
    const auto& [n, matrix] = *scope_.color_samples;
    std::vector<float> converted(colors.size() / n * 3);
    for (size_t color = 0; color < colors.size() / n; ++color)
        for (size_t i = 0; i < n; ++i)
            for (size_t k = 0; k < 3; ++k)
                converted[color * 3 + k] += colors[color * n + i] * matrix[i * 3 + k];
    return converted;
}

ParameterList Reader::shader_parameters(ArgumentCursor& cursor) {
    ParameterList list = parameters(cursor, Undeclared::Guess);
    std::erase_if(list.values, [&](const Parameter& p) {
        const size_t got = p.is_string() ? p.strings.size() : p.floats.size();
        const int wanted = p.is_string() ? p.declaration.array_length : p.declaration.floats_per_item();
        if (got == static_cast<size_t>(wanted)) return false;
        error(in_quotes(p.name) + " has " + std::to_string(got) + " values, needs " + std::to_string(wanted) +
              "; left out");
        return true;
    });
    return list;
}

}  // namespace trapeze::rib
