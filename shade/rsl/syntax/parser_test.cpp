#include <gtest/gtest.h>

#include "shade/rsl/front_end_harness.h"

namespace trapeze::rsl {
namespace {

using testing::Heard;

/// What an expression is printed as, parentheses only where the tree needs them.
std::string printed(const std::string& expression) {
    Heard heard;
    const auto unit = parse({"t.sl", "surface t() { x = " + expression + "; }"}, {}, heard.diagnostics);
    if (!unit) return heard.all();
    return print(*unit->shaders[0]->body->children[0]->expressions[0]->children[1]);
}

/// The tree with a parenthesis around each operation.
std::string grouped(const Expression& e) {
    static const char* kMarks[] = {
        "", "+", "-", "*", "/", ".", "^", "<", "<=", ">", ">=", "==", "!=", "&&", "||", "-", "!"};
    const std::string mark = kMarks[static_cast<int>(e.op)];
    switch (e.kind) {
        case Expression::Kind::Binary:
            return "(" + grouped(*e.children[0]) + mark + grouped(*e.children[1]) + ")";
        case Expression::Kind::Unary:
            return "(" + mark + grouped(*e.children[0]) + ")";
        case Expression::Kind::Conditional:
            return "(" + grouped(*e.children[0]) + "?" + grouped(*e.children[1]) + ":" +
                   grouped(*e.children[2]) + ")";
        case Expression::Kind::Cast:
            return "<" + print(e.type) + (e.text.empty() ? "" : " " + e.text) + ">" + grouped(*e.children[0]);
        case Expression::Kind::Assignment:
            return "(" + grouped(*e.children[0]) + mark + "=" + grouped(*e.children[1]) + ")";
        default:
            return print(e);
    }
}

std::string tree_of_expression(const std::string& expression) {
    Heard heard;
    const auto unit = parse({"t.sl", "surface t() { x = " + expression + "; }"}, {}, heard.diagnostics);
    if (!unit) return heard.all();
    return grouped(*unit->shaders[0]->body->children[0]->expressions[0]->children[1]);
}

std::string errors(const std::string& text) {
    Heard heard;
    const auto unit = parse({"t.sl", text}, {}, heard.diagnostics);
    EXPECT_EQ(unit == nullptr, heard.diagnostics.count(Severity::Error) > 0) << heard.all();
    return heard.all();
}

TEST(Parser, PrecedenceIsThatOfTheLanguage) {
    EXPECT_EQ(tree_of_expression("a + b * c"), "(a+(b*c))");
    EXPECT_EQ(tree_of_expression("a * b . c"), "(a*(b.c))");  // the dot product binds tightest
    EXPECT_EQ(tree_of_expression("a ^ b * c"), "(a^(b*c))");
    EXPECT_EQ(tree_of_expression("a + b ^ c"), "(a+(b^c))");
    EXPECT_EQ(tree_of_expression("-a . b"), "((-a).b)");
    EXPECT_EQ(tree_of_expression("a - b - c"), "((a-b)-c)");
    EXPECT_EQ(tree_of_expression("a / b / c * d"), "(((a/b)/c)*d)");
    EXPECT_EQ(tree_of_expression("a < b && c == d || !e"), "(((a<b)&&(c==d))||(!e))");
    EXPECT_EQ(tree_of_expression("a ? b : c ? d : e"), "(a?b:(c?d:e))");
    EXPECT_EQ(tree_of_expression("a > b ? c + 1 : d"), "((a>b)?(c+1):d)");
    EXPECT_EQ(tree_of_expression("y = z += 2"), "(y=(z+=2))");
    EXPECT_EQ(tree_of_expression("a--b"), "(a-(-b))");
}

TEST(Parser, CastsBindLikeSigns) {
    EXPECT_EQ(tree_of_expression("float noise(P) * 2"), "(<float>noise(P)*2)");
    EXPECT_EQ(tree_of_expression("point \"world\" (1, 2, 3) - Q"), "(<point world>(1, 2, 3)-Q)");
    EXPECT_EQ(tree_of_expression("vector a . b"), "(<vector>a.b)");
    EXPECT_EQ(tree_of_expression("color \"hsv\" (0, .5, 1)"), "<color hsv>(0, 0.5, 1)");
    EXPECT_EQ(tree_of_expression("matrix \"shader\" 1"), "<matrix shader>1");
    EXPECT_EQ(tree_of_expression("vector(0) + normal -N"), "(<vector>0+<normal>(-N))");
    // As in C.
    EXPECT_EQ(tree_of_expression("(float) noise(P) * 2"), "(<float>noise(P)*2)");
    EXPECT_EQ(tree_of_expression("((color) a)"), "<color>a");
}

TEST(Parser, PrinterKeepsTheTree) {
    for (const char* text :
         {"(a + b) * c", "a - (b - c)", "(a ? b : c) ? d : (e = f)", "-(a . b)", "(-a) . b", "(a ^ b) . c",
          "a ? (b = c) : d", "-(-a)", "!(a && b)", "float (a + b)", "(vector a)[1]", "vector (a) + b",
          "point \"world\" (a[1])", "f((x = 1), 2)", "texture(\"a\\\"b\\n\"[2], s, t)"}) {
        const std::string once = printed(text);
        EXPECT_EQ(printed(once), once);
        EXPECT_EQ(tree_of_expression(once), tree_of_expression(text)) << once;
    }
    EXPECT_EQ(printed("((a)) + (b * c)"), "a + b * c");
    // A statement that begins with a cast is no declaration.
    Heard heard;
    const auto unit = parse({"t.sl", "surface t() { vector +a * b; }"}, {}, heard.diagnostics);
    ASSERT_TRUE(unit);
    EXPECT_EQ(print(*unit), "surface t() {\n    vector (a) * b;\n}\n");
}

TEST(Parser, CommasJoinStatementsAndSteps) {
    Heard heard;
    const std::string text = "surface t() { for (i = 0; i < 3; i += 1, j -= 1, k = 2) x = 1, y = 2; }";
    const auto unit = parse({"t.sl", text}, {}, heard.diagnostics);
    ASSERT_TRUE(unit) << heard.all();
    const Statement& loop = *unit->shaders[0]->body->children[0];
    ASSERT_EQ(loop.expressions.size(), 5u);
    EXPECT_EQ(print(*loop.expressions[3]), "j -= 1");
    EXPECT_EQ(loop.children[0]->children.size(), 2u);
    const std::string once = print(*unit);
    EXPECT_NE(once.find("for (i = 0; i < 3; i += 1, j -= 1, k = 2)"), std::string::npos) << once;
    const auto again = parse({"t.sl", once}, {}, heard.diagnostics);
    ASSERT_TRUE(again) << heard.all();
    EXPECT_EQ(print(*again), once);
}

TEST(Parser, Numbers) {
    EXPECT_EQ(tree_of_expression(".5 + 1. + 1e3 + 2.5E-1 + 1e+2 + 3"), "(((((0.5+1)+1000)+0.25)+100)+3)");
    EXPECT_EQ(tree_of_expression("1.5f"), "1.5");
    EXPECT_EQ(tree_of_expression("1e-60"), "0");
    EXPECT_EQ(errors("surface t() { x = 2k; }"), "error 1:19: \"2k\" is no number\n");
}

TEST(Parser, Strings) {
    EXPECT_EQ(tree_of_expression("\"a\" \"b\"\n\"c\""), "\"abc\"");
    EXPECT_EQ(tree_of_expression("\"a\\\nb\""), "\"ab\"");
    EXPECT_EQ(tree_of_expression("\"\\101\\t\\q\""), "\"A\\011q\"");
    EXPECT_EQ(errors("surface t() { printf(\"oh); }\n"), "error 1:22: this string has no end on its line\n");
}

TEST(Parser, ParametersAreSeparatedAnyhow) {
    for (const char* text :
         {"surface t(float a = 1; color b = 2;) {}", "surface t(float a = 1, color b = 2) {}",
          "surface t(float a = 1;; color b = 2) {}"}) {
        Heard heard;
        const auto unit = parse({"t.sl", text}, {}, heard.diagnostics);
        ASSERT_TRUE(unit) << heard.all();
        ASSERT_EQ(unit->shaders[0]->parameters.size(), 2u);
        EXPECT_EQ(unit->shaders[0]->parameters[1]->name, "b");
        EXPECT_EQ(unit->shaders[0]->parameters[1]->type.base, Base::Color);
    }
    Heard heard;
    const auto unit =
        parse({"t.sl",
               "float f(float a, b; output uniform color c[]; point \"world\" p) { return a; }\n"
               "light l(float a = 1, b = 2; output varying string s[2] = {\"x\", \"y\"}) {}"},
              {}, heard.diagnostics);
    ASSERT_TRUE(unit) << heard.all();
    const auto& f = unit->functions[0]->parameters;
    ASSERT_EQ(f.size(), 4u);
    EXPECT_EQ(f[1]->type.base, Base::Float);
    EXPECT_TRUE(f[2]->output);
    EXPECT_EQ(f[2]->storage, Storage::Uniform);
    EXPECT_EQ(f[2]->type.length, Type::kUnsized);
    EXPECT_EQ(f[3]->type.base, Base::Point);
    const auto& l = unit->shaders[0]->parameters;
    EXPECT_EQ(unit->shaders[0]->kind, ShaderKind::Light);
    EXPECT_EQ(l[1]->name, "b");
    EXPECT_EQ(l[2]->type.length, 2);
    EXPECT_EQ(l[2]->initial->kind, Expression::Kind::List);
}

TEST(Parser, NestedFunctionsAreListedWithTheFiles) {
    Heard heard;
    const auto unit = parse({"t.sl",
                             "surface t() { float a = 1; float f(float x) { extern float a; return a + x; }\n"
                             "  Ci = f(2); float noise(P); }"},
                            {}, heard.diagnostics);
    ASSERT_TRUE(unit) << heard.all();
    ASSERT_EQ(unit->functions.size(), 1u);
    EXPECT_EQ(unit->functions[0]->inside, "t");
    const auto& body = unit->shaders[0]->body->children;
    ASSERT_EQ(body.size(), 4u);
    EXPECT_EQ(body[1]->defines, unit->functions[0].get());
    EXPECT_TRUE(unit->functions[0]->body->children[0]->variables[0]->external);
    EXPECT_EQ(body[3]->expressions[0]->kind, Expression::Kind::Cast);
}

TEST(Parser, ErrorsSayWhereAndGoOn) {
    EXPECT_EQ(errors("surface t()\n{\n  Ci = 1\n  Oi = ;\n  x = 2;\n}\n"),
              "error 3:9: expected \";\" after a statement\n");
    EXPECT_EQ(errors("surface t() {\n  Ci = ;\n  if x { }\n  y = (1, 2);\n}\nsurface u() { z = ; }\n"),
              "error 2:8: expected an expression, not \";\"\n"
              "error 3:6: expected \"(\" after \"if\", not \"x\"\n"
              "error 4:7: in parentheses stand one value, three or sixteen, not 2\n"
              "error 6:19: expected an expression, not \";\"\n");
    EXPECT_EQ(errors("surface t() { i++; }"),
              "error 1:17: there is no \"++\" in the shading language; write \"+= 1\"\n");
    EXPECT_EQ(errors("surface t() { float if = 2; }"),
              "error 1:21: \"if\" is a word of the language and no name\n");
    EXPECT_EQ(errors("surface t() { 1 = 2; }"),
              "error 1:17: only variables, elements and components can be assigned to\n");
    EXPECT_EQ(errors("float x = 3;"),
              "error 1:7: variables are declared in shaders and functions, not outside them\n");
    EXPECT_EQ(errors("surface t() { break 0; float a[0]; float b[99999]; float c[x]; }"),
              "error 1:21: \"break\" wants a number of loops, from 1\n"
              "error 1:32: an array has 1 to 65536 elements\n"
              "error 1:44: an array has 1 to 65536 elements\n"
              "error 1:60: an array's length is a constant whole number\n");
    EXPECT_EQ(errors("surface t() { Ci = 1;"), "error 1:22: expected \"}\" after a block\n");
    EXPECT_EQ(
        errors(
            "float f(float a) { return a; } float f(color c) { return 2; } color f(float b) { return b; }"),
        "");
    EXPECT_EQ(
        errors("float f(float a; color c) { return a; }\nfloat f(uniform float x; color y) { return 2; }"),
        "warning 2:7: function \"f\" is defined before with the same parameters: the first definition "
        "counts\n");
    EXPECT_NE(errors("transformation t() {}").find("transformation shaders are not supported"),
              std::string::npos);
}

TEST(Parser, Rsl2IsRefusedOnce) {
    for (const char* text :
         {"surface t(shader s = null) {}",
          "class c() { shader s; public void surface(output color Ci, Oi) { Ci = 1; } }",
          "class c() { public float f() { return 1; } }", "surface t() { x = s->f(1); y = ; }",
          "surface t() { Ci = s->x * 2; }", "surface t() { constant float x = 1; }"}) {
        const std::string said = errors(text);
        EXPECT_NE(said.find("RSL 2"), std::string::npos) << said;
        EXPECT_EQ(std::count(said.begin(), said.end(), '\n'), 1) << said;
    }
    // Those words are no reserved ones.
    EXPECT_EQ(errors("surface constant() { float shader = 1; float class = shader; Ci = class; }"), "");
}

TEST(Parser, DepthIsBounded) {
    const auto repeated = [](const std::string& text, int n) {
        std::string out;
        for (int i = 0; i < n; ++i) out += text;
        return out;
    };
    for (const std::string& inner :
         {repeated("(", 100000), repeated("-", 100000), repeated("a+", 100000) + "a",
          repeated("a=", 100000) + "a", repeated("float ", 100000), repeated("a?b:", 100000) + "c",
          repeated("a[", 100000), repeated("f(", 100000), "a" + repeated("[1]", 100000)})
        EXPECT_NE(errors("surface t() { x = " + inner + "; }"), "");
    for (const char* open :
         {"{", "if (a) ", "if (a) ; else ", "while (a) ", "for (;;) ", "solar() ", "float f() {"})
        EXPECT_NE(errors("surface t() { " + repeated(open, 100000)), "");
    // What people write is far from the bounds.
    EXPECT_EQ(
        errors("surface t() { x = " + repeated("a+", 300) + "a; " + repeated("if (a) ; else ", 100) + "; }"),
        "");
    EXPECT_EQ(errors("surface t() { " + repeated("x = 1;", 20000) + "}"), "");
}

TEST(Parser, ManyErrorsEndInOneLine) {
    std::string text = "surface t() {\n";
    for (int i = 0; i < 200; ++i) text += "x = ;\n";
    const std::string said = errors(text + "}\n");
    EXPECT_EQ(std::count(said.begin(), said.end(), '\n'), 51);
    EXPECT_NE(said.find("more than 50 errors"), std::string::npos);
}

class RoundTrip : public ::testing::TestWithParam<const char*> {};

TEST_P(RoundTrip, PrintedShadersParseToTheSameTree) {
    const std::string folder = std::string(TRAPEZE_SOURCE_DIR) + GetParam();
    const auto paths = testing::shaders_in(folder);
    ASSERT_FALSE(paths.empty());
    for (const auto& path : paths) {
        Heard heard;
        const auto first = parse({path.string(), trapeze::testing::file_text(path)}, {}, heard.diagnostics);
        ASSERT_TRUE(first) << path << "\n" << heard.all();
        const std::string text = print(*first);
        const auto second = parse({"printed", text}, {}, heard.diagnostics);
        ASSERT_TRUE(second) << path << "\n" << heard.all() << text;
        EXPECT_EQ(print(*second), text) << path;
        EXPECT_TRUE(testing::same(*first, *second)) << path;
    }
}

INSTANTIATE_TEST_SUITE_P(Shaders, RoundTrip, ::testing::Values("/shade/shaders", "/shade/rsl/test_shaders"));

}  // namespace
}  // namespace trapeze::rsl
