#include "shade/rsl/syntax/preprocessor.h"

#include <gtest/gtest.h>

#include <cmath>
#include <map>

#include "shade/rsl/front_end_harness.h"
#include "shade/rsl/syntax/token_values.h"

namespace trapeze::rsl {
namespace {

using testing::Heard;

struct Files {
    std::map<std::string, std::string> texts;
    CompileOptions options;
    Heard heard;

    explicit Files(std::map<std::string, std::string> files = {}) : texts(std::move(files)) {
        options.read_file = [this](const std::string& path) -> std::optional<std::string> {
            const auto entry = texts.find(path);
            if (entry == texts.end()) return {};
            return entry->second;
        };
    }

    /// The tokens that are left, between blanks.
    std::string expand(const std::string& text) {
        heard.lines.clear();
        Reporter reporter(heard.diagnostics);
        const TokenStream stream = preprocess({"dir/main.sl", text}, options, reporter);
        std::string out;
        for (const Token& token : stream.tokens)
            if (token.kind != Token::Kind::End) out += (out.empty() ? "" : " ") + std::string(token.text);
        return out;
    }
};

std::string expand(const std::string& text) {
    Files files;
    const std::string out = files.expand(text);
    EXPECT_EQ(files.heard.all(), "") << text;
    return out;
}

std::string complaints(const std::string& text) {
    Files files;
    files.expand(text);
    return files.heard.all();
}

TEST(Lexer, WordsAndComments) {
    EXPECT_EQ(expand("a/* b\n c */d // e\nf \"/*g*/\""), "a d f \"/*g*/\"");
    EXPECT_EQ(expand("x+=1.5e-3*.5;y->z"), "x += 1.5e-3 * .5 ; y -> z");
    EXPECT_EQ(expand("1.e2 3.x 5.5.5 a.b"), "1.e2 3.x 5.5 .5 a . b");
    EXPECT_EQ(expand("ab\\\ncd \"x\\\r\ny\" // z \\\n still"), "abcd \"xy\"");
    EXPECT_EQ(expand("a\r\nb\rc"), "a b c");
    EXPECT_EQ(expand("\xef\xbb\xbfsurface"), "surface");
    EXPECT_EQ(complaints("a /* b"), "error 1:3: this comment is never closed\n");
}

TEST(Lexer, EveryTokenKnowsItsPlace) {
    Heard heard;
    Reporter reporter(heard.diagnostics);
    const TokenStream stream =
        preprocess({"m.sl", "#define TWO x \\\n  y\n\n  TWO z/*\n*/ w\\\nv  \"s\"\n"}, {}, reporter);
    std::string places;
    for (const Token& token : stream.tokens)
        if (token.kind != Token::Kind::End)
            places += std::string(token.text) + "@" + std::to_string(token.at.line) + ":" +
                      std::to_string(token.at.column) + " ";
    EXPECT_EQ(places, "x@4:3 y@4:3 z@4:7 wv@5:4 \"s\"@6:4 ");
}

TEST(Macros, ObjectsAndFunctions) {
    EXPECT_EQ(expand("#define A 1 + B\n#define B 2\nA;B"), "1 + 2 ; 2");
    EXPECT_EQ(expand("#define F(x, y) (x * y)\nF(a, (b, c)) F (1,\n2) F;"),
              "( a * ( b , c ) ) ( 1 * 2 ) F ;");
    EXPECT_EQ(expand("#define F() 1\n#define G(x) [x]\nF() G() G( )"), "1 [ ] [ ]");
    EXPECT_EQ(expand("#define F (x)\nF"), "( x )");  // a blank before the parenthesis
    EXPECT_EQ(expand("#define A 1\n#undef A\nA\n#undef A"), "A");
}

TEST(Macros, ExpandAsTheStandardSays) {
    // ISO C99, 6.10.3.5, examples 3 and 4, abridged.
    const std::string defines =
        "#define x 3\n#define f(a) f(x * (a))\n#undef x\n#define x 2\n#define g f\n#define z z[0]\n"
        "#define h g(~\n#define m(a) a(w)\n#define w 0,1\n#define t(a) a\n#define p() int\n#define q(x) x\n"
        "#define r(x,y) x ## y\n";
    EXPECT_EQ(expand(defines + "f(y+1) + f(f(z)) % t(t(g)(0) + t)(1);"),
              "f ( 2 * ( y + 1 ) ) + f ( 2 * ( f ( 2 * ( z [ 0 ] ) ) ) ) % f ( 2 * ( 0 ) ) + t ( 1 ) ;");
    EXPECT_EQ(
        expand(defines + "g(x+(3,4)-w) | h 5) & m(f)^m(m);"),
        "f ( 2 * ( 2 + ( 3 , 4 ) - 0 , 1 ) ) | f ( 2 * ( ~ 5 ) ) & f ( 2 * ( 0 , 1 ) ) ^ m ( 0 , 1 ) ;");
    EXPECT_EQ(expand(defines + "p() i[q()] = { q(1), r(2,3), r(4,), r(,5), r(,) };"),
              "int i [ ] = { 1 , 23 , 4 , 5 , } ;");
    EXPECT_EQ(expand("#define hash_hash # ## #\n#define mkstr(a) # a\n#define in_between(a) mkstr(a)\n"
                     "#define join(c, d) in_between(c hash_hash d)\njoin(x, y);"),
              "\"x ## y\" ;");
    EXPECT_EQ(expand("#define A A B\n#define B A\nA B"), "A A A B");
}

TEST(Macros, HashesAndVariadic) {
    EXPECT_EQ(expand("#define S(x) #x\nS( a  \"b\\n\" + c ) S()"), "\"a \\\"b\\\\n\\\" + c\" \"\"");
    EXPECT_EQ(expand("#define C(a, b) a##b##_t\nC(x, 1) C(,y)"), "x1_t y_t");
    EXPECT_EQ(expand("#define P(f, ...) printf(f, __VA_ARGS__)\nP(1, 2, 3)"), "printf ( 1 , 2 , 3 )");
    EXPECT_EQ(expand("#define P(f, ...) printf(f, ## __VA_ARGS__)\nP(1) P(1, 2)"),
              "printf ( 1 ) printf ( 1 , 2 )");
    EXPECT_EQ(expand("#define L(rest...) { rest }\nL(1, 2)"), "{ 1 , 2 }");
    EXPECT_EQ(expand("#line 7 \"q.sl\"\n__LINE__ __FILE__ TRAPEZE"), "7 \"q.sl\" 1");
    EXPECT_EQ(expand("#ifdef PRMAN\nno\n#endif\n#ifdef AQSIS\nno\n#endif"), "");
}

TEST(Macros, MistakesAreSaid) {
    EXPECT_EQ(complaints("#define F(x, y) x\nF(1)"),
              "error 2:1: macro \"F\" takes 2 arguments, 1 are given\n");
    EXPECT_EQ(complaints("#define F(x) x\nF(1"),
              "error 2:1: the arguments of macro \"F\" never end: a ) is missing\n");
    EXPECT_EQ(complaints("#define A 1\n#define A 2"),
              "warning 2:9: macro \"A\" is defined anew, differently\n");
    EXPECT_EQ(complaints("#define A 1\n#define A  1 /* same */"), "");
    EXPECT_EQ(complaints("#define F(1) x"),
              "error 1:11: the parameters of macro \"F\" are names between ( , )\n");
    EXPECT_EQ(complaints("#define C(a) a ## +\nC(b)"), "error 2:1: ## makes no word of \"b\" and \"+\"\n");
    EXPECT_EQ(complaints("#define C(a) ## a"), "error 1:9: ## stands between two words, in macro \"C\"\n");
    EXPECT_EQ(complaints("#define"), "error 1:2: #define wants a name\n");
    EXPECT_EQ(complaints("#frobnicate"), "warning 1:1: unknown directive #frobnicate (ignored)\n");
    EXPECT_EQ(complaints("#error it isn't so"), "error 1:2: it isn't so\n");
    EXPECT_EQ(complaints("#warning \"so\""), "warning 1:2: so\n");
    EXPECT_EQ(complaints("#define F(x) x\nF(\n#undef F\n1\n#define F(a, b, c) a b c\n)"), "");
}

TEST(Conditions, TakeTheRightLines) {
    EXPECT_EQ(expand("#if 0\na\n#if 1\nb\n#else\nc\n#endif\n#elif 2 > 1\nd\n#elif 1\ne\n#else\nf\n#endif"),
              "d");
    EXPECT_EQ(expand("#define A\n#ifdef A\n1\n#else\n2\n#endif\n#ifndef A\n3\n#endif"), "1");
    EXPECT_EQ(expand("#if 0\n ' \" /* \n */ #else\n#error no\n#frobnicate\n#endif"), "");
}

TEST(Conditions, HaveWholeNumbers) {
    const auto holds = [](const std::string& condition) {
        return expand("#define A 3\n#define F(x) (x + 1)\n#if " + condition + "\nyes\n#endif") == "yes";
    };
    EXPECT_TRUE(holds("1 + 2 * 3 == 7 && !(5 % 3 - 2)"));
    EXPECT_TRUE(holds("defined A && defined(F) && !defined B"));
    EXPECT_TRUE(holds("F(A) == 4 && UNKNOWN == 0"));
    EXPECT_TRUE(holds("0x10 == 16 && 010 == 8 && 5L == 5u"));
    EXPECT_TRUE(holds("(1 << 4 | 3) == 19 && (6 ^ 3) == 5 && ~0 == -1 && (7 & 2)"));
    EXPECT_TRUE(holds("1 ? 2 : 0 / 0"));
    EXPECT_TRUE(holds("0 && 1 / 0 || 1"));
    EXPECT_TRUE(holds("-1 < 0 && 3 >= 3 && 2 != 3 && 1 <= 2 && -7 / 2 == -3 && 1 >> 70 == 0"));
    EXPECT_FALSE(holds("0 ? 1 : 0"));
    EXPECT_FALSE(holds("A - 3"));
    EXPECT_EQ(complaints("#if 1 / 0\n#endif"), "error 1:7: division by zero in a condition\n");
    EXPECT_EQ(complaints("#if\n#endif"), "error 1:2: this condition is not complete\n");
    EXPECT_EQ(complaints("#if 1.5\n#endif"),
              "error 1:5: a condition has whole numbers, names and operators only\n");
    EXPECT_EQ(complaints("#if (1\n#endif"), "error 1:2: a ) is missing in this condition\n");
    EXPECT_EQ(complaints("#if 1 2\n#endif"), "error 1:7: this does not belong to the condition\n");
    EXPECT_EQ(complaints("#if defined(\n#endif"), "error 1:5: \"defined\" wants a name\n");
    EXPECT_EQ(complaints("#if 1\n"), "error 1:2: this condition has no #endif\n");
    EXPECT_EQ(complaints("#endif\n#else\n#if 1\n#else\n#elif 1\n#endif"),
              "error 1:2: #endif without #if\nerror 2:2: #else without #if\nerror 5:2: #elif after #else\n");
    EXPECT_EQ(complaints("#if -9223372036854775807 - 1 / -1 % -1 * 9223372036854775807\n#endif"), "");
}

TEST(Includes, AreSearchedBesideAndInFolders) {
    Files files({{"dir/a.h", "beside"},
                 {"inc/a.h", "folder"},
                 {"inc/sub/b.h", "#include \"c.h\""},
                 {"inc/sub/c.h", "c"}});
    files.options.include_folders = {"none", "inc"};
    EXPECT_EQ(
        files.expand(
            "#include \"a.h\"\n#include <a.h>\n#include <sub/b.h>\n#define NAME \"a.h\"\n#include NAME"),
        "beside folder c beside");
    EXPECT_EQ(files.heard.all(), "");
    files.expand("\n  #include \"d.h\"");
    EXPECT_EQ(files.heard.all(), "error 2:4: file \"d.h\" is not found in any of the folders to search\n");
    files.expand("#include d");
    EXPECT_EQ(files.heard.all(), "error 1:2: #include wants \"file\" or <file>\n");
}

TEST(Includes, AreSearchedAboveAndInFoldersOfHeaders) {
    Files files({{"dir/../a.h", "above"},
                 {"dir/include/b.h", "below"},
                 {"dir/../../headers/c.h", "aside"},
                 {"dir/../include/a.h", "further"},
                 {"inc/d.h", "folder"},
                 {"dir/../d.h", "above"}});
    files.options.include_folders = {"inc"};
    EXPECT_EQ(files.expand("#include \"a.h\"\n#include <b.h>\n#include \"c.h\"\n#include \"d.h\""),
              "above below aside folder");
    EXPECT_EQ(files.heard.all(), "");
}

TEST(Includes, MessagesKnowTheWay) {
    std::vector<Diagnostic> heard;
    Diagnostics diagnostics([&](const Diagnostic& d) { heard.push_back(d); });
    Reporter reporter(diagnostics);
    Files files({{"dir/a.h", "\n#include \"b.h\"\n"}, {"dir/b.h", "#error deep"}});
    preprocess({"dir/main.sl", "#include \"a.h\"\n"}, files.options, reporter);
    ASSERT_EQ(heard.size(), 1u);
    EXPECT_EQ(to_string(heard[0]),
              "dir/b.h:1:2: error: deep\n    #error deep\n     ^\n"
              "    included from dir/a.h:2:2\n    included from dir/main.sl:1:2");
}

TEST(Includes, AreBounded) {
    Files files({{"dir/self.h", "#include \"self.h\"\n"},
                 {"dir/twice.h", "#include \"twice.h\"\n#include \"twice.h\"\n"},
                 {"dir/once.h", "#pragma once\nx\n#include \"once.h\"\n"}});
    files.expand("#include \"self.h\"");
    EXPECT_NE(files.heard.first().find("files include each other too deeply"), std::string::npos);
    files.expand("#include \"twice.h\"");
    EXPECT_LT(files.heard.lines.size(), 60u);
    EXPECT_EQ(files.expand("#include \"once.h\"\n#include \"once.h\"\n"), "x");
    EXPECT_EQ(files.heard.all(), "");
    Files large({{"dir/l.h", std::string(size_t{20} << 20, ' ')}});
    large.expand("#include \"l.h\"\n#include \"l.h\"\n#include \"l.h\"\n#include \"l.h\"\n");
    EXPECT_EQ(large.heard.all(), "error 4:2: the included files are too large together\n");
}

TEST(Lines, AreRenumbered) {
    std::vector<Diagnostic> heard;
    Diagnostics diagnostics([&](const Diagnostic& d) { heard.push_back(d); });
    Reporter reporter(diagnostics);
    preprocess(
        {"main.sl",
         "# 1 \"real.sl\"\nfine\n# 20 \"other.h\" 1\n\n  #error here\n# 3 \"real.sl\" 2\n#error there\n"},
        {}, reporter);
    ASSERT_EQ(heard.size(), 2u);
    EXPECT_EQ(to_string(heard[0]), "other.h:21:4: error: here\n      #error here\n       ^");
    EXPECT_EQ(to_string(heard[1]), "real.sl:3:2: error: there\n    #error there\n     ^");
    EXPECT_EQ(complaints("#line x"), "error 1:2: #line wants a line number\n");
    EXPECT_EQ(complaints("#line 99999999999"), "error 1:2: #line wants a line number\n");
}

TEST(Bounds, ExpansionEnds) {
    std::string doubling = "#define M0 x\n";
    for (int i = 1; i < 60; ++i)
        doubling += "#define M" + std::to_string(i) + " M" + std::to_string(i - 1) + " M" +
                    std::to_string(i - 1) + "\n";
    EXPECT_NE(complaints(doubling + "M59").find("expand without end"), std::string::npos);
    std::string words;
    for (int i = 0; i < (1 << 20) + 1; ++i) words += "x ";
    EXPECT_NE(complaints(words).find("this file is too large after its macros"), std::string::npos);
    std::string arguments = "#define F(x) x x\n", call = "y";
    for (int i = 0; i < 60; ++i) call = "F(" + call + ")";
    EXPECT_NE(complaints(arguments + call).find("expand without end"), std::string::npos);
    call = "y";
    for (int i = 0; i < 5000; ++i) call = "F(" + call + ")";
    EXPECT_NE(complaints("#define F(x) x\n" + call).find("nest too deeply"), std::string::npos);
    std::string chain = "#define C0 x\n";
    for (int i = 1; i < 5000; ++i)
        chain += "#define C" + std::to_string(i) + " C" + std::to_string(i - 1) + "\n";
    EXPECT_NE(complaints(chain + "C4999").find("nest too deeply"), std::string::npos);
    std::string pasting = "#define P(x) x ## x\n#define Q(x) P(x)\n";
    call = "abcdefgh";
    for (int i = 0; i < 40; ++i) call = "Q(" + call + ")";
    EXPECT_NE(complaints(pasting + call).find("too much text"), std::string::npos);
    std::string conditions;
    for (int i = 0; i < 10000; ++i) conditions += "#if 1\n";
    EXPECT_NE(complaints(conditions).find("conditions nest too deeply"), std::string::npos);
    EXPECT_NE(complaints("#if " + std::string(100000, '(')).find("nests too deeply"), std::string::npos);
    EXPECT_NE(complaints("#if " + std::string(100000, '!')).find("nests too deeply"), std::string::npos);
}

TEST(TokenValues, SaysWhatIsNoWord) {
    const auto errors = [](const std::string& text) {
        Heard heard;
        Reporter reporter(heard.diagnostics);
        TokenStream stream = preprocess({"t.sl", text}, {}, reporter);
        read_values(stream, reporter);
        return heard.all();
    };
    EXPECT_EQ(errors("a @@@ b"), "error 1:3: \"@\" means nothing in a shader\n");
    EXPECT_EQ(errors(std::string("a \x01 b\0", 6)),
              "error 1:3: the byte 0x01 means nothing in a shader\n"
              "error 1:6: the byte 0x00 means nothing in a shader\n");
    EXPECT_EQ(errors("\"abc"), "error 1:1: this string has no end on its line\n");
    EXPECT_EQ(errors("0x1F 12abc"), "error 1:1: \"0x1F\" is no number\nerror 1:6: \"12abc\" is no number\n");
    EXPECT_EQ(errors(std::string(1 << 20, 'a')), "error 1:1: a name of 1048576 letters is too long\n");
}

TEST(TokenValues, GivesValues) {
    Heard heard;
    Reporter reporter(heard.diagnostics);
    TokenStream stream =
        preprocess({"t.sl", "1 .5 2.5e2 1e99 1e-99 3.f \"a\\n\\\"\" \"b\\102\""}, {}, reporter);
    read_values(stream, reporter);
    EXPECT_EQ(heard.all(), "");
    ASSERT_EQ(stream.tokens.size(), 8u);
    EXPECT_EQ(stream.tokens[0].number, 1.0f);
    EXPECT_EQ(stream.tokens[1].number, 0.5f);
    EXPECT_EQ(stream.tokens[2].number, 250.0f);
    EXPECT_EQ(stream.tokens[3].number, HUGE_VALF);
    EXPECT_EQ(stream.tokens[4].number, 0.0f);
    EXPECT_EQ(stream.tokens[5].number, 3.0f);
    EXPECT_EQ(stream.tokens[6].text, "a\n\"bB");
}

}  // namespace
}  // namespace trapeze::rsl
