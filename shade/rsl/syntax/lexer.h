/// Text to tokens, one at a time, comments left out.
#pragma once

#include "shade/rsl/syntax/reporter.h"
#include "shade/rsl/syntax/token.h"

namespace trapeze::rsl {

/// Reads a text once. Tokens point into it, so it is not copied; bytes that mean nothing become tokens, too,
/// and it is read_values() that complains, since a condition may leave them out. Lexing is done before macros
/// are expanded: what a number or a string stands for is read after that (token_values.h).
class Lexer {
  public:
    /// `source`: as registered with Diagnostics. `text` must outlive the tokens.
    Lexer(const SourceText& text, uint32_t source, Reporter& reporter);

    /// The next token; after the last, NewLine and then End for ever.
    Token next();

    /// From the next line on, lines belong to `source` and are numbered from `line`.
    void renumber(uint32_t source, uint32_t line);
    uint32_t line() const { return line_; }
    /// Lines from the text's beginning, whatever renumber() says.
    uint32_t physical_line() const { return physical_line_; }

  private:
    /// A zero byte behind the end, which is part of no name, number or mark: so no look-ahead needs a bound.
    char peek(size_t ahead = 0) const {
        return position_ + ahead < text_.size() ? text_[position_ + ahead] : '\0';
    }
    /// The only one that moves position_: it counts lines and columns on the way.
    void advance();
    void skip_blanks(Token& token);
    bool skip_comment();
    void scan_number();
    void scan_name();
    bool scan_string();
    void scan_mark();

    std::string_view text_;
    const std::vector<size_t>& joints_;  ///< SourceText::joints; from next_joint_ on they lie ahead
    Reporter& reporter_;
    size_t position_ = 0, next_joint_ = 0;
    uint32_t source_, line_ = 1, column_ = 1, physical_line_ = 1;
    bool line_start_ = true;
};

/// The one token that the whole of `text` is, if it is one.
bool is_one_token(std::string_view text, Token::Kind& kind);

/// Letters of ASCII, digits (not first) and the underscore. Locales say nothing here: a shader means the same
/// on every machine.
bool is_name_start(char c);
bool is_name_part(char c);

}  // namespace trapeze::rsl
