#include <gtest/gtest.h>

#include "shade/rsl/analysis/analysis_harness.h"
#include "shade/rsl/analysis/globals.h"

namespace trapeze::rsl {
namespace {

using testing::compiled;
using testing::Heard;
using testing::in_surface;
using testing::said;

TEST(Analysis, LocalsShadowAndEnd) {
    EXPECT_EQ(in_surface("float s = s * 2; { float s = s; } Ci = s;"), "");
    EXPECT_EQ(in_surface("{ float q = 1; } Ci = q;"), "error 1:89: there is no variable \"q\"\n");
    EXPECT_EQ(in_surface("float q; color q; q = color (1, 2, 3);"),
              "warning 1:82: \"q\" is declared twice: this one hides the other\n");
    EXPECT_EQ(said("surface t(float q = 1; color q = 1) {}"), "error 1:30: \"q\" is declared twice\n");
}

TEST(Analysis, CallsThatComeBackAreFound) {
    EXPECT_EQ(said("float f(float x) { return f(x - 1); } surface t() { Ci = f(1); }"),
              "error 1:27: function \"f\" calls itself, directly or through others\n");
    EXPECT_EQ(
        said(
            "float g(float x) { return f(x); } float f(float x) { return g(x); } surface t() { Ci = f(1); }"),
        "error 1:27: function \"f\" calls itself, directly or through others\n");
    EXPECT_EQ(said("surface t() { float f(float x) { return f(x); } Ci = f(1); }"),
              "error 1:41: function \"f\" calls itself, directly or through others\n");
}

TEST(Analysis, FunctionsOfTheSourceComeFirst) {
    EXPECT_EQ(said("float noise(string s) { return 1; } float abs(float x) { return x; }\n"
                   "surface t() { float a = noise(\"x\") + noise(P) + abs(2); Ci = a; }"),
              "");
    EXPECT_EQ(
        said("f(float x) { return x; } g(float x) { printf(\"%f\", x); } surface t() { Ci = f(1); g(2); }"),
        "");
    EXPECT_EQ(said("void f() { return 1; } float g() { return; } float h() { } surface t() { f(); g(); h(); "
                   "return 2; }"),
              "error 1:12: this function returns nothing: its type is void\n"
              "error 1:36: a float is to be returned\n"
              "warning 1:30: function \"g\" never returns a value: it is 0\n"
              "warning 1:52: function \"h\" never returns a value: it is 0\n"
              "error 1:89: a shader returns no value\n");
}

TEST(Analysis, JumpsNeedLoops) {
    EXPECT_EQ(in_surface("break;"), "error 1:67: break stands outside of loops\n");
    EXPECT_EQ(in_surface("while (Kd > 1) { for (;;) { break 2; continue 3; } }"),
              "error 1:104: continue 3 stands in only 2 loops\n");
    EXPECT_EQ(in_surface("illuminance(P) { break; }"), "");
    EXPECT_EQ(in_surface("gather(\"illuminance\", P, N, 0, 1) { break; } else { continue; }"), "");
    EXPECT_EQ(said("void f() { break; } surface t() { while (1) f(); }"),
              "error 1:12: break stands outside of loops\n");
}

TEST(Analysis, LightStatementsAreChecked) {
    EXPECT_EQ(in_surface("illuminance(\"key\", P, N, PI / 2) { Ci += Cl * normalize(L) . N; }"), "");
    EXPECT_EQ(in_surface("illuminance(P, N) ;"),
              "error 1:67: illuminance takes ([category,] P [, axis, angle])\n");
    EXPECT_EQ(in_surface("solar() ;"), "error 1:67: solar belongs into light shaders\n");
    EXPECT_EQ(said("light t() { illuminate(P, N, 1) Cl = 1; solar() Cl = 2; solar((0, 0, 1), 0) Cl = 3; }"),
              "");
    Heard heard;
    const auto unit = compiled("surface t() { illuminance(P, N, 1) Ci = 1; }", heard);
    ASSERT_TRUE(unit);
    std::string names;
    for (const auto& variable : unit->shaders[0]->globals) names += variable->name + " ";
    EXPECT_EQ(names, "P N L Cl Ci ");
    EXPECT_EQ(
        in_surface(
            "color c; float d; gather(\"illuminance\", P, N, .1, 4, \"surface:Ci\", c, \"ray:length\", d)"
            " Ci += c; else Ci += 1;"),
        "");
    EXPECT_EQ(in_surface("gather(\"x\", P, N, .1, 4, \"surface:Ci\", Cs * 2) ;"),
              "error 1:109: gather writes \"surface:Ci\" to a variable\n");
}

TEST(Analysis, ArraysAreBounded) {
    EXPECT_EQ(in_surface("float a[3] = {1, 2, 3}; Ci = a[2];"), "");
    EXPECT_EQ(in_surface("float a[3]; Ci = a[3] + a[-1];"),
              "error 1:86: this array has 3 elements, 0 to 2\n"
              "error 1:93: this array has 3 elements, 0 to 2\n");
    EXPECT_EQ(in_surface("float a[2] = {1, 2, 3};"), "error 1:87: 3 values for the 2 elements of \"a\"\n");
    EXPECT_EQ(in_surface("float a[4] = {1, 2, ...}; a = {3, ...}; a = {1, 2, 3, 4, ...};"), "");
    EXPECT_EQ(in_surface("float a[1] = {1, 2, ...};"), "error 1:84: 2 values for the 1 elements of \"a\"\n");
    EXPECT_EQ(in_surface("float a[] = {1, ...};"),
              "error 1:79: \"...\" fills arrays of a length of their own alone\n");
    EXPECT_EQ(in_surface("float a[]; a = {1, ...};"),
              "error 1:82: \"...\" fills arrays of a length of their own alone\n");
    EXPECT_TRUE(in_surface("float a[4] = {...};").starts_with("error 1:81: expected"));
    EXPECT_EQ(in_surface("float a[] = 3;"), "error 1:79: array \"a\" needs a length, or values in braces\n");
    EXPECT_EQ(in_surface("float a[] = {1, 2}; Ci = a[1];"), "");
    EXPECT_EQ(in_surface("matrix a[65536];"),
              "error 1:74: array \"a\" is too large: 1048576 floats, at most 65536\n");
    EXPECT_EQ(in_surface("float a[65536]; float b[65536]; float c[65536]; float d[65536]; float e[65536];"),
              "error 1:9: the arrays of this shader are too large together\n");
    EXPECT_EQ(
        said(
            "float sum(float a[]) { return a[0] + a[1]; } surface t() { float b[2] = {1, 2}; Ci = sum(b); }"),
        "");
}

TEST(Analysis, ArraysWithoutALengthAreResized) {
    EXPECT_EQ(in_surface("float a[]; push(a, 1); a = {2, 3, 4}; float b[] = a; b = {}; Ci = pop(a);"), "");
    EXPECT_EQ(in_surface("float a[] = {1, 2}; push(a, 3); Ci = a[2]; a = {1, 2, 3, 4};"), "");
    EXPECT_EQ(in_surface("float a[] = {1, 2}, b[] = {1}; a = b; Ci = a[2];"), "");
    EXPECT_EQ(in_surface("float a[] = {1, 2}; Ci = a[2];"),
              "error 1:94: this array has 2 elements, 0 to 1\n");
    EXPECT_EQ(in_surface("float a[2]; push(a, 3);"),
              "error 1:84: array \"a\" has a length of its own, and keeps it: \"a[]\" would declare one that "
              "can be resized\n");
    EXPECT_TRUE(
        in_surface("float a[]; push(a, \"x\");").starts_with("error 1:78: no push takes (float[], string)"));
    EXPECT_EQ(said("void add(float a[]) { push(a, 1); } surface t() { float b[]; add(b); }"),
              "error 1:28: array \"a\" cannot be assigned to: it is no output parameter\n");
    EXPECT_EQ(in_surface("uniform float a[]; push(a, s);"),
              "warning 1:91: \"a\" is uniform and gets a varying value: it becomes varying\n");
    std::string many;
    for (int i = 0; i < 4097; ++i) many += "float a" + std::to_string(i) + "[];";
    EXPECT_EQ(in_surface(many), "error 1:9: the arrays of this shader are too large together\n");
}

TEST(Analysis, UniformVariablesBecomeVarying) {
    Heard heard;
    const auto unit = compiled("surface t() { uniform float a = s; uniform float b = 1; a = 2; }", heard);
    ASSERT_TRUE(unit);
    EXPECT_EQ(heard.all(), "warning 1:29: \"a\" is uniform and gets a varying value: it becomes varying\n");
    const auto& body = unit->shaders[0]->body->children;
    EXPECT_EQ(body[0]->variables[0]->storage, Storage::Varying);
    EXPECT_EQ(body[1]->variables[0]->storage, Storage::Uniform);
    // Through others, against the order of the source, and through functions.
    EXPECT_EQ(in_surface("uniform float a = 0; uniform float b = 0; b = a; a = s;"),
              "warning 1:116: \"a\" is uniform and gets a varying value: it becomes varying\n"
              "warning 1:109: \"b\" is uniform and gets a varying value: it becomes varying\n");
    EXPECT_EQ(said("float f(float x) { return x * 2; } surface t() { uniform float a = f(s); }"),
              "warning 1:64: \"a\" is uniform and gets a varying value: it becomes varying\n");
    EXPECT_EQ(said("float f(float x) { return x * 2; } surface t() { uniform float a = f(1); }"), "");
    // A grid has one value of these, though the machine's grids have one each.
    const std::string of_grid =
        "uniform float a = gridmin(s), b = 2 * a + gridavg(t); a = max(gridmax(u), 1);";
    EXPECT_EQ(in_surface(of_grid + "float c[2] = s; uniform float n = arraylength(c);"), "");
    EXPECT_EQ(said("uniform float f(varying float x) { return sqrt(gridmin(x)); } float g(uniform float y) { "
                   "return y; } surface t() { uniform float a = f(s), b = g(a) * f(t); }"),
              "");
    EXPECT_EQ(in_surface("uniform float a = gridmin(s), b = a; a = s;"),
              "warning 1:104: \"a\" is uniform and gets a varying value: it becomes varying\n"
              "warning 1:97: \"b\" is uniform and gets a varying value: it becomes varying\n");
    EXPECT_EQ(in_surface("uniform float a = gridmin(s) * s;"),
              "warning 1:81: \"a\" is uniform and gets a varying value: it becomes varying\n");
    EXPECT_EQ(said("float f(uniform float x) { return x * 2; } surface t() { Ci = f(s); }"),
              "warning 1:65: \"x\" is uniform and gets a varying value: it becomes varying\n");
}

TEST(Analysis, TextsThatWouldVaryAreWarnedOf) {
    const std::string decides = ": the first vertex of all that are shaded together decides for all\n";
    const std::string set = " is a string, and set where only some vertices take part" + decides;
    EXPECT_EQ(in_surface("string a = \"x\"; if (s > .5) a = \"y\";"), "warning 1:95: \"a\"" + set);
    EXPECT_EQ(in_surface("string a; if (s > .5) attribute(\"x\", a);"), "warning 1:104: \"a\"" + set);
    EXPECT_EQ(said("void f(output string b) { b = \"y\"; } surface t() { string a; if (s > .5) f(a); }"),
              "warning 1:76: \"a\"" + set);
    EXPECT_EQ(said("surface t(output string a = \"\") { if (s > .5) return; a = \"y\"; }"),
              "warning 1:55: \"a\"" + set);
    EXPECT_EQ(in_surface("string a[2] = {\"x\", \"y\"}; printf(a[s]);"),
              "warning 1:101: a string is chosen by what varies" + decides);
    EXPECT_EQ(in_surface("string a = s > .5 ? \"x\" : \"y\";"),
              "warning 1:85: a string is chosen by what varies" + decides);
    EXPECT_EQ(in_surface("string a = format(\"%f.tif\", s);"),
              "warning 1:78: a string is made of what varies" + decides);
    EXPECT_EQ(said("string f(float x) { return format(\"%f\", x); } surface t() { printf(f(s)); }"),
              "warning 1:28: a string is made of what varies" + decides);
    // What is the same for all, or for each light; and a texture's channel.
    EXPECT_EQ(in_surface("Ci = texture(\"a.tif\"[2 * s], s, t);"), "");
    EXPECT_EQ(in_surface(
                  "uniform float x = 1; string a[2] = {\"x\", \"y\"}; if (x > .5) a[x] = format(\"%f\", x);"),
              "");
    EXPECT_EQ(in_surface("if (s > .5) { string a = \"x\"; uniform float x = 1; if (x > 0) a = \"y\"; }"), "");
    EXPECT_EQ(in_surface("string a; illuminance(P) { if (lightsource(\"__a\", a) == 1) a = \"y\"; }"), "");
}

TEST(Analysis, ParametersOfFunctionsHaveDefaultValues) {
    const auto with = [](const std::string& parameters, const std::string& call) {
        return said("float f(" + parameters + ") { return 1; } surface t() { Ci = " + call + "; }");
    };
    const std::string ab = "color c; float a = 3; string b = concat(\"x\", \"y\")";
    for (const char* call : {"f(Cs)", "f(Cs, 2)", "f(Cs, 2, \"z\")", "f(Cs, \"a\", 2)", "f(Cs, \"b\", \"a\")",
                             "f(Cs, \"b\", \"z\", \"a\", 2)", "f(Cs, 2, \"b\", \"z\")"})
        EXPECT_EQ(with(ab, call), "") << call;
    EXPECT_EQ(with(ab, "f(Cs, 2, \"a\", 2)"), "error 1:102: this parameter is given twice\n");
    EXPECT_EQ(with(ab, "f()"),
              "error 1:93: no f takes ()\n"
              "note 1:93: there is float f(color, float = 3, string = concat(\"x\", \"y\"))\n");
    EXPECT_EQ(with(ab, "f(Cs, 2, 3)"),
              "error 1:102: argument 3 of f is a float, a string is wanted\n"
              "note 1:102: float f(color, float = 3, string = concat(\"x\", \"y\"))\n");
    const std::string ignored =
        " is ignored: those of functions' parameters stand behind all others, name no variables, and are of "
        "none that are output or arrays\n";
    EXPECT_EQ(with("float a = 3; float b", "f(1, 2)"), "warning 1:15: the default value of \"a\"" + ignored);
    EXPECT_EQ(with("float a = s", "f(1)"), "warning 1:15: the default value of \"a\"" + ignored);
    EXPECT_EQ(with("output float a = 1", "f(Ci)").substr(0, 43),
              "warning 1:22: the default value of \"a\" is i");
    // What takes just these arguments is meant before what has more.
    EXPECT_EQ(
        said("void f(float a; float b = 1) { } float f(float a) { return a; } surface t() { Ci = f(1); }"),
        "");
}

TEST(Analysis, UniformVariablesPartWithControl) {
    const auto storage = [](const std::string& body) {
        Heard heard;
        const auto unit = compiled("surface t() { uniform float a = 0; " + body + " }", heard);
        EXPECT_TRUE(unit) << heard.all();
        EXPECT_EQ(heard.all(), "") << body;
        return unit ? unit->shaders[0]->body->children[0]->variables[0]->storage : Storage::Unspecified;
    };
    EXPECT_EQ(storage("if (a > 1) a = 2;"), Storage::Uniform);
    EXPECT_EQ(storage("if (s > 1) a = 2;"), Storage::Varying);
    EXPECT_EQ(storage("for (a = 0; a < 3; a += 1) { Ci += a; }"), Storage::Uniform);
    EXPECT_EQ(storage("for (a = 0; a < 3; a += 1) { if (s > a) break; }"), Storage::Varying);
    EXPECT_EQ(storage("if (s > 1) { uniform float b = 1; b = 2; Ci = b; }"), Storage::Uniform);
    EXPECT_EQ(storage("illuminance(P) { a = 1; }"), Storage::Varying);
    EXPECT_EQ(storage("if (s > 1) return; a = 1;"), Storage::Uniform);  // nobody sees it where it is gone
    EXPECT_EQ(storage("lightsource(\"x\", a);"), Storage::Uniform);
}

TEST(Analysis, WrittenParametersAreCopied) {
    Heard heard;
    const auto unit = compiled("float f(float x) { x += 1; return x; } surface t() { Ci = f(s); }", heard);
    ASSERT_TRUE(unit) << heard.all();
    EXPECT_EQ(heard.all(),
              "warning 1:20: parameter \"x\" is assigned to, and is not output: the caller sees no change\n");
    const Function& f = *unit->functions[0];
    const Variable* local = f.body->children[0]->variables[0].get();
    EXPECT_EQ(local->initial->variable, f.parameters[0].get());
    EXPECT_EQ(f.body->children[1]->expressions[0]->children[0]->variable, local);
    EXPECT_EQ(f.body->children[2]->expressions[0]->variable, local);
}

TEST(Analysis, WorkIsBounded) {
    // Each calls the next twice: 2^40 operations in place.
    std::string text;
    for (int i = 0; i < 40; ++i)
        text += "float f" + std::to_string(i) + "(float x) { return f" + std::to_string(i + 1) + "(x) + f" +
                std::to_string(i + 1) + "(x); }\n";
    text += "float f40(float x) { return x; }\n";
    EXPECT_NE(said(text + "surface t() { Ci = f0(1); }").find("too large once its functions"),
              std::string::npos);
    // A chain of calls.
    text.clear();
    for (int i = 0; i < 20000; ++i)
        text += "float f" + std::to_string(i) + "(float x) { return f" + std::to_string(i + 1) + "(x); }\n";
    text += "float f20000(float x) { return x; }\n";
    EXPECT_NE(said(text + "surface t() { Ci = f0(1); }").find("nest too deeply"), std::string::npos);
    // Many shaders with copies of a large function.
    text = "float f(float x) { return x";
    for (int i = 0; i < 300; ++i) text += " + x";
    text += "; }\n";
    for (int i = 0; i < 20000; ++i) text += "surface s" + std::to_string(i) + "() { Ci = f(1); }\n";
    EXPECT_NE(said(text).find("this file is too large"), std::string::npos);
    // Uniform variables that learn of each other slowly.
    text = "surface t() { uniform float a0 = 0";
    for (int i = 1; i < 3000; ++i) text += ", a" + std::to_string(i) + " = 0";
    for (int i = 0; i < 2999; ++i) text += "; a" + std::to_string(i) + " = a" + std::to_string(i + 1);
    Heard heard;
    const auto unit = compiled(text + "; a2999 = s; }", heard);
    ASSERT_TRUE(unit);
    EXPECT_EQ(unit->shaders[0]->body->children[0]->variables[0]->storage, Storage::Varying);
}

}  // namespace
}  // namespace trapeze::rsl
