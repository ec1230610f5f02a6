#include "pipeline/rib/scanner.h"

#include <array>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <limits>

namespace trapeze::rib {
namespace {

constexpr double kPowersOfTen[] = {1e0,  1e1,  1e2,  1e3,  1e4,  1e5,  1e6,  1e7,  1e8,  1e9,  1e10, 1e11,
                                   1e12, 1e13, 1e14, 1e15, 1e16, 1e17, 1e18, 1e19, 1e20, 1e21, 1e22};

bool is_digit(char c) {
    return c >= '0' && c <= '9';
}
bool is_letter(char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '_';
}
bool ends_number(char c) {
    return c == ' ' || c == '\n' || c == '\t' || c == '\r' || c == ']' || c == '[' || c == '#' || c == '"' ||
           c == ',';
}

/// The longest number at p, or null. Exact (one rounding to double) when it has at most 18 digits and a small
/// exponent, which is where 64-bit integers and powers of ten are exact enough; otherwise the library reads
/// it.
const char* read_number(const char* p, const char* end, double* value) {
    const char* const start = p;
    const bool negative = p < end && *p == '-';
    if (p < end && (*p == '-' || *p == '+')) ++p;
    const char* const first = p;
    uint64_t mantissa = 0;
    int digits = 0, exponent = 0;
    for (; p < end && is_digit(*p); ++p, ++digits) mantissa = mantissa * 10 + static_cast<uint64_t>(*p - '0');
    if (p < end && *p == '.') {
        ++p;
        for (; p < end && is_digit(*p); ++p, ++digits, --exponent)
            mantissa = mantissa * 10 + static_cast<uint64_t>(*p - '0');
    }
    if (digits == 0) return nullptr;
    if (p < end && (*p == 'e' || *p == 'E')) {
        const char* q = p + 1;
        const bool minus = q < end && *q == '-';
        if (q < end && (*q == '-' || *q == '+')) ++q;
        if (q < end && is_digit(*q)) {
            int written = 0;
            for (; q < end && is_digit(*q); ++q) written = std::min(written * 10 + (*q - '0'), 100000);
            exponent += minus ? -written : written;
            p = q;
        }
    }
    if (digits <= 15 && exponent >= -22 && exponent <= 22) {
        const double m = static_cast<double>(mantissa);
        const double v = exponent < 0 ? m / kPowersOfTen[-exponent] : m * kPowersOfTen[exponent];
        *value = negative ? -v : v;
        return p;
    }
    double v = 0;
    const auto [stop, error] = std::from_chars(first, p, v);
    if (error == std::errc::result_out_of_range)
        v = exponent < 0 ? 0.0 : std::numeric_limits<double>::infinity();
    *value = *start == '-' ? -v : v;
    return p;
}

bool is_non_finite_word(std::string_view word) {
    std::string lower;
    for (const char c : word.substr(0, 9)) lower += static_cast<char>(c | 0x20);
    return lower == "nan" || lower == "inf" || lower == "infinity";
}

}  // namespace

void Scanner::skip_space() {
    while (next_ < end_) {
        const char c = *next_;
        if (c == '\n') {
            ++line_;
            line_start_ = ++next_;
        } else if (c == ' ' || c == '\t' || c == '\r' || c == '\f' || c == ',') {
            ++next_;
        } else if (c == '#') {
            while (next_ < end_ && *next_ != '\n') ++next_;
        } else {
            return;
        }
    }
}

bool Scanner::fast_number(double* value) {
    const char* p = next_;
    while (p < end_ && (*p == ' ' || *p == '\t')) ++p;
    if (p < end_ && *p == '\n') {
        ++line_;
        line_start_ = next_ = p + 1;
        p = next_;
        while (p < end_ && (*p == ' ' || *p == '\t')) ++p;
    }
    p = read_number(p, end_, value);
    if (!p || p >= end_ || !ends_number(*p) || !(*value - *value == 0)) return false;
    next_ = p;
    return true;
}

void Scanner::scan() {
    skip_space();
    token_begin_ = next_;
    token_.at = location(next_);
    if (next_ >= end_) {
        token_.kind = TokenKind::End;
        return;
    }
    const char c = *next_;
    if (c == '[' || c == ']') {
        token_.kind = c == '[' ? TokenKind::Open : TokenKind::Close;
        ++next_;
    } else if (c == '"') {
        scan_string();
    } else if (!scan_number()) {
        const char* const start = next_;
        if (is_letter(c)) {
            while (next_ < end_ && (is_letter(*next_) || is_digit(*next_))) ++next_;
            token_.kind = TokenKind::Word;
        } else {
            ++next_;
            while (next_ < end_ && !is_letter(*next_) && !ends_number(*next_) && !is_digit(*next_)) ++next_;
            token_.kind = TokenKind::Bad;
        }
        token_.text = {start, static_cast<size_t>(next_ - start)};
        if (token_.kind == TokenKind::Word && is_non_finite_word(token_.text)) {
            token_.kind = TokenKind::Number;
            token_.number = std::numeric_limits<double>::quiet_NaN();
        }
    }
}

bool Scanner::scan_number() {
    const char* const stop = read_number(next_, end_, &token_.number);
    if (stop) {
        token_.kind = TokenKind::Number;
        next_ = stop;
        return true;
    }
    // "-nan", "+inf"
    if ((*next_ == '-' || *next_ == '+') && next_ + 1 < end_ && is_letter(next_[1])) {
        const char* q = next_ + 1;
        while (q < end_ && is_letter(*q)) ++q;
        if (is_non_finite_word({next_ + 1, static_cast<size_t>(q - next_ - 1)})) {
            token_.kind = TokenKind::Number;
            token_.number = std::numeric_limits<double>::quiet_NaN();
            next_ = q;
            return true;
        }
    }
    return false;
}

void Scanner::scan_string() {
    token_.kind = TokenKind::String;
    token_.string.clear();
    const char* const open = next_++;
    while (next_ < end_ && *next_ != '"') {
        char c = *next_++;
        if (c == '\n') ++line_, line_start_ = next_;
        if (c == '\\' && next_ < end_) {
            c = *next_++;
            switch (c) {
                case 'n':
                    c = '\n';
                    break;
                case 'r':
                    c = '\r';
                    break;
                case 't':
                    c = '\t';
                    break;
                case 'b':
                    c = '\b';
                    break;
                case 'f':
                    c = '\f';
                    break;
                case '\n':  // a line continued
                    ++line_, line_start_ = next_;
                    continue;
                default:
                    if (c >= '0' && c <= '7') {
                        int code = c - '0';
                        for (int k = 0; k < 2 && next_ < end_ && *next_ >= '0' && *next_ <= '7'; ++k)
                            code = code * 8 + (*next_++ - '0');
                        c = static_cast<char>(code);
                    }
            }
        }
        token_.string += c;
    }
    if (next_ < end_) {
        ++next_;
    } else {
        token_.kind = TokenKind::Bad;  // never closed
        token_.text = {open, 1};
    }
}

}  // namespace trapeze::rib
