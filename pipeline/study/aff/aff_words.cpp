#include "pipeline/study/aff/aff_words.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>

namespace trapeze {
namespace {

constexpr double kLargestAffNumber = 1e18;
constexpr size_t kLongestShownWord = 80;

bool is_aff_blank(char c) {
    return c == ' ' || c == '\t' || c == '\n' || c == '\r' || c == '\f' || c == '\v';
}

bool is_aff_brace(char c) {
    return c == '{' || c == '}';
}

/// A word of a stranger's file as messages show it: short, on one line, in plain characters.
std::string shown_word(std::string_view word) {
    std::string shown(word.substr(0, kLongestShownWord));
    std::ranges::replace_if(
        shown, [](char c) { return c < ' ' || c > '~'; }, '?');
    return word.size() > kLongestShownWord ? shown + "..." : shown;
}

/// False where the whole word is no number of that kind.
template <class Number>
bool parse_aff_number(std::string_view word, Number* value) {
    if (word.starts_with('+') && !word.starts_with("+-")) word.remove_prefix(1);
    const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), *value);
    return error == std::errc() && end == word.data() + word.size();
}

}  // namespace

void AffWords::fail(const std::string& what) {
    if (!failed()) problem_ = fmt::format("{}:{}: error: {}", name_, word_line_, what);
}

void AffWords::fail_on(const std::string& what, std::string_view word) {
    fail(fmt::format("{} \"{}\"", what, shown_word(word)));
}

std::string_view AffWords::peek() {
    if (failed()) return {};
    bool in_comment = false;
    for (; !rest_.empty(); rest_.remove_prefix(1)) {
        const char c = rest_.front();
        if (c == '\n') ++line_, in_comment = false;
        if (c == '#' || c == '%') in_comment = true;
        if (!in_comment && !is_aff_blank(c)) break;
    }
    if (rest_.empty()) return {};
    if (is_aff_brace(rest_.front())) return rest_.substr(0, 1);
    const auto end = std::ranges::find_if(rest_, [](char c) { return is_aff_blank(c) || is_aff_brace(c); });
    return rest_.substr(0, static_cast<size_t>(end - rest_.begin()));
}

std::string_view AffWords::word(const char* what) {
    const std::string_view next = peek();
    if (next.empty()) fail(fmt::format("{} expected, but the file ends", what));
    if (failed()) return {};
    word_line_ = line_;
    rest_.remove_prefix(next.size());
    return next;
}

void AffWords::expect(std::string_view expected) {
    const std::string what(expected);
    const std::string_view found = word(what.c_str());
    if (found != expected) fail_on(what + " expected, and not", found);
}

int AffWords::integer(const char* what, int least, int most) {
    const std::string_view found = word(what);
    int value = 0;
    if (!parse_aff_number(found, &value) || value < least || value > most)
        fail_on(fmt::format("{} expected, an integer from {} to {}, and not", what, least, most), found);
    return failed() ? 0 : value;
}

double AffWords::number(const char* what) {
    const std::string_view found = word(what);
    double value = 0;
    if (!parse_aff_number(found, &value) || !(std::abs(value) <= kLargestAffNumber))
        fail_on(fmt::format("{} expected, a number, and not", what), found);
    return failed() ? 0 : value;
}

V3d AffWords::vector(const char* what) {
    const double x = number(what), y = number(what), z = number(what);
    return {x, y, z};
}

void AffWords::skip_numbers(int count, const char* what) {
    for (int i = 0; i < count && !failed(); ++i) number(what);
}

}  // namespace trapeze
