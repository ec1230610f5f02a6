// Each statement of the language, where all lanes go one way and where they part, with and without the
// optimiser. s runs over 0, 1/3, 2/3, 1 and t over 0, 1/2, 1; the expected values are the same loops in C++.
#include <cmath>
#include <memory>
#include <set>

#include "shade/vm/run_shader_harness.h"

namespace trapeze::vm {
namespace {

using testing::expect_values;
using testing::ShaderRun;

TEST(Statements, IfByLaneAndWhole) {
    expect_values("if (s > 0.5) r = 1; else r = 2;", [](float s, float) { return s > 0.5f ? 1 : 2; });
    expect_values("r = 5; if (s > 2) r = 1;", [](float, float) { return 5; });
    expect_values("uniform float k = 3; if (k > 2) r = 1; else r = 2;", [](float, float) { return 1; });
    expect_values("if (s > 0.5) { if (t > 0.25) r = 1; else r = 2; } else if (t > 0.75) r = 3;",
                  [](float s, float t) { return s > 0.5f    ? (t > 0.25f ? 1 : 2)
                                                : t > 0.75f ? 3
                                                            : 0; });
}

TEST(Statements, TruthsAreOneOrZeroInAllComponents) {
    expect_values("color c = s > 0.5; vector v = t < 0.25; r = comp(c, 2) + 10 * zcomp(v);",
                  [](float s, float t) { return (s > 0.5f ? 1 : 0) + (t < 0.25f ? 10 : 0); });
}

TEST(Statements, VariablesInsideBranchesAreTheirOwn) {
    expect_values(
        "float x = 1; if (s > 0.5) { float x = 10; x += t; r = x; } r += x;",
        [](float s, float t) { return (s > 0.5f ? 10 + t : 0) + 1; }, 1e-6f);
}

TEST(Statements, VariablesOfStatementsWithoutBracesLiveOn) {
    expect_values("if (s > 0.5) float y = 1 + t; r = y;",
                  [](float s, float t) { return s > 0.5f ? 1 + t : 0; });
    expect_values("if (s > 0.5) float y = 1; else float y = 2; y += t; r = y;",
                  [](float s, float t) { return (s > 0.5f ? 1 : 2) + t; });
    expect_values("float i, j; for (i = 0, j = 2; i < 3; i += 1) float y = i + j; r = y;",
                  [](float, float) { return 4; });
    // Each turn of a loop around begins with 0.
    expect_values("float i; for (i = 0; i < 3; i += 1) { if (i < 2) if (s > 0.5) float y = i + 1; r += y; }",
                  [](float s, float) { return s > 0.5f ? 3 : 0; });
    expect_values(
        "r = f(s) + f(t);", [](float s, float t) { return (s > 0.5f ? s : 0) + (t > 0.5f ? t : 0); }, 0,
        "float f(float x) { if (x > 0.5) float y = x; return y; }");
    // A name that means something there already is another variable.
    expect_values("float y = 3; if (s > 0.5) float y = 1; r = y;", [](float, float) { return 3; });
    expect_values("if (s > 0.5) float t = 7; r = t;", [](float, float t) { return t; });
}

TEST(Statements, LoopsCountByLane) {
    expect_values("float i; for (i = 0; i < 10; i += 1) r += i;", [](float, float) { return 45; });
    expect_values("float i; for (i = 0; i < 10 * s; i += 1) r += 1;", [](float s, float) {
        float count = 0;
        for (float i = 0; i < 10 * s; i += 1) ++count;
        return count;
    });
    expect_values("float x = s * 8; while (x > 1) { x -= 1.5; r += 1; }", [](float s, float) {
        float count = 0;
        for (float x = s * 8; x > 1; x -= 1.5f) ++count;
        return count;
    });
    expect_values("while (s > 5) r = 9;", [](float, float) { return 0; });
}

TEST(Statements, BreakAndContinueByLane) {
    expect_values("float i; for (i = 0; i < 10; i += 1) { if (i > s * 6) break; r += 1; }",
                  [](float s, float) {
                      float count = 0;
                      for (float i = 0; i < 10; i += 1) {
                          if (i > s * 6) break;
                          ++count;
                      }
                      return count;
                  });
    expect_values("float i; for (i = 0; i < 8; i += 1) { if (mod(i, 2) == 0 && s > 0.5) continue; r += i; }",
                  [](float s, float) {
                      float sum = 0;
                      for (int i = 0; i < 8; ++i)
                          if (i % 2 != 0 || !(s > 0.5f)) sum += static_cast<float>(i);
                      return sum;
                  });
    expect_values("float i; for (i = 0; i < 8; i += 1) { if (i == 3) continue; if (i == 6) break; r += i; }",
                  [](float, float) { return 0 + 1 + 2 + 4 + 5; });
}

TEST(Statements, BreakLeavesSeveralLoops) {
    const auto expected = [](float s, float t) {
        float count = 0;
        for (int i = 0; i < 4; ++i)
            for (int j = 0; j < 5; ++j) {
                if (static_cast<float>(j) > 3 * s) goto done;
                if (static_cast<float>(j) > 2 * t) break;
                ++count;
            }
    done:
        return count;
    };
    expect_values(
        "float i, j; for (i = 0; i < 4; i += 1) for (j = 0; j < 5; j += 1) {"
        "  if (j > 3 * s) break 2; if (j > 2 * t) break; r += 1; }",
        expected);
    // The inner loop goes one way for all, the outer one does not.
    expect_values(
        "float i, j; for (i = 0; i < 4; i += 1) { if (s > 0.5) { for (j = 0; j < 5; j += 1) {"
        "  if (j == 2) break 2; r += 1; } } r += 10; }",
        [](float s, float) { return s > 0.5f ? 2 : 40; });
}

TEST(Statements, ContinueGoesOnWithAnOuterLoop) {
    expect_values(
        "float i, j; for (i = 0; i < 4; i += 1) { for (j = 0; j < 5; j += 1) {"
        "  if (j > 4 * s) continue 2; r += 1; } r += 100; }",
        [](float s, float) {
            float sum = 0;
            for (int i = 0; i < 4; ++i) {
                bool went_on = false;
                for (int j = 0; j < 5 && !went_on; ++j) {
                    went_on = static_cast<float>(j) > 4 * s;
                    if (!went_on) sum += 1;
                }
                if (!went_on) sum += 100;
            }
            return sum;
        });
}

TEST(Statements, FunctionsReturnFromTheirMiddle) {
    expect_values(
        "r = f(s);",
        [](float s, float) {
            for (int i = 0; i < 5; ++i)
                if (static_cast<float>(i) > 4 * s) return static_cast<float>(i) * 10;
            return -1.0f;
        },
        0,
        "float f(float x) { float i; for (i = 0; i < 5; i += 1) { if (i > 4 * x) return i * 10; } return -1; "
        "}");
    expect_values(
        "r = g(s) + g(t);", [](float s, float t) { return (s > 0.5f ? 2 : 1) + (t > 0.5f ? 2 : 1); }, 0,
        "float g(float x) { if (x > 0.5) return 2; return 1; }");
}

TEST(Statements, OutputParametersAreSet) {
    expect_values(
        "float a = s, b = t; swap(a, b); r = a * 10 + b;", [](float s, float t) { return t * 10 + s; }, 1e-6f,
        "void swap(output float x; output float y;) { float z = x; x = y; y = z; }");
    expect_values(
        "float a[2] = {s, t}; bump(a[1]); r = a[0] + a[1];", [](float s, float t) { return s + t + 1; },
        1e-6f, "void bump(output float x) { x += 1; }");
    expect_values(
        "r = 7; if (s > 0.5) set(r);", [](float s, float) { return s > 0.5f ? 3 : 7; }, 0,
        "void set(output float x) { x = 3; }");
}

TEST(Statements, ExternNamesTheCallersVariables) {
    expect_values(
        "float k = 4; float f() { extern float k; k += 1; return k * s; } r = f() + k;",
        [](float s, float) { return 5 * s + 5; }, 1e-6f);
}

TEST(Statements, ArraysAreIndexedByLane) {
    expect_values("float a[4] = {10, 20, 30, 40}; r = a[s * 3.1];",
                  [](float s, float) { return 10 * (1 + std::floor(s * 3.1f)); });
    expect_values(
        "float a[4]; float i; for (i = 0; i < 4; i += 1) a[i] = i * i; a[s * 3.1] = 100;"
        " r = a[0] + a[1] + a[2] + a[3];",
        [](float s, float) {
            const float at = std::floor(s * 3.1f);
            return 14 - at * at + 100;
        });
}

TEST(Statements, ConditionalExpressionsAndBools) {
    expect_values("r = s > 0.5 ? t : 3;", [](float s, float t) { return s > 0.5f ? t : 3; });
    expect_values("r = (s > 0.5 && t > 0.25) || !(s < 1) ? 1 : 0;",
                  [](float s, float t) { return (s > 0.5f && t > 0.25f) || !(s < 1) ? 1 : 0; });
    expect_values("string name = \"a\"; if (name == \"a\") r = 1; if (name != \"a\") r = 2;",
                  [](float, float) { return 1; });
    expect_values("color c = color(s, t, 0); if (c == color(0, 0, 0)) r = 1;",
                  [](float s, float t) { return s == 0 && t == 0 ? 1 : 0; });
}

TEST(Statements, AssignmentsAreExpressions) {
    expect_values(
        "float a, b; a = b = s; a *= 4; a -= 1; a /= 2; r = a + (b += 1);",
        [](float s, float) { return (s * 4 - 1) / 2 + s + 1; }, 1e-6f);
}

TEST(Statements, LoopsMayTakeSeveralSteps) {
    expect_values("float i, j; for (i = 0, j = 10; i < 4; i += 1, j -= 2) r += i * j; r += j * 100, r += i;",
                  [](float, float) { return 0 * 10 + 1 * 8 + 2 * 6 + 3 * 4 + 200 + 4; });
}

TEST(Statements, ComponentsAreAssigned) {
    expect_values(
        "vector v = 0; v[0] = s; v[1] = 2; v[1] += t; v[2] -= 3; r = v[0] + 10 * v[1] + 100 * v[2];",
        [](float s, float t) { return s + 10 * (2 + t) - 300; }, 1e-4f);
    expect_values(
        "color c[2]; c[0] = 0; c[1] = 1; if (s > 0.5) c[1][2] = 7; r = c[0][2] + c[1][2] * 10 + c[1][1];",
        [](float s, float) { return (s > 0.5f ? 70 : 10) + 1; });
    expect_values(
        "matrix m = 1; m[3][1] = s; m[0][0] *= 5; r = m[3][1] + m[0][0] + m[2][1];",
        [](float s, float) { return s + 5; }, 1e-6f);
}

TEST(Statements, ArraysAreAssignedWhole) {
    expect_values(
        "float a[3] = {s, t, 5}, b[3]; b = a; a[0] = 100; r = b[0] + 10 * b[1] + 100 * b[2]; b = {1, 2, 3};"
        "float c[3] = b, d[4] = s; r += 1000 * (c[0] + c[1] + c[2]) + d[0] + d[3] + 10000 * arraylength(d);",
        [](float s, float t) { return s + 10 * t + 500 + 6000 + 2 * s + 40000; }, 2e-2f);
    expect_values(
        "float a[3] = {1, 2}; r = a[0] + a[1] + a[2] + sum(a); a = {7}; r += a[0];",
        [](float, float) { return 3 + 3 + 7; }, 0,
        "float sum(float x[]) { float i, all = 0; for (i = 0; i < arraylength(x); i += 1) all += x[i]; "
        "return all; "
        "}");
    expect_values(
        "float a[5] = {7, s, ...}; color c[3] = {0, ...}; r = a[0] + 10 * a[1] + 10 * a[4] + comp(c[2], 1); "
        "a = {1, 2, 3, ...}; r += 100 * (a[1] + a[4]); a = {s, s, s, s, s, ...}; r += a[4];",
        [](float s, float) { return 7 + 21 * s + 500; }, 1e-4f);
    ShaderRun texts(
        "surface test(output uniform string r = \"\";) { string a[2] = {\"x\", \"y\"}, b[2];"
        "b = a; a[1] = \"z\"; r = b[0] + b[1] + a[1]; r += \"!\";"
        "string c[3] = {\"+\", ...}; r += c[2]; }");
    texts.run();
    EXPECT_EQ(texts.text("r"), "xyz!+") << texts.messages();
}

TEST(Statements, ArgumentsThatAreLeftOutHaveTheirDefaults) {
    expect_values(
        "r = f(s) + 1000 * f(t, 7) + f(0, \"k\", \"yy\", \"b\", 4);",
        [](float s, float t) { return s + 3 + 10 + 1000 * (t + 7 + 10) + 4 + 20; }, 1e-2f,
        "float f(float a; float b = 3; string k = \"x\") { return a + b + (k == \"yy\" ? 20 : 10); }");
}

TEST(Statements, OutputsAreSetByName) {
    expect_values(
        "outputchannel(\"r\", s + 1); f();", [](float s, float) { return 2 * s + 2; }, 1e-6f,
        "void f() { extern float r; outputchannel(\"r\", r * 2); }");
}

TEST(Statements, VariablesWithoutValuesAreZeroInEachTurn) {
    expect_values(
        "float i; for (i = 0; i < 3; i += 1) { float x, a[2]; color c; r += x + a[1] + comp(c, 1);"
        " x = 5; a[1] = 6; c = 7; }",
        [](float, float) { return 0; });
    // What falls off a function's end is zero, whatever it gave before.
    expect_values(
        "r = f(1); r = f(s);", [](float s, float) { return s > 0.5f ? 4 : 0; }, 0,
        "float f(float x) { if (x > 0.5) return 4; }");
}

TEST(Statements, TriplesAreOrderedByAllComponents) {
    expect_values(
        "color c = color (s, t, 0); if (c < 0.4) r += 1; if (c >= color (0, 0.5, 0)) r += 10;"
        "if (P > point (-1, -1, 3)) r += 100;",
        [](float s, float t) { return (s < 0.4f && t < 0.4f ? 1 : 0) + (t >= 0.5f ? 10 : 0) + 100; });
}

TEST(Statements, BothHalvesOfAConditionalAreTheirOwn) {
    expect_values(
        "r = s > 0.5 ? f(s * t + 1) : f(s * t + 1) + 10;",
        [](float s, float t) { return s * t + 1 + (s > 0.5f ? 1 : 11); }, 1e-5f,
        "float f(float x) { return x + 1; }");
    expect_values("string name = shadername() == \"none\" ? \"a\" : \"b\"; if (name == \"b\") r = 1;",
                  [](float, float) { return 1; });
}

TEST(Statements, ReadOnlyVariablesAreChangedForTheShaderAlone) {
    ShaderRun run("surface test(output varying float r = 0;) { s = s * 2; Cs = 3; r = s + comp(Cs, 1); }");
    run.run();
    for (size_t i = 0; i < run.vertices(); ++i) EXPECT_EQ(run.at("r", i), run.grid().s[i] * 2 + 3);
}

TEST(Statements, NestedLoopsAreBoundedTogether) {
    ShaderRun run(
        "surface test(output varying float r = 0;) {\n float i, j, k; for (i = 0; i < 9999; i += 1)\n"
        "for (j = 0; j < 9999; j += 1)\n for (k = 0; k < 9999; k += 1) r += 1; }");
    run.run();
    EXPECT_NE(run.messages().find("the loops of shader \"test\" have taken too long"), std::string::npos)
        << run.messages();
}

TEST(Statements, AnEndlessLoopIsLeftAndNamed) {
    ShaderRun run("surface test(output varying float r = 0;) {\n  while (1 > 0)\n    r += 1;\n}");
    run.run();
    EXPECT_NE(run.messages().find("test.sl:2:"), std::string::npos) << run.messages();
    EXPECT_EQ(run.at("r", 0), kMaxTurns);
    ShaderRun by_lane(
        "surface test(output varying float r = 0;) {\n  while (s >= 0) { r += 1; if (s > 2) break; }\n}");
    by_lane.run();
    EXPECT_NE(by_lane.messages().find("test.sl:2:"), std::string::npos) << by_lane.messages();
}

TEST(Statements, WhatIsUniformIsFound) {
    ShaderRun run(
        "surface test(output varying float r = 0;) {"
        "float a = 2, i, sum = 0; for (i = 0; i < 3; i += 1) sum += a * i; r = sum * s; }");
    for (const rsl::Register& r : run.program().registers)
        EXPECT_FALSE(r.varying && (r.name == "sum" || r.name == "i" || r.name == "a")) << r.name;
    ShaderRun parted(
        "surface test(output varying float r = 0;) { float sum = 0; if (s > 0.5) sum = 1; r = sum; }");
    for (const rsl::Register& r : parted.program().registers) EXPECT_TRUE(r.varying || r.name != "sum");
}

// random()

size_t different(const std::vector<float>& values) {
    return std::set<float>(values.begin(), values.end()).size();
}

std::vector<float> values_of(const std::unique_ptr<ShaderRun>& run, const std::string& name) {
    std::vector<float> values;
    for (size_t i = 0; i < run->vertices(); ++i) values.push_back(run->at(name, i));
    return values;
}

/// Outputs a to d of what the body does, at 8 x 8 vertices.
std::unique_ptr<ShaderRun> run_of(const std::string& body) {
    auto run = std::make_unique<ShaderRun>(
        "surface test(output varying float a = 0, b = 0, c = 0, d = 0;) {" + body + "}", true, 8, 8);
    run->run();
    return run;
}

TEST(Random, EachTurnOfALoopGivesOtherNumbers) {
    for (
        const char* body :
        {"uniform float i; for (i = 0; i < 4; i += 1) { float x = random();"
         "  if (i == 0) a = x; if (i == 1) b = x; if (i == 2) c = x; if (i == 3) d = x; }",
         "float i = 0; while (i < 4) { float x = random();"
         "  if (i == 0) a = x; if (i == 1) b = x; if (i == 2) c = x; if (i == 3) d = x; i += 1; }",
         "float draw() { return random(); } uniform float i, k;"
         "for (i = 0; i < 2; i += 1) for (k = 0; k < 2; k += 1) { float x = draw(); uniform float n = 2 * i + k;"
         "  if (n == 0) a = x; if (n == 1) b = x; if (n == 2) c = x; if (n == 3) d = x; }"}) {
        const auto run = run_of(body);
        std::vector<float> all;
        for (const char* name : {"a", "b", "c", "d"})
            for (const float value : values_of(run, name)) all.push_back(value);
        EXPECT_GE(different(all), all.size() - 1) << body;  // one in a hundred runs would have two alike
    }
}

TEST(Random, TheFirstTurnIsAsWithoutALoop) {
    const auto run = run_of("a = random();");
    const auto in_loop =
        run_of("uniform float i; for (i = 0; i < 3; i += 1) { float x = random(); if (i == 0) a = x; }");
    EXPECT_EQ(values_of(run, "a"), values_of(in_loop, "a"));
}

/// Who does not draw in a turn changes nothing for others, nor for later turns.
TEST(Random, NumbersFollowFromTheTurnNotFromWhoDraws) {
    const auto some = run_of(
        "uniform float i; for (i = 0; i < 3; i += 1) { if (s > .5 ? i > 0 : i == 2) { float x = random();"
        "  if (i == 1) a = x; if (i == 2) b = x; } }");
    const auto all = run_of(
        "uniform float i; for (i = 0; i < 3; i += 1) { float x = random();"
        "  if (i == 1 && s > .5) a = x; if (i == 2) b = x; }");
    EXPECT_EQ(values_of(some, "a"), values_of(all, "a"));
    EXPECT_EQ(values_of(some, "b"), values_of(all, "b"));
}

TEST(Random, TurnsOfNestedLoopsAndOfLoopsThatGoOnAreTold) {
    const auto run = run_of(
        "uniform float i, k; for (i = 0; i < 2; i += 1) { for (k = 0; k < 2; k += 1) { float x = random();"
        "  if (k == 0) { if (i == 0) a = x; else c = x; continue; } if (i == 0) b = x; else d = x; } }");
    std::vector<float> all;
    for (const char* name : {"a", "b", "c", "d"})
        for (const float value : values_of(run, name)) all.push_back(value);
    EXPECT_GE(different(all), all.size() - 1);
    // A loop that draws how often it goes on ends.
    const auto drawn = run_of("while (random() < .9 && a < 1000) a += 1;");
    EXPECT_GT(different(values_of(drawn, "a")), 5u);
}

TEST(Random, AUniformVariableGetsOneNumberForTheGrid) {
    const auto run = run_of(
        "uniform float r = random(), q; q = 1 - random(); uniform color k = color random();"
        "a = r; b = q; c = comp(k, 0); d = comp(k, 1);");
    const auto at_once = run_of("a = random();");
    const auto in_loop = run_of(
        "uniform float i; for (i = 0; i < 2; i += 1) { if (s > .5) c = random(); uniform float r = random();"
        "  if (i == 0) a = r; else b = r; if (s > .5) { uniform float part = random(); d = part; } }");
    for (const char* name : {"a", "b"}) EXPECT_EQ(different(values_of(in_loop, name)), 1u) << name;
    EXPECT_NE(in_loop->at("a", 0), in_loop->at("b", 0));
    EXPECT_EQ(different(values_of(in_loop, "d")), 2u);  // and 0 where nobody drew
    std::set<float> drawn;
    for (const char* name : {"a", "b", "c", "d"}) {
        EXPECT_EQ(different(values_of(run, name)), 1u) << name;
        drawn.insert(run->at(name, 0));
    }
    EXPECT_EQ(drawn.size(), 4u);
    EXPECT_GT(different(values_of(at_once, "a")), 60u);
}

}  // namespace
}  // namespace trapeze::vm
