#include "shade/rsl/syntax/token_values.h"

#include <charconv>
#include <cmath>
#include <cstdio>
#include <optional>

namespace trapeze::rsl {
namespace {

/// "1", "1.5", ".5", "1.", "1e-3", and with an f at the end; nothing for what is no number. What is too small
/// or too large for a float becomes 0 or infinity.
std::optional<float> number_of(std::string_view text) {
    if (text.ends_with('f') || text.ends_with('F')) text.remove_suffix(1);
    double value = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (end != text.data() + text.size() || error == std::errc::invalid_argument) return {};
    // from_chars() gives no value here; the sign of the exponent tells which end it ran over.
    if (error == std::errc::result_out_of_range) {
        const size_t exponent = text.find_first_of("eE");
        const bool small = exponent != std::string_view::npos && text[exponent + 1] == '-';
        return small ? 0.0f : HUGE_VALF;
    }
    return static_cast<float>(value);
}

/// What an escape stands for; `i` is behind the backslash, and then behind the escape. Up to three octal
/// digits as in C; a value beyond a byte loses its upper bits.
char escaped(std::string_view text, size_t& i) {
    // Letters and their values in the same order. Any other letter stands for itself.
    static constexpr std::string_view kLetters = "ntrbfav0", kValues("\n\t\r\b\f\a\v\0", 8);
    const char c = text[i++];
    if (c >= '0' && c <= '7') {
        int value = c - '0';
        for (int digits = 1; digits < 3 && i < text.size() && text[i] >= '0' && text[i] <= '7'; ++digits)
            value = value * 8 + (text[i++] - '0');
        return static_cast<char>(value);
    }
    const size_t letter = kLetters.find(c);
    return letter == std::string_view::npos ? c : kValues[letter];
}

/// `text` with its quotation marks. Strings that stand side by side become one, as in C, so values are
/// appended.
void append_value(std::string_view text, std::string& value) {
    text = text.substr(1, text.size() - 2);
    for (size_t i = 0; i < text.size();) {
        if (text[i] == '\\' && i + 1 < text.size())
            value += escaped(text, ++i);
        else
            value += text[i++];
    }
}

/// What is wrong with a token that is no word of the language. Bytes that a terminal cannot show, or might
/// obey, are given by their number.
std::string description(const Token& token) {
    if (token.text.starts_with('"')) return "this string has no end on its line";
    const auto byte = static_cast<unsigned char>(token.text.empty() ? 0 : token.text[0]);
    char text[64];
    if (byte > ' ' && byte < 127)
        std::snprintf(text, sizeof text, "\"%c\" means nothing in a shader", byte);
    else
        std::snprintf(text, sizeof text, "the byte 0x%02x means nothing in a shader", byte);
    return text;
}

}  // namespace

/// Strings beside each other are joined here and not in the parser, so that a macro may stand among them, as
/// in C.
void read_values(TokenStream& stream, Reporter& reporter) {
    std::vector<Token>& tokens = stream.tokens;
    // Tokens are moved forward in place over those that are left out or joined.
    size_t kept = 0;
    bool after_unknown = false;  // one message for a run of them
    for (size_t i = 0; i < tokens.size(); ++i) {
        Token token = tokens[i];
        if (token.kind == Token::Kind::Unknown) {
            if (!after_unknown) reporter.error(token.at, description(token));
            after_unknown = true;
            continue;
        }
        after_unknown = false;
        if (token.kind == Token::Kind::Name && token.text.size() > kLongestName) {
            reporter.error(token.at,
                           "a name of " + std::to_string(token.text.size()) + " letters is too long");
            token.text = token.text.substr(0, kLongestName);
        } else if (token.kind == Token::Kind::Number) {
            const std::optional<float> value = number_of(token.text);
            if (!value)
                reporter.error(token.at, "\"" + std::string(token.text.substr(0, 80)) + "\" is no number");
            token.number = value.value_or(0.0f);
        } else if (token.kind == Token::Kind::Text) {
            std::string& value = stream.made.emplace_back();
            append_value(token.text, value);
            // The last token is the End, so that i + 1 is always there.
            while (tokens[i + 1].kind == Token::Kind::Text) append_value(tokens[++i].text, value);
            token.text = value;
        }
        tokens[kept++] = token;
    }
    tokens.resize(kept);
}

}  // namespace trapeze::rsl
