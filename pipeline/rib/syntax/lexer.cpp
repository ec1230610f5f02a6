/// The lexer. Most of a scene's bytes are numbers in long arrays: these have a path of their own
/// (fast_numbers, read_plain_number), which hands over to the general one wherever it meets anything else.
/// Both give the same values to the bit.
#include "pipeline/rib/syntax/lexer.h"

#include <algorithm>
#include <array>
#include <bit>
#include <charconv>
#include <cstdint>
#include <limits>

namespace trapeze::rib {
namespace {

/// Exact as doubles: 10^22 is the last power of ten that is.
constexpr double kPowersOfTen[] = {1e0,  1e1,  1e2,  1e3,  1e4,  1e5,  1e6,  1e7,  1e8,  1e9,  1e10, 1e11,
                                   1e12, 1e13, 1e14, 1e15, 1e16, 1e17, 1e18, 1e19, 1e20, 1e21, 1e22};

bool is_digit(char c) {
    return c >= '0' && c <= '9';
}
/// What a word may begin with; digits may follow.
bool is_letter(char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '_';
}
/// Bytes that begin an encoded value, and those of UTF-8 beyond ASCII.
bool is_high(char c) {
    return static_cast<unsigned char>(c) >= 0x80;
}
/// Commas and semicolons are C's, and stand in some files written by hand.
constexpr bool is_separator(char c) {
    return c == ' ' || c == '\t' || c == ',' || c == ';' || c == '\f' || c == '\v';
}

/// A table by byte: what may stand right behind a number. Anything else ("1.5x", "3d") makes a word of it.
constexpr auto kEndsNumber = [] {
    std::array<bool, 256> ends{};
    for (size_t c = 0; c < ends.size(); ++c) ends[c] = is_separator(static_cast<char>(c));
    for (const char c : std::string_view("\n\r][#\"")) ends[static_cast<unsigned char>(c)] = true;
    return ends;
}();

bool ends_number(char c) {
    return kEndsNumber[static_cast<unsigned char>(c)];
}

/// Tables by byte: what words go on with, and what may stand between tokens.
constexpr auto kInWord = [] {
    std::array<bool, 256> in_word{};
    for (int c = 0; c < 128; ++c) {
        const bool letter = (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '_';
        in_word[static_cast<size_t>(c)] = letter || (c >= '0' && c <= '9');
    }
    return in_word;
}();
constexpr auto kSpace = [] {
    std::array<bool, 256> space{};
    for (size_t c = 0; c < space.size(); ++c) space[c] = is_separator(static_cast<char>(c));
    for (const char c : std::string_view("\n\r#\x1A")) space[static_cast<unsigned char>(c)] = true;
    return space;
}();

bool is_in_word(char c) {
    return kInWord[static_cast<unsigned char>(c)];
}
/// Blanks, ends of lines, and what begins a comment.
bool is_space(char c) {
    return kSpace[static_cast<unsigned char>(c)];
}

/// Whether rounding to float what was rounded to double already may differ from rounding once: the double
/// lies half-way between two floats. A double has 29 bits of mantissa more than a float: half-way is a one
/// and 28 zeros.
bool is_half_way(double value) {
    return (std::bit_cast<uint64_t>(value) & 0x1fffffff) == 0x10000000;
}

/// Digits of the mantissa without leading zeros.
int64_t significant_digits(const char* p, const char* end) {
    int64_t digits = 0;
    for (; p < end && *p != 'e' && *p != 'E'; ++p)
        if (is_digit(*p) && (digits > 0 || *p != '0')) ++digits;
    return digits;
}

/// A number without sign as the library reads it; infinite outside of float's range, 0 when it is too small.
float library_number(const char* first, const char* end, int64_t exponent) {
    float value = 0;
    if (std::from_chars(first, end, value).ec == std::errc::result_out_of_range)
        value = significant_digits(first, end) + exponent > 0 ? std::numeric_limits<float>::infinity() : 0;
    return value;
}

/// The longest number at p, or null. With at most 15 digits and a power of ten up to 22 both are exact
/// doubles and one operation rounds once [Clinger90]; all else is left to the library. The value is such
/// that its conversion to float is correctly rounded; it is infinite outside of float's range.
const char* read_number(const char* p, const char* end, double* value) {
    const bool negative = p < end && *p == '-';
    if (p < end && (*p == '-' || *p == '+')) ++p;
    const char* const first = p;
    uint64_t mantissa = 0;
    int64_t digits = 0, exponent = 0;
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
    double v = 0;
    bool exact = digits <= 15 && exponent >= -22 && exponent <= 22;
    if (exact) {
        const double m = static_cast<double>(mantissa);
        v = exponent < 0 ? m / kPowersOfTen[-exponent] : m * kPowersOfTen[exponent];
        exact = exponent == 0 || !is_half_way(v);
    }
    if (!exact) v = library_number(first, p, exponent);
    *value = negative ? -v : v;
    return p;
}

/// Reads numbers as read_number() does, but only those without an exponent, in a text that goes on beyond the
/// number; null where read_number() must decide. The digits as an integer and the power of ten are exact, so
/// the quotient rounds once.
const char* read_plain_number(const char* p, double* value) {
    const bool negative = *p == '-';
    p += negative;
    const char* const first = p;
    uint64_t mantissa = 0;
    for (; is_digit(*p); ++p) mantissa = mantissa * 10 + static_cast<uint64_t>(*p - '0');
    std::ptrdiff_t digits = p - first, decimals = 0;
    if (*p == '.') {
        const char* const point = p++;
        for (; is_digit(*p); ++p) mantissa = mantissa * 10 + static_cast<uint64_t>(*p - '0');
        decimals = p - point - 1;
        digits += decimals;
    }
    if (digits == 0 || digits > 15 || !ends_number(*p)) return nullptr;
    auto v = static_cast<double>(static_cast<int64_t>(mantissa));  // below 10^15
    if (decimals > 0) {
        v /= kPowersOfTen[decimals];
        if (is_half_way(v)) return nullptr;
    }
    *value = negative ? -v : v;
    return p;
}

/// "nan", "inf" and "infinity", as exporters print them, are numbers that are not finite, and no requests.
/// Lower or upper case.
bool is_non_finite_word(std::string_view word) {
    if ((word[0] | 0x20) != 'n' && (word[0] | 0x20) != 'i') return false;
    std::string lower;
    for (const char c : word.substr(0, 9)) lower += static_cast<char>(c | 0x20);
    return lower == "nan" || lower == "inf" || lower == "infinity";
}

}  // namespace

/// The last stop lets the fast path look ahead without asking at each byte whether the text ends: a number
/// before it ends in time.
Lexer::Lexer(std::string_view text, SourceLocation first, EncodedNames names)
    : begin_(text.data()),
      next_(text.data()),
      end_(text.data() + text.size()),
      line_start_(text.data()),
      last_stop_(text.data() + text.size()),
      source_(first.source),
      line_(first.line),
      first_column_(first.column),
      names_(std::move(names)) {
    if (text.starts_with("\xEF\xBB\xBF")) next_ += 3;  // UTF-8's byte order mark
    while (last_stop_ > begin_ && (last_stop_ == end_ || !ends_number(*last_stop_))) --last_stop_;
}

/// Blanks, ends of lines and comments. Lines end with \n, \r\n or \r, and are counted here and in strings.
/// Comments may hold anything, encoded bytes too: they end with their line alone.
void Lexer::skip_space() {
    const char* p;
    while (next_ < end_ && is_space(*next_)) {
        const char c = *next_;
        if (c == '\n') {
            ++next_;
            new_line();
            for (p = next_; p < end_ && *p == ' ';) ++p;  // indentation
            next_ = p;
        } else if (c == '\r') {
            ++next_;
            if (next_ >= end_ || *next_ != '\n') new_line();  // lines of the old Macintosh
        } else if (c == '#') {
            const char* const begin = next_;
            while (next_ < end_ && *next_ != '\n' && *next_ != '\r') ++next_;
            if (on_comment_) on_comment_({begin, static_cast<size_t>(next_ - begin)});
        } else {  // other blanks, and DOS' end of a text
            ++next_;
        }
    }
}

/// The end of the number at p, or null.
const char* Lexer::number_at(const char* p, double* value) const {
    const char* const stop = p < last_stop_ ? read_plain_number(p, value) : nullptr;
    return stop ? stop : read_number(p, end_, value);
}

/// How many finite numbers came one after another, at most as many as there is room for. Wherever it ends,
/// the general lexer goes on. No token is made of them, and no place noted: if something is wrong the general
/// lexer meets it again and says where.
size_t Lexer::fast_numbers(std::span<double> numbers) {
    const auto skip_blanks = [this](const char* p) {
        while (p < last_stop_ && (*p == ' ' || *p == '\t')) ++p;
        return p;
    };
    size_t count = 0;
    for (; count < numbers.size(); ++count) {
        const char* p = skip_blanks(next_);
        if (p < last_stop_ && *p == '\n') {
            next_ = p + 1;
            new_line();
            p = skip_blanks(next_);
        }
        if (p >= last_stop_) break;
        if (is_digit(*p) && ends_number(p[1])) {  // half of all numbers
            numbers[count] = *p - '0';
            next_ = p + 1;
            continue;
        }
        const char* const stop = number_at(p, &numbers[count]);
        if (!stop || stop >= end_ || !ends_number(*stop) || !std::isfinite(numbers[count])) break;
        next_ = stop;
    }
    return count;
}

/// Reads the token that begins at next_ or after it. Encoded values and text may alternate from token to
/// token (RISpec C.2).
void Lexer::scan() {
    // Definitions of codes are no tokens: the loop goes on behind them.
    do {
        // Mostly one blank.
        if (next_ < end_ && *next_ == ' ') ++next_;
        if (next_ < end_ && is_space(*next_)) skip_space();
        token_begin_ = next_;
        token_.at = location(next_);
        if (next_ >= end_) {
            token_.kind = TokenKind::End;
            return;
        }
    } while (is_high(*next_) && !scan_encoded());
    if (is_high(*token_begin_)) return;
    const char c = *next_;
    if (is_letter(c)) {
        scan_word();
    } else if (c == '[' || c == ']') {
        token_.kind = c == '[' ? TokenKind::Open : TokenKind::Close;
        ++next_;
    } else if (c == '"') {
        scan_string();
    } else if (c == '\'' && scan_single_quoted()) {
        return;
    } else if (c == '-' && (next_ + 1 == end_ || is_space(next_[1]))) {
        // RISpec: "DepthOfField -", no lens.
        token_.kind = TokenKind::String;
        token_.string.assign(1, c);
        ++next_;
    } else if (!scan_number()) {
        ++next_;
        while (next_ < end_ && !is_in_word(*next_) && !ends_number(*next_) && !is_high(*next_)) ++next_;
        be_bad(kStrayCharacters, next_);
    }
}

/// A word that begins at next_.
void Lexer::scan_word() {
    const char* const start = next_;
    const char* p = next_;
    if (p < last_stop_)
        while (is_in_word(*p)) ++p;  // which stops there, if not before
    else
        while (p < end_ && is_in_word(*p)) ++p;
    next_ = p;
    token_.kind = TokenKind::Word;
    token_.text = {start, static_cast<size_t>(p - start)};
    if (is_non_finite_word(token_.text)) {
        token_.kind = TokenKind::Number;
        token_.number = std::numeric_limits<double>::quiet_NaN();
    }
}

/// False where no number begins; the caller makes a mistake of it.
bool Lexer::scan_number() {
    if (next_ < last_stop_ && is_digit(*next_) && ends_number(next_[1])) {
        token_.kind = TokenKind::Number;
        token_.number = *next_++ - '0';
        return true;
    }
    if (const char* const stop = number_at(next_, &token_.number)) {
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

/// Makes a token of what is wrong up to `stop`; true, as a token is there.
bool Lexer::be_bad(const char* what, const char* stop) {
    token_.kind = TokenKind::Bad;
    token_.text = what;
    next_ = stop;
    return true;
}

/// False when it was a definition, which is no token. The text of a request that is not defined is no
/// request's name, and is reported like any other unknown one.
bool Lexer::scan_encoded() {
    const std::string_view bytes(next_, static_cast<size_t>(end_ - next_));
    const EncodedValue value = encoded_value(bytes);
    if (value.length > bytes.size()) return be_bad("an encoded value that reaches beyond the end", end_);
    const auto length = static_cast<size_t>(value.length);
    const std::string_view contents = bytes.substr(value.header, length - value.header);
    next_ += length;
    switch (value.encoding) {
        case Encoding::Number:
        case Encoding::Float:
        case Encoding::Double:
            token_.kind = TokenKind::Number;
            token_.number = decoded_number(value, bytes);
            return true;
        case Encoding::String:
            token_.kind = TokenKind::String;
            token_.string = contents;
            return true;
        case Encoding::Floats:
            token_.kind = TokenKind::Floats;
            token_.text = contents;
            return true;
        case Encoding::Request: {
            token_.kind = TokenKind::Word;
            const auto name = names_.requests.find(decoded_code(value, bytes));
            token_.text = name == names_.requests.end() ? "an encoded request that is not defined"
                                                        : std::string_view(name->second);
            return true;
        }
        case Encoding::DefinedString: {
            const auto name = names_.strings.find(decoded_code(value, bytes));
            if (name == names_.strings.end()) return be_bad("an encoded string that is not defined", next_);
            token_.kind = TokenKind::String;
            token_.string = name->second;
            return true;
        }
        case Encoding::DefineRequest:
        case Encoding::DefineString:
            return scan_definition(value, bytes);
        case Encoding::None:
            break;
    }
    return be_bad("a byte that RIB's encoding does not have", next_);
}

/// The string of a definition, as text or encoded.
bool Lexer::scan_definition(const EncodedValue& value, std::string_view bytes) {
    skip_space();
    const std::string_view rest(next_, static_cast<size_t>(end_ - next_));
    const bool is_encoded = !rest.empty() && is_high(rest[0]);
    if (!rest.empty() && rest[0] == '"') {
        scan_string();
        if (token_.kind == TokenKind::Bad) return true;
    } else if (is_encoded && encoded_value(rest).encoding == Encoding::String) {
        const EncodedValue string = encoded_value(rest);
        if (string.length > rest.size()) return be_bad("an encoded value that reaches beyond the end", end_);
        const auto length = static_cast<size_t>(string.length);
        token_.string = rest.substr(string.header, length - string.header);
        next_ += length;
    } else {
        return be_bad("a definition of a code without its string", next_);
    }
    if (token_.string.size() > kLongestEncodedName)
        return be_bad("a definition of a code by more than 4096 bytes", next_);
    auto& names = value.encoding == Encoding::DefineRequest ? names_.requests : names_.strings;
    names[decoded_code(value, bytes)] = token_.string;
    return false;
}

/// A string in the quotes of other languages, as some files write theirs: 'rgba'. Says whether it is one.
bool Lexer::scan_single_quoted() {
    const std::string_view rest(next_ + 1, static_cast<size_t>(end_ - next_ - 1));
    const size_t length = rest.find_first_of("'\"\r\n");
    if (length == std::string_view::npos || rest[length] != '\'') return false;
    token_.kind = TokenKind::String;
    token_.string = rest.substr(0, length);
    next_ += length + 2;
    return true;
}

/// Strings reach from quote to quote, over ends of lines if need be. Escapes are those of C: \n and the like,
/// up to three octal digits, and a backslash before the end of a line, which joins it to the next.
void Lexer::scan_string() {
    token_.kind = TokenKind::String;
    ++next_;
    // Most strings are as they stand, within a line.
    const char* const begin = next_;
    const char* p = begin;
    while (p < end_ && *p != '"' && *p != '\\' && *p != '\n') ++p;
    next_ = p;
    token_.string.assign(begin, p);
    while (next_ < end_ && *next_ != '"') {
        char c = *next_++;
        if (c == '\n') new_line();
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
                    new_line();
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
        be_bad("a string that is never closed", end_);
    }
}

}  // namespace trapeze::rib
