// Built-in functions as shaders call them: by lane and for constants (which the optimiser folds), against
// closed forms. The kernels' own tests look at their accuracy; these look at overloads, arguments and
// conversions. s runs over 0, 1/3, 2/3, 1 and t over 0, 1/2, 1; P is (s, 1 - t, 4), N is (0, 0, -1), camera
// space.
#include <cmath>

#include "shade/vm/run_shader_harness.h"

namespace trapeze::vm {
namespace {

using testing::expect_values;
using testing::ShaderRun;

constexpr float kTurn = 6.28318531f;
constexpr float kTight = 2e-6f;

TEST(Builtins, Mathematics) {
    expect_values(
        "r = sin(s) + cos(t);", [](float s, float t) { return std::sin(s) + std::cos(t); }, kTight);
    expect_values(
        "r = tan(s) + atan(t) + atan(s, t + 1) + asin(s) + acos(t);",
        [](float s, float t) {
            return std::tan(s) + std::atan(t) + std::atan2(s, t + 1) + std::asin(s) + std::acos(t);
        },
        kTight);
    expect_values(
        "r = pow(s + 1, t) + exp(s) + log(t + 1) + log(s + 2, 3);",
        [](float s, float t) {
            return std::pow(s + 1, t) + std::exp(s) + std::log(t + 1) + std::log(s + 2) / std::log(3.0f);
        },
        2 * kTight);
    expect_values(
        "r = sqrt(s) + inversesqrt(t + 1) + abs(s - t) + sign(s - 0.5);",
        [](float s, float t) {
            return std::sqrt(s) + 1 / std::sqrt(t + 1) + std::abs(s - t) + (s > 0.5f ? 1 : -1);
        },
        kTight);
    expect_values("r = floor(s * 2.5) + 10 * ceil(t * 2.5) + 100 * round(s * 2.2);", [](float s, float t) {
        return std::floor(s * 2.5f) + 10 * std::ceil(t * 2.5f) + 100 * std::round(s * 2.2f);
    });
    expect_values(
        "r = mod(s - 2, 0.75) + min(s, t) + 10 * max(s, t, 0.4) + 100 * min(3, s, t, 2);",
        [](float s, float t) {
            const float x = s - 2;
            return x - 0.75f * std::floor(x / 0.75f) + std::min(s, t) + 10 * std::max({s, t, 0.4f}) +
                   100 * std::min(s, t);
        },
        2e-5f);
    expect_values(
        "r = clamp(s * 3, 0.5, 2) + step(0.5, t) + 10 * smoothstep(0.2, 0.8, s) + mix(2, 4, t);",
        [](float s, float t) {
            const float x = std::clamp((s - 0.2f) / 0.6f, 0.0f, 1.0f);
            return std::clamp(s * 3, 0.5f, 2.0f) + (t < 0.5f ? 0 : 1) + 10 * x * x * (3 - 2 * x) + 2 + 2 * t;
        },
        1e-5f);
    expect_values(
        "r = radians(180 * s) + degrees(t);",
        [](float s, float t) { return s * kTurn / 2 + t * 360 / kTurn; }, 1e-5f);
    expect_values("r = PI;", [](float, float) { return kTurn / 2; });
}

TEST(Builtins, ComponentsOfTriples) {
    expect_values(
        "point p = point (s, t, 7); r = xcomp(p) + 10 * ycomp(p) + 100 * zcomp(p);",
        [](float s, float t) { return s + 10 * t + 700; }, 1e-4f);
    expect_values(
        "color c = color (s, t, 0.5); setcomp(c, 1, 9); r = comp(c, 0) + comp(c, 1) + comp(c, 2);",
        [](float s, float) { return s + 9 + 0.5f; }, kTight);
    expect_values(
        "vector v = 0; setxcomp(v, s); setycomp(v, 2); setzcomp(v, t); r = v . vector (1, 10, 100);",
        [](float s, float t) { return s + 20 + 100 * t; }, 1e-5f);
    expect_values("color c[2]; c[0] = 0; c[1] = 1; setcomp(c[1], 0, s); r = comp(c[1], 0) + comp(c[0], 0);",
                  [](float s, float) { return s; });
}

TEST(Builtins, Geometry) {
    expect_values(
        "r = length(vector (s, t, 2)) + distance(P, point (0, 0, 4));",
        [](float s, float t) { return std::sqrt(s * s + t * t + 4) + std::hypot(s, 1 - t); }, kTight);
    expect_values(
        "vector v = normalize(vector (s, 3, 4)); r = zcomp(v);",
        [](float s, float) { return 4 / std::sqrt(s * s + 25); }, kTight);
    expect_values(
        "r = zcomp(vector (1, 0, 0) ^ vector (s, t, 0)) + (vector (s, t, 1) . vector (2, 3, 4));",
        [](float s, float t) { return t + 2 * s + 3 * t + 4; }, kTight);
    // I points along +z, N against it: faceforward keeps N, and turns its opposite.
    expect_values("r = zcomp(faceforward(N, I)) + 10 * zcomp(faceforward(-N, I, -N));",
                  [](float, float) { return -1 - 10; });
    expect_values(
        "vector d = vector (s, 0, 1); r = zcomp(reflect(d, normal (0, 0, -1)));",
        [](float, float) { return -1; }, kTight);
    expect_values(
        "vector d = refract(vector (0, 0, 1), normal (0, 0, -1), 0.7); r = zcomp(d) + xcomp(d);",
        [](float, float) { return 1; }, kTight);
    expect_values(
        "float kr, kt; fresnel(vector (0, 0, 1), normal (0, 0, -1), 1 / 1.5, kr, kt); r = kr;",
        [](float, float) { return 0.04f; }, 1e-5f);
    expect_values(
        "point p = rotate(point (1, 0, s), PI / 2, point (0, 0, 0), point (0, 0, 1)); r = ycomp(p) + "
        "zcomp(p);",
        [](float s, float) { return 1 + s; }, kTight);
    expect_values(
        "r = ptlined(point (0, 0, 0), point (1, 0, 0), point (s, t, 0));", [](float, float t) { return t; },
        kTight);
}

TEST(Builtins, MatricesAndSpaces) {
    expect_values(
        "matrix m = translate(matrix 1, vector (1, 2, 3)); point p = transform(m, point (s, t, 0));"
        " r = xcomp(p) + 10 * ycomp(p) + 100 * zcomp(p);",
        [](float s, float t) { return s + 1 + 10 * (t + 2) + 300; }, 1e-4f);
    expect_values(
        "matrix m = scale(matrix 1, point (2, 3, 4)); r = determinant(m) + xcomp(vtransform(m, vector (s, 0, "
        "0)));",
        [](float s, float) { return 24 + 2 * s; }, 1e-5f);
    expect_values(
        "matrix m = rotate(matrix 1, PI / 2, vector (0, 0, 1)); matrix k = m * (1 / m); r = comp(k, 1, 1) + "
        "comp(k, 0, 2);",
        [](float, float) { return 1; }, kTight);
    expect_values("matrix m = 2; setcomp(m, 3, 0, s); r = comp(m, 3, 0) + comp(m, 1, 1);",
                  [](float s, float) { return s + 2; });
    for (const bool optimised : {false, true}) {
        ShaderRun run(
            "surface test(output varying float r = 0;) { r = zcomp(transform(\"far\", P))"
            " + 100 * xcomp(point \"far\" (s, 0, 0)) + 1000 * zcomp(vtransform(\"far\", \"current\", vector "
            "(0, 0, 1))); }",
            optimised);
        M44f far;
        far.setTranslation(V3f(5, 0, 10));
        run.scene().scene.camera_from_named["far"] = far;
        run.run();
        for (size_t i = 0; i < run.vertices(); ++i)
            EXPECT_NEAR(run.at("r", i), 4 - 10 + 100 * (run.grid().s[i] + 5) + 1000, 1e-3f);
    }
}

TEST(Builtins, AnUnknownSpaceIsReported) {
    ShaderRun run("surface test(output varying float r = 0;) { r = zcomp(transform(\"nowhere\", P)); }");
    run.run();
    EXPECT_NE(run.messages().find("\"nowhere\""), std::string::npos) << run.messages();
    EXPECT_EQ(run.at("r", 0), 4);
}

TEST(Builtins, Colors) {
    expect_values(
        "color c = color \"hsv\" (1 / 3, 1, s); r = comp(c, 1) + 10 * comp(c, 0);",
        [](float s, float) { return s; }, 5e-6f);
    expect_values(
        "color c = ctransform(\"hsv\", color (s, s, s)); r = comp(c, 2) + comp(c, 1);",
        [](float s, float) { return s; }, kTight);
    expect_values(
        "color c = mix(color (0, 0, 0), color (1, 2, 3), t); r = comp(c, 2);",
        [](float, float t) { return 3 * t; }, kTight);
    expect_values(
        "color c = clamp(color (s, 2, -1), color 0, color 1); r = comp(c, 0) + comp(c, 1) + comp(c, 2);",
        [](float s, float) { return s + 1; });
}

TEST(Builtins, Derivatives) {
    // u is s and v is t on this grid.
    expect_values(
        "r = Du(s * 2) + 10 * Dv(t * 3) + 100 * Du(t);", [](float, float) { return 2 + 30; }, 1e-4f);
    expect_values(
        "r = Deriv(s * 6, s * 2);", [](float, float) { return 3; }, 1e-5f);
    expect_values(
        "r = area(P);", [](float, float) { return 1.0f / 3 / 2; }, 1e-6f);
    expect_values(
        "r = zcomp(normalize(calculatenormal(P)));", [](float, float) { return -1; }, kTight);
    expect_values(
        "r = xcomp(Du(P)) + ycomp(Dv(P));", [](float, float) { return 1 - 1; }, 1e-5f);
    // A step over an interval of the sum of the changes of s to the next vertices (1/3), around s.
    expect_values(
        "r = filterstep(0.5, s);",
        [](float s, float) { return std::clamp((s + 1.0f / 6 - 0.5f) * 3, 0.0f, 1.0f); }, 1e-5f);
    // A width of its own at each vertex, by either name.
    for (const char* name : {"width", "swidth"})
        expect_values(
            "r = filterstep(0.5, s, \"" + std::string(name) + "\", 1 + 2 * s);",
            [](float s, float) {
                const float width = (1 + 2 * s) / 3;
                return std::clamp((s + width / 2 - 0.5f) / width, 0.0f, 1.0f);
            },
            1e-5f);
    expect_values(
        "r = filterstep(0.5, s - 0.25, s + 0.25);",
        [](float s, float) { return std::clamp((s + 0.25f - 0.5f) / 0.5f, 0.0f, 1.0f); }, 1e-5f);
}

TEST(Builtins, NoiseIsAboutOneHalfAndRepeats) {
    for (const char* call :
         {"noise(P * 7.3)", "noise(s * 9.7)", "noise(s * 5.1, t * 6.3)", "noise(P * 3.1, 0.4)",
          "comp(color noise(P * 5.3), 1)", "xcomp(point noise(s * 8.9))", "cellnoise(P * 9)",
          "pnoise(s * 4.3, 4)", "random()"}) {
        const std::string body = "r = " + std::string(call) + ";";
        ShaderRun first("surface test(output varying float r = 0;) {" + body + "}", true, 16, 16);
        ShaderRun again("surface test(output varying float r = 0;) {" + body + "}", false, 16, 16);
        first.run(), again.run();
        double sum = 0;
        float lowest = 1, highest = 0;
        for (size_t i = 0; i < first.vertices(); ++i) {
            EXPECT_EQ(first.at("r", i), again.at("r", i)) << call;
            sum += first.at("r", i);
            lowest = std::min(lowest, first.at("r", i)), highest = std::max(highest, first.at("r", i));
        }
        EXPECT_GE(lowest, 0) << call;
        EXPECT_LE(highest, 1) << call;
        EXPECT_GT(highest - lowest, 0.2f) << call;
        EXPECT_NEAR(sum / static_cast<double>(first.vertices()), 0.5, 0.2) << call;
    }
}

TEST(Builtins, Splines) {
    // Through the knots from the second to the last but one; a straight line where they lie on one.
    expect_values(
        "r = spline(s, -1, 0, 1, 2, 3);", [](float s, float) { return 2 * s; }, 1e-5f);
    expect_values(
        "r = spline(\"linear\", s, 9, 0, 4, 9);", [](float s, float) { return 4 * s; }, 1e-5f);
    expect_values(
        "float k[4] = {0, 1, 2, 3}; r = spline(\"catmull-rom\", s, k);", [](float s, float) { return 1 + s; },
        1e-5f);
    expect_values(
        "color c = spline(s, color 0, color 0, color (1, 2, 3), color (2, 4, 6)); r = comp(c, 2) - 3 * "
        "comp(c, 0);",
        [](float, float) { return 0; }, 1e-5f);
    expect_values(
        "r = spline(\"bezier\", s, 0, 0, 1, 1);", [](float s, float) { return 3 * s * s - 2 * s * s * s; },
        1e-5f);
}

/// Where a curve has a value, and the value there, are each other's inverse; what rises and what falls.
TEST(Builtins, SplinesAreSolved) {
    const auto same = [](float s, float) { return s; };
    for (const std::string basis : {"catmull-rom", "catmullrom", "bspline", "b-spline", "linear"})
        for (const std::string knots : {"-1, 0, .2, .7, 1, 1.5", "2, 1, .9, .3, 0, -1"}) {
            const std::string place = "spline(\"" + basis + "\", s, " + knots + ")";
            expect_values("r = spline(\"solve" + basis + "\", " + place + ", " + knots + ");", same, 1e-5f);
            expect_values(
                "float k[6] = {" + knots + "}; r = spline(\"solve" + basis + "\", " + place + ", k);", same,
                1e-5f);
        }
    expect_values("r = spline(\"solvebezier\", spline(\"bezier\", s, 0, .3, .6, 1), 0, .3, .6, 1);", same,
                  1e-5f);
    expect_values("r = spline(\"solvehermite\", spline(\"hermite\", s, 0, 1, 1, 1), 0, 1, 1, 1);", same,
                  1e-5f);
    // Beyond its ends it is at them, exactly.
    expect_values(
        "r = spline(\"solvelinear\", -7, 0, 0, 1, 1) + spline(\"solvelinear\", 7, 0, 0, 1, 1);",
        [](float, float) { return 1; }, 0);
    expect_values(
        "r = spline(\"solvelinear\", 7, 1, 1, 0, 0) + spline(\"solvelinear\", -7, 1, 1, 0, 0);",
        [](float, float) { return 1; }, 0);
    // As shaders use it: keys of their own, and values at them.
    expect_values(
        "float k[6] = {0, 0, .1, .3, 1, 1}; float v[6] = {0, 0, 1.3, 4.2, 6.4, 6.4};"
        "r = spline(\"catmull-rom\", spline(\"solvecatmull-rom\", .3, k), v);",
        [](float, float) { return 4.2f; }, 1e-4f);
}

TEST(Builtins, TextsAreFormattedAndCompared) {
    ShaderRun run(
        "surface test(output uniform string name = \"\"; output varying float r = 0;) {"
        "uniform float k = 2; name = concat(\"a\", format(\"%d-%5.2f\", k, 1.5), \".tex\");"
        "r = match(\"a.*tex\", name) + 10 * match(\"^b\", name); }");
    run.run();
    EXPECT_EQ(run.text("name"), "a2- 1.50.tex");
    EXPECT_EQ(run.at("r", 0), 1);
}

TEST(Builtins, PrintfHasAnEnd) {
    ShaderRun run(
        "surface test() { float i, j; for (i = 0; i < 500; i += 1) for (j = 0; j < 500; j += 1) "
        "printf(\"x\"); }");
    run.run();
    EXPECT_EQ(run.scene().reported.size(), 100'000u + 1);
    EXPECT_NE(run.scene().reported.back().text.find("printf() has said enough"), std::string::npos);
}

TEST(Builtins, PrintfSpeaksOnceForWhatIsUniformAndElseForEachVertex) {
    ShaderRun once("surface test() { uniform float k = 3; printf(\"k is %g\\n\", k); }");
    once.run();
    ASSERT_EQ(once.scene().reported.size(), 1u);
    EXPECT_EQ(once.scene().reported[0].text, "k is 3");
    ShaderRun each("surface test() { if (s > 0.5) printf(\"%.2f %p\", s, P); }");
    each.run();
    ASSERT_EQ(each.scene().reported.size(), 6u);  // of 4 by 3 vertices, those right of the middle
    EXPECT_EQ(each.scene().reported[0].text, "0.67 0.666667 1.000000 4.000000");
}

/// Where nobody sends rays all is open, and what else a call tells is told too.
TEST(Builtins, OcclusionWithoutRaysSetsAllThatItTells) {
    const std::string asked =
        "color seen = 5; vector open = 5; float part = 5, way = 5; float hidden = occlusion(P, vector "
        "(0, 0, 2), 4, \"environmentcolor\", seen, \"environmentdir\", open, \"occlusion\", part, "
        "\"hitdist\", way); ";
    expect_values(
        asked + "r = hidden + comp(seen, 1) + part;", [](float, float) { return 0; }, 0);
    expect_values(
        asked + "r = zcomp(open) + length(open);", [](float, float) { return 2; }, 0);
    expect_values(
        asked + "r = way;", [](float, float) { return 1e30f; }, 0);
}

}  // namespace
}  // namespace trapeze::vm
