/// Tokens of RIB, as text or in the binary encoding (RISpec appendix C).
#pragma once

#include <cmath>
#include <functional>
#include <span>
#include <string>
#include <string_view>

#include "core/diagnostics.h"
#include "pipeline/rib/syntax/encoded_values.h"

namespace trapeze::rib {

/// Floats: an encoded array. Definitions of codes are no tokens.
enum class TokenKind { End, Word, Number, String, Open, Close, Bad, Floats };

/// The text of Bad tokens that are neither words, numbers nor strings.
inline constexpr char kStrayCharacters[] = "characters that RIB does not have";

/// Views point into the text, or into the lexer's table of names: they hold until the next token is read.
struct Token {
    TokenKind kind = TokenKind::End;
    SourceLocation at;
    double number = 0;      ///< Number; infinite or NaN when it is no finite float
    std::string_view text;  ///< Word; Floats: its bytes; Bad: what it is
    std::string string;     ///< String, escapes undone
};

/// One pass over a text that stays in memory as long as the lexer does, with one token of look-ahead. It
/// never fails: what is no token of RIB is a Bad one, and the caller decides what is lost with it.
class Lexer {
  public:
    /// Spans of scan_numbers(), at most: enough that a call costs little, few enough to stay in the first
    /// cache.
    static constexpr size_t kNumbersAtOnce = 64;

    /// `first` is the place of the text's first character; `names` are those that an outer text has defined.
    Lexer(std::string_view text, SourceLocation first, EncodedNames names = {});

    /// The next token, which stays the next one until skip().
    const Token& peek() {
        if (!has_token_) scan(), has_token_ = true;
        return token_;
    }
    void skip() {
        peek();
        has_token_ = false;
    }
    /// Hands on numbers up to the closing bracket or whatever else comes, in spans of up to kNumbersAtOnce;
    /// the fast path of arrays. The place of the first one that is not finite; line 0 when there is none.
    template <class Append>
    SourceLocation scan_numbers(Append&& append) {
        SourceLocation bad;
        double numbers[kNumbersAtOnce];
        while (peek().kind == TokenKind::Number) {
            numbers[0] = token_.number;
            if (!std::isfinite(token_.number) && bad.line == 0) bad = token_.at;
            has_token_ = false;
            // Numbers follow each other mostly: try to stay out of the general lexer.
            size_t count = 1 + fast_numbers({numbers + 1, kNumbersAtOnce - 1});
            append(std::span<const double>(numbers, count));
            while (count == kNumbersAtOnce) {
                count = fast_numbers(numbers);
                append(std::span<const double>(numbers, count));
            }
        }
        return bad;
    }

    /// To be called with each comment that is passed over, from its "#" to the end of its line.
    void on_comment(std::function<void(std::string_view)> listener) { on_comment_ = std::move(listener); }

    /// What has been defined up to here, for a text that is cut out of this one (ArchiveBegin).
    const EncodedNames& encoded_names() const { return names_; }

    /// Where the next token begins: bytes from the beginning of the text.
    size_t offset() {
        peek();
        return static_cast<size_t>(token_begin_ - begin_);
    }

  private:
    void scan();
    void skip_space();
    bool scan_number();
    void scan_word();
    void scan_string();
    bool scan_single_quoted();
    const char* number_at(const char* p, double* value) const;
    size_t fast_numbers(std::span<double> numbers);
    bool scan_encoded();
    bool scan_definition(const EncodedValue& value, std::string_view bytes);
    bool be_bad(const char* what, const char* stop);
    void new_line() { ++line_, line_start_ = next_, first_column_ = 1; }
    SourceLocation location(const char* p) const {
        return {source_, line_, static_cast<uint32_t>(p - line_start_) + first_column_};
    }

    const char* begin_;
    const char* next_;
    const char* end_;
    const char* line_start_;
    const char* last_stop_;  ///< the last character that no number goes beyond, or the beginning
    const char* token_begin_ = nullptr;
    uint32_t source_, line_;
    uint32_t first_column_;  ///< of the text's first line, which may begin within a line of the file
    EncodedNames names_;
    std::function<void(std::string_view)> on_comment_;
    Token token_;
    bool has_token_ = false;
};

}  // namespace trapeze::rib
