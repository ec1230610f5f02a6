#include "shade/rsl/syntax/lexer.h"

namespace trapeze::rsl {
namespace {

/// Editors of DOS ended files with it.
constexpr char kEndOfDosFile = 0x1a;

/// Of ASCII, whatever the locale says.
bool is_digit(char c) {
    return c >= '0' && c <= '9';
}

// The longest first.
constexpr std::string_view kMarks[] = {
    "...", "##", "==", "!=", "<=", ">=", "&&", "||", "+=", "-=", "*=", "/=", "<<", ">>", "->", "::", "%="};

}  // namespace

bool is_name_start(char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '_';
}

bool is_name_part(char c) {
    return is_name_start(c) || is_digit(c);
}

/// A text may begin with joined lines: the first token then stands in a later line than the first.
Lexer::Lexer(const SourceText& text, uint32_t source, Reporter& reporter)
    : text_(text.text), joints_(text.joints), reporter_(reporter), source_(source) {
    while (next_joint_ < joints_.size() && joints_[next_joint_] == 0)
        ++next_joint_, ++line_, ++physical_line_;
}

/// One byte on. Lines count as in the file: where a backslash joined two, the joined text goes on in the next
/// one.
void Lexer::advance() {
    ++column_;
    if (text_[position_++] == '\n') ++line_, ++physical_line_, column_ = 1;
    while (next_joint_ < joints_.size() && joints_[next_joint_] == position_)
        ++next_joint_, ++line_, ++physical_line_, column_ = 1;
}

/// Skips a comment of either form. True when there was one. A comment that is never closed takes the rest of
/// the file with it.
bool Lexer::skip_comment() {
    if (peek() != '/') return false;
    if (peek(1) == '/') {
        while (position_ < text_.size() && peek() != '\n') advance();
        return true;
    }
    if (peek(1) != '*') return false;
    const SourceLocation at{source_, line_, column_};
    advance(), advance();
    while (position_ < text_.size() && !(peek() == '*' && peek(1) == '/')) advance();
    if (position_ == text_.size())
        reporter_.error(at, "this comment is never closed");
    else
        advance(), advance();
    return true;
}

/// Blanks and comments. A macro's parameters begin with a parenthesis right behind its name, so that they
/// were there is kept.
void Lexer::skip_blanks(Token& token) {
    while (position_ < text_.size()) {
        const char c = peek();
        if (c == ' ' || c == '\t' || c == '\f' || c == '\v' || c == kEndOfDosFile)
            advance();
        else if (!skip_comment())
            return;
        token.space_before = true;
    }
}

/// The first byte tells what a token is. The text's end is a NewLine if its last line has none, so that
/// directives on it end.
Token Lexer::next() {
    Token token;
    skip_blanks(token);
    token.at = {source_, line_, column_};
    token.line_start = line_start_;
    const size_t start = position_;
    if (position_ == text_.size()) {
        token.kind = line_start_ ? Token::Kind::End : Token::Kind::NewLine;
        line_start_ = true;
        return token;
    }
    const char c = peek();
    line_start_ = c == '\n';
    if (c == '\n') {
        token.kind = Token::Kind::NewLine;
        advance();
    } else if (is_name_start(c)) {
        token.kind = Token::Kind::Name;
        scan_name();
    } else if (is_digit(c) || (c == '.' && is_digit(peek(1)))) {
        token.kind = Token::Kind::Number;
        scan_number();
    } else if (c == '"') {
        token.kind = scan_string() ? Token::Kind::Text : Token::Kind::Unknown;
    } else if (c > ' ' && c < 127 && c != '\'' && c != '`' && c != '@' && c != '$' && c != '\\') {
        token.kind = Token::Kind::Mark;
        scan_mark();
    } else {
        token.kind = Token::Kind::Unknown;
        advance();
    }
    token.text = text_.substr(start, position_ - start);
    return token;
}

/// No length is too long here; read_values() cuts and reports.
void Lexer::scan_name() {
    while (is_name_part(peek())) advance();
}

/// Digits, point, exponent, and whatever letters follow, which read_values() judges ("2.5", "0x1F", "3rd").
/// Letters stay with the number as in C's preprocessing numbers: "3rd" is one wrong token and not two that
/// might mean something.
void Lexer::scan_number() {
    while (is_digit(peek())) advance();
    if (peek() == '.') advance();
    while (is_digit(peek())) advance();
    if (peek() == 'e' || peek() == 'E') {
        // An e without digits behind it is no exponent, but the letter that follows the number.
        const size_t sign = peek(1) == '+' || peek(1) == '-' ? 1 : 0;
        if (is_digit(peek(1 + sign)))
            for (size_t i = 0; i < 1 + sign; ++i) advance();
    }
    while (is_name_part(peek())) advance();
}

/// True when the string is closed on its line. A string that the line ends is an error at its beginning;
/// strings over several lines are joined before, by a backslash at the line's end.
bool Lexer::scan_string() {
    advance();
    while (position_ < text_.size() && peek() != '\n') {
        const char c = peek();
        advance();
        if (c == '"') return true;
        if (c == '\\' && position_ < text_.size() && peek() != '\n') advance();
    }
    return false;
}

/// The longest operator that begins here, or one byte. The list has longer marks first. A byte that is no
/// mark is a token by itself, which read_values() reports.
void Lexer::scan_mark() {
    const std::string_view rest = text_.substr(position_, 3);
    for (const std::string_view mark : kMarks)
        if (rest.starts_with(mark)) {
            for (size_t i = 0; i < mark.size(); ++i) advance();
            return;
        }
    advance();
}

/// #line: only what messages say changes, the text goes on.
void Lexer::renumber(uint32_t source, uint32_t line) {
    source_ = source, line_ = line;
}

/// Whether a text is a single token, and of what kind, as the result of ## must be.
bool is_one_token(std::string_view text, Token::Kind& kind) {
    SourceText source;
    source.text = text;
    Diagnostics unheard;
    Reporter reporter(unheard);
    Lexer lexer(source, 0, reporter);
    const Token token = lexer.next();
    kind = token.kind;
    return token.kind != Token::Kind::End && token.kind != Token::Kind::NewLine &&
           token.text.size() == text.size();
}

}  // namespace trapeze::rsl
