#include "pipeline/rib/syntax/lexer.h"

#include <gtest/gtest.h>

#include <bit>
#include <cstdlib>
#include <random>

namespace trapeze::rib {
namespace {

std::vector<Token> tokens_of(std::string_view text) {
    Lexer lexer(text, {1, 1, 1});
    std::vector<Token> tokens;
    for (; lexer.peek().kind != TokenKind::End; lexer.skip()) tokens.push_back(lexer.peek());
    return tokens;
}

Token only(std::string_view text) {
    const auto tokens = tokens_of(text);
    EXPECT_EQ(tokens.size(), 1u) << text;
    return tokens.empty() ? Token{} : tokens[0];
}

double number(std::string_view text) {
    const Token token = only(text);
    EXPECT_EQ(token.kind, TokenKind::Number) << text;
    return token.number;
}

auto append_to(std::vector<double>& list) {
    return [&list](std::span<const double> values) { list.insert(list.end(), values.begin(), values.end()); };
}

TEST(Lexer, NumbersInEveryForm) {
    EXPECT_EQ(number(".9"), 0.9);
    EXPECT_EQ(number("1e-3"), 1e-3);
    EXPECT_EQ(number("+1"), 1);
    EXPECT_EQ(number("-.5E+2"), -50);
    EXPECT_EQ(number("7."), 7);
    EXPECT_EQ(number("000123"), 123);
    EXPECT_EQ(number("-0"), 0);
    EXPECT_TRUE(std::signbit(number("-0")));
    EXPECT_EQ(number("16777217"), 16777217);
    EXPECT_EQ(number("2147483648"), 2147483648.0);
}

TEST(Lexer, NumbersBeyondFloatAreInfiniteOrZero) {
    EXPECT_EQ(number("1e999"), HUGE_VAL);
    EXPECT_EQ(number("-1e99999999999999999999"), -HUGE_VAL);
    EXPECT_EQ(number("1e-99999999999999999999"), 0);
    EXPECT_EQ(number("0e999999"), 0);
    EXPECT_EQ(number(std::string(500, '9')), HUGE_VAL);
    EXPECT_EQ(number("0." + std::string(500, '0') + "1"), 0);
    EXPECT_EQ(number("0." + std::string(500, '0') + "1e501"), 1);
    EXPECT_TRUE(std::isnan(number("nan")));
    EXPECT_TRUE(std::isnan(number("-NaN")));
    EXPECT_FALSE(std::isfinite(number("-inf")));
    EXPECT_FALSE(std::isfinite(number("Infinity")));
}

/// Random numbers, among them ones half-way between floats, as text of many forms.
TEST(Lexer, FloatsAreRoundedAsTheLibraryRoundsThem) {
    std::mt19937_64 random(1);
    const char* const formats[] = {"%.3g", "%.6g", "%.9g", "%.12g", "%.15f", "%.17g", "%.4f", "%.25g"};
    char text[512];
    for (int i = 0; i < 1000000; ++i) {
        const auto bits = static_cast<uint32_t>(random());
        float f = std::bit_cast<float>(bits);
        if (i % 2) f = static_cast<float>(static_cast<double>(bits) / 4294967296.0 * 20 - 10);
        if (!std::isfinite(f)) continue;
        double value = f;
        if (i % 5 == 0) value = (value + static_cast<double>(std::nextafter(f, 1e38f))) / 2;
        std::snprintf(text, sizeof text, formats[i % 8], value);
        const float expected = std::strtof(text, nullptr);
        // At the end of a text, before more of it, and after another number.
        for (const std::string& around :
             {std::string(text), std::string(text) + "]", "1\n" + std::string(text) + " "}) {
            double scanned = 0;
            Lexer lexer(around, {1, 1, 1});
            lexer.scan_numbers([&](std::span<const double> values) { scanned = values.back(); });
            const auto got = static_cast<float>(scanned);
            ASSERT_EQ(std::bit_cast<uint32_t>(got), std::bit_cast<uint32_t>(expected)) << around;
        }
    }
}

TEST(Lexer, NumbersFollowEachOtherInArrays) {
    Lexer lexer("1 2\n 3,4\t-5 # six\n6 7]8", {1, 1, 1});
    std::vector<double> values;
    EXPECT_EQ(lexer.scan_numbers(append_to(values)).line, 0u);
    EXPECT_EQ(values, (std::vector<double>{1, 2, 3, 4, -5, 6, 7}));
    EXPECT_EQ(lexer.peek().kind, TokenKind::Close);
    EXPECT_EQ(lexer.peek().at.line, 3u);
    EXPECT_EQ(lexer.peek().at.column, 4u);
}

TEST(Lexer, ArraysOfAnyLengthAreWhole) {
    std::string text;
    std::vector<double> written;
    for (int i = 0; i < 200; ++i) {
        for (const char* end : {"", " ", "]", "\nSphere", "\xCB"}) {
            std::vector<double> values;
            const std::string whole = text + end;
            Lexer lexer(whole, {1, 1, 1});
            EXPECT_EQ(lexer.scan_numbers(append_to(values)).line, 0u);
            ASSERT_EQ(values, written) << end;
        }
        text += (i > 0 ? " " : "") + std::to_string(i * 0.5);
        written.push_back(i * 0.5);
    }
}

TEST(Lexer, TheFirstNumberThatIsNotFiniteHasItsPlace) {
    Lexer lexer("1 2\n 3 nan 4 inf", {1, 1, 1});
    const SourceLocation bad = lexer.scan_numbers([](std::span<const double>) {});
    EXPECT_EQ(bad.line, 2u);
    EXPECT_EQ(bad.column, 4u);
}

TEST(Lexer, StringsWithEscapes) {
    EXPECT_EQ(only(R"("a\"b")").string, "a\"b");
    EXPECT_EQ(only(R"("\n\r\t\b\f\\")").string, "\n\r\t\b\f\\");
    EXPECT_EQ(only(R"("\101\60x\7")").string, "A0x\a");
    EXPECT_EQ(only("\"one\\\ntwo\"").string, "onetwo");
    EXPECT_EQ(only("\"# [no] comment\"").string, "# [no] comment");
    EXPECT_EQ(only("\"\"").string, "");
    EXPECT_EQ(only("\"\"").kind, TokenKind::String);
    EXPECT_EQ(only("\"never closed").kind, TokenKind::Bad);
    EXPECT_EQ(only("\"ends in an escape\\").kind, TokenKind::Bad);
}

TEST(Lexer, CommentsReachToTheEndOfTheLine) {
    const auto tokens = tokens_of("##RenderMan RIB\nSphere#1 2\r\n[3]# 4");
    ASSERT_EQ(tokens.size(), 4u);
    EXPECT_EQ(tokens[0].text, "Sphere");
    EXPECT_EQ(tokens[2].number, 3);
}

TEST(Lexer, PlacesCountFromOneInEveryKindOfLine) {
    const auto tokens = tokens_of("A\n  B\r\n\tC\rD \"x\ny\" E");
    ASSERT_EQ(tokens.size(), 6u);
    const uint32_t lines[] = {1, 2, 3, 4, 4, 5}, columns[] = {1, 3, 2, 1, 3, 4};
    for (size_t i = 0; i < 6; ++i) {
        EXPECT_EQ(tokens[i].at.line, lines[i]) << i;
        EXPECT_EQ(tokens[i].at.column, columns[i]) << i;
    }
}

TEST(Lexer, TextMayBeginWithinAFile) {
    Lexer lexer("A\nB", {3, 7, 20});
    EXPECT_EQ(lexer.peek().at.line, 7u);
    EXPECT_EQ(lexer.peek().at.column, 20u);
    lexer.skip();
    EXPECT_EQ(lexer.peek().at.line, 8u);
    EXPECT_EQ(lexer.peek().at.column, 1u);
    EXPECT_EQ(lexer.offset(), 2u);
}

TEST(Lexer, EncodedValuesAreTokens) {
    // An array of two floats, a short string, 258 as an integer of two bytes; then text.
    const std::string bytes = std::string("\xC8\x02\x3f\x80\0\0\xc0\0\0\0", 10) + "\x93" + "abc" +
                              std::string("\x81\x01\x02", 3) + "Sphere";
    const auto tokens = tokens_of(bytes);
    ASSERT_EQ(tokens.size(), 4u);
    EXPECT_EQ(tokens[0].kind, TokenKind::Floats);
    EXPECT_EQ(tokens[0].text.size(), 8u);
    EXPECT_EQ(tokens[1].kind, TokenKind::String);
    EXPECT_EQ(tokens[1].string, "abc");
    EXPECT_EQ(tokens[2].kind, TokenKind::Number);
    EXPECT_EQ(tokens[2].number, 258);
    EXPECT_EQ(tokens[3].text, "Sphere");
}

TEST(Lexer, DefinitionsAreNoTokens) {
    const auto tokens =
        tokens_of(std::string("\xCC\x05\x96Sphere\xCD\x07 \"vertex point P\"\xA6\x05\xCF\x07"));
    ASSERT_EQ(tokens.size(), 2u);
    EXPECT_EQ(tokens[0].kind, TokenKind::Word);
    EXPECT_EQ(tokens[1].kind, TokenKind::String);
    EXPECT_EQ(tokens[1].string, "vertex point P");
}

TEST(Lexer, LengthsBeyondTheTextEndWithIt) {
    for (const char* bytes : {"\xCB\xFF\xFF\xFF\xFF 1 2", "\xA4", "\xA3\x7F\xFF\xFF\xFFxyz", "\xCD"}) {
        const auto tokens = tokens_of(bytes);
        ASSERT_EQ(tokens.size(), 1u);
        EXPECT_EQ(tokens[0].kind, TokenKind::Bad);
    }
}

}  // namespace
}  // namespace trapeze::rib
