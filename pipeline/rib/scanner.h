/// Tokens of ASCII RIB (RISpec appendix C.1).
#pragma once

#include <string>
#include <string_view>

#include "core/diagnostics.h"

namespace trapeze::rib {

enum class TokenKind { End, Word, Number, String, Open, Close, Bad };

struct Token {
    TokenKind kind = TokenKind::End;
    SourceLocation at;
    double number = 0;      ///< Number; may be infinite or NaN, which the reader of arguments reports
    std::string_view text;  ///< Word, Bad
    std::string string;     ///< String, escapes undone
};

class Scanner {
  public:
    Scanner(std::string_view text, uint32_t source)
        : next_(text.data()), end_(text.data() + text.size()), line_start_(text.data()), source_(source) {}

    const Token& peek() {
        if (!has_token_) scan(), has_token_ = true;
        return token_;
    }
    void skip() {
        peek();
        has_token_ = false;
    }
    /// Adds numbers up to the closing bracket or whatever else comes; the fast path of large arrays.
    /// False when a number was not finite.
    template <class Append>
    bool scan_numbers(Append&& append) {
        bool finite = true;
        while (peek().kind == TokenKind::Number) {
            append(token_.number);
            finite &= token_.number - token_.number == 0;
            has_token_ = false;
            // Numbers follow each other mostly: try to stay out of the general scanner.
            double value = 0;
            while (fast_number(&value)) append(value);
        }
        return finite;
    }

    /// Where the next token begins, in the text.
    const char* token_begin() {
        peek();
        return token_begin_;
    }

  private:
    void scan();
    void skip_space();
    bool scan_number();
    void scan_string();
    bool fast_number(double* value);
    SourceLocation location(const char* p) const {
        return {source_, line_, static_cast<uint32_t>(p - line_start_) + 1};
    }

    const char* next_;
    const char* end_;
    const char* line_start_;
    const char* token_begin_ = nullptr;
    uint32_t source_, line_ = 1;
    Token token_;
    bool has_token_ = false;
};

}  // namespace trapeze::rib
