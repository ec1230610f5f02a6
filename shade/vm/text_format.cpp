#include "shade/vm/text_format.h"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <cstdio>
#include <optional>
#include <regex>

namespace trapeze::vm {
namespace {

/// Characters of one number at most: widths and precisions beyond it are cut to it.
constexpr int kMaxFieldWidth = 200;

/// "%[flags][width][.precision]letter", of which the numbers are kept within reason.
struct Field {
    std::string prefix = "%";  ///< all but the letter, for snprintf
    size_t width = 0;
    std::optional<size_t> precision;
    bool is_left = false;  ///< what is narrower stands on the left
    char letter = 0;       ///< 0: the format ends in it
};

/// A width or precision, clamped: a format from a stranger must not ask for a megabyte. Returns where reading
/// goes on.
size_t read_number(std::string_view format, size_t at, std::string& out, size_t& value) {
    int number = 0;
    const size_t first = at;
    while (at < format.size() && std::isdigit(static_cast<unsigned char>(format[at])))
        number = std::min(number * 10 + (format[at++] - '0'), kMaxFieldWidth);
    if (at != first) out += std::to_string(number);
    value = static_cast<size_t>(number);
    return at;
}

/// C's conversion in a shader's text is untrusted input to snprintf(): flags are cut to a few characters, `*`
/// and length modifiers are not taken, and the letter is replaced by number_text().
size_t read_field(std::string_view format, size_t at, Field& field) {
    while (at < format.size() && std::string_view("+- #0").find(format[at]) != std::string_view::npos) {
        if (field.prefix.size() < 8) field.prefix += format[at];
        field.is_left = field.is_left || format[at] == '-';
        ++at;
    }
    at = read_number(format, at, field.prefix, field.width);
    if (at < format.size() && format[at] == '.') {
        field.prefix += '.';
        at = read_number(format, at + 1, field.prefix, field.precision.emplace());
    }
    if (at < format.size()) field.letter = format[at++];
    return at;
}

/// %d of a float is its whole part; what is too large for that, and NaN, is written as a float. The prefix
/// holds flags, width and precision as the shader wrote them, both bounded when it was read, so that the
/// buffer is large enough.
std::string number_text(const Field& field, float value) {
    char buffer[kMaxFieldWidth * 2 + 64];
    const bool whole = field.letter == 'd' || field.letter == 'i';
    const bool own = field.letter == 'g' || field.letter == 'e' || field.letter == 'G' || field.letter == 'E';
    if (whole && std::isfinite(value) && std::abs(value) < 9e18f) {
        const std::string format = field.prefix + "lld";
        std::snprintf(buffer, sizeof buffer, format.c_str(), static_cast<long long>(value));
    } else {
        const std::string format = field.prefix + (own ? field.letter : 'f');
        std::snprintf(buffer, sizeof buffer, format.c_str(), static_cast<double>(value));
    }
    return buffer;
}

/// A text in its field: what is beyond the precision is cut, and blanks fill the width.
std::string padded(const Field& field, std::string text) {
    if (field.precision) text.resize(std::min(text.size(), *field.precision));
    if (text.size() < field.width)
        text.insert(field.is_left ? text.size() : 0, field.width - text.size(), ' ');
    return text;
}

/// A triple or matrix is its numbers, with blanks between.
void append_value(const Field& field, const TextValue& value, std::string& out) {
    if (value.is_text) {
        out += padded(field, std::string(value.text));
        return;
    }
    for (size_t i = 0; i < value.floats.size(); ++i) {
        if (i) out += ' ';
        out += number_text(field, value.floats[i]);
    }
}

}  // namespace

std::string format_text(std::string_view format, std::span<const TextValue> values) {
    std::string out;
    size_t next = 0;
    for (size_t at = 0; at < format.size();) {
        if (format[at] != '%') {
            out += format[at++];
            continue;
        }
        if (at + 1 < format.size() && format[at + 1] == '%') {
            out += '%';
            at += 2;
            continue;
        }
        Field field;
        at = read_field(format, at + 1, field);
        if (field.letter && next < values.size()) append_value(field, values[next++], out);
    }
    return out;
}

/// Nothing throws out of it: bad patterns are the shader's mistake and the picture goes on.
bool matches(std::string_view pattern, std::string_view subject) {
    if (pattern.size() > kMaxPattern) return false;
    subject = subject.substr(0, kMaxSubject);
    try {
        auto flags = std::regex::extended;
#ifdef __GLIBCXX__
        // Time that grows no faster than the product of both lengths, whatever the pattern.
        flags |= std::regex_constants::__polynomial;
#endif
        const std::regex expression(pattern.begin(), pattern.end(), flags);
        return std::regex_search(subject.begin(), subject.end(), expression);
    } catch (const std::regex_error&) {
        return false;
    }
}

}  // namespace trapeze::vm
