// Noises, splines, what looks at neighbours, and what asks others.
#include <algorithm>
#include <cmath>

#include "shade/vm/builtin_cases_harness.h"
#include "shade/vm/kernels/exact_noise_harness.h"

namespace trapeze::testing {
namespace {

#define TRAPEZE_GIVES(...) [](double x, double y) -> double { return (void)x, (void)y, __VA_ARGS__; }

using Coordinates = std::vector<double>;

/// Coordinates of one to four dimensions as a shader writes them, and what they are.
struct NoiseArguments {
    std::string text, periods, cell, text_in_cell, next_cell;
    std::function<Coordinates(double x, double y)> values;
    Coordinates period_values;
};

const std::vector<NoiseArguments>& noise_arguments() {
    static const std::vector<NoiseArguments> kAll{{"X * 7.25",
                                                   "4",
                                                   "3",
                                                   "3 + X * 0.9",
                                                   "4 + X * 0.9",
                                                   [](double x, double) { return Coordinates{x * 7.25}; },
                                                   {4}},
                                                  {"X * 7.25, Y * 5.5",
                                                   "4, 3",
                                                   "3, -2",
                                                   "3 + X * 0.9, -2 + Y * 0.9",
                                                   "3 + X * 0.9, -1 + Y * 0.9",
                                                   [](double x, double y) {
                                                       return Coordinates{x * 7.25, y * 5.5};
                                                   },
                                                   {4, 3}},
                                                  {"point (X * 3, Y * 4, 1.75)",
                                                   "point (2, 3, 4)",
                                                   "point (1, 2, 3)",
                                                   "point (1, 2 + X * 0.9, 3)",
                                                   "point (1, 2, 4 + X * 0.9)",
                                                   [](double x, double y) {
                                                       return Coordinates{x * 3, y * 4, 1.75};
                                                   },
                                                   {2, 3, 4}},
                                                  {"point (X * 3, Y * 4, 1.75), Y * 2",
                                                   "point (2, 3, 4), 2",
                                                   "point (1, 2, 3), 4",
                                                   "point (1, 2, 3), 4 + X * 0.9",
                                                   "point (1, 2, 3), 5 + X * 0.9",
                                                   [](double x, double y) {
                                                       return Coordinates{x * 3, y * 4, 1.75, y * 2};
                                                   },
                                                   {2, 3, 4, 2}}};
    return kAll;
}

/// r of a call in a type: a triple's components with weights.
std::string result_of(const std::string& type, const std::string& call) {
    return type == "float" ? "r = float " + call + ";" : "r = K(" + type + " " + call + ");";
}

void add_noises(std::vector<BuiltinCase>& cases) {
    for (const std::string type : {"float", "color", "point", "vector"})
        for (const NoiseArguments& arguments : noise_arguments()) {
            const bool triple = type != "float";
            const auto exact = [=](bool periodic) {
                return [=](double x, double y) {
                    const Coordinates at = arguments.values(x, y);
                    const Coordinates period = periodic ? arguments.period_values : Coordinates{};
                    return exact_noise(at, period, 0) +
                           (triple ? 10 * exact_noise(at, period, 1) + 100 * exact_noise(at, period, 2) : 0);
                };
            };
            const double tolerance = triple ? 1e-3 : 1e-5;
            cases.push_back({result_of(type, "noise(" + arguments.text + ")"), exact(false), tolerance});
            cases.push_back({result_of(type, "pnoise(" + arguments.text + ", " + arguments.periods + ")"),
                             exact(true), tolerance});
            // The same number anywhere in a cell, another in the next.
            const std::string a = " cellnoise(" + arguments.cell + ")",
                              b = " cellnoise(" + arguments.text_in_cell + ")",
                              c = " cellnoise(" + arguments.next_cell + ")";
            cases.push_back({type + " a = " + type + a + ", b = " + type + b + ", c = " + type + c +
                                 "; r = (a == b && a != c && a >= 0 && a < 1) ? X : -1;",
                             TRAPEZE_GIVES(x)});
        }
    for (const std::string type : {"float", "color", "point", "vector"})
        cases.push_back({type + " a = random(), b = random(); r = (a >= 0 && a < 1 && a != b) ? X : -1;",
                         TRAPEZE_GIVES(x)});
}

void add_splines(std::vector<BuiltinCase>& cases) {
    for (const std::string type : {"float", "color", "point", "vector"}) {
        const bool triple = type != "float";
        const double weight = triple ? 1 + 20 + 300 : 1;
        const auto knot = [&](int i) {
            const std::string n = std::to_string(i);
            return triple ? type + " (" + n + ", 2 * " + n + ", 3 * " + n + ")" : n;
        };
        const std::string knots = knot(-1) + ", " + knot(0) + ", " + knot(1) + ", " + knot(2),
                          array = type + " k[4] = {" + knots + "}; ";
        const auto line = [=](double x, double) { return x * weight; };
        const double tolerance = triple ? 1e-3 : 1e-5;
        cases.push_back({result_of(type, "spline(X, " + knots + ")"), line, tolerance});
        cases.push_back({result_of(type, "spline(\"linear\", X, " + knots + ")"), line, tolerance});
        cases.push_back({array + result_of(type, "spline(X, k)"), line, tolerance});
        cases.push_back({array + result_of(type, "spline(\"linear\", X, k)"), line, tolerance});
    }
}

void add_derivatives(std::vector<BuiltinCase>& cases) {
    // X is u and Y is v over a unit square of 3 by 2 steps.
    const auto zero = TRAPEZE_GIVES(0);
    cases.push_back({"r = Du(X * 2 + Y);", TRAPEZE_GIVES(2), 1e-5, zero});
    cases.push_back({"r = Dv(X + Y * 3);", TRAPEZE_GIVES(3), 1e-5, zero});
    cases.push_back({"r = Deriv(X * 6, X * 2);", TRAPEZE_GIVES(3), 1e-5, zero});
    for (const std::string type : {"color", "point", "vector", "normal"}) {
        const std::string triple = type + " (X * 2, Y * 3, 4)";
        cases.push_back({"r = K(Du(" + triple + "));", TRAPEZE_GIVES(2), 1e-5, zero});
        cases.push_back({"r = K(Dv(" + triple + "));", TRAPEZE_GIVES(30), 1e-4, zero});
        cases.push_back({"r = K(Deriv(" + type + " (X * 6, 0, 0), X * 2));", TRAPEZE_GIVES(3), 1e-5, zero});
    }
    const auto alone = TRAPEZE_GIVES(2 * x - y);
    cases.push_back({"r = gridmin(X * 2 - Y);", TRAPEZE_GIVES(-1), 1e-5, alone});
    cases.push_back({"r = gridmax(X * 2 - Y);", TRAPEZE_GIVES(2), 1e-5, alone});
    cases.push_back({"r = gridavg(X * 2 - Y);", TRAPEZE_GIVES(.5), 1e-5, alone});
    cases.push_back({"r = area(point (X, Y, 4));", TRAPEZE_GIVES(1.0 / 6), 1e-6, zero});
    cases.push_back({"r = area(point (X, Y, 4), \"dicing\");", TRAPEZE_GIVES(1.0 / 6), 1e-6, zero});
    cases.push_back(
        {"r = zcomp(normalize(calculatenormal(point (X, 1 - Y, 4))));", TRAPEZE_GIVES(-1), 1e-5, zero});
    cases.push_back({"r = filterstep(0.45, X);",
                     TRAPEZE_GIVES(std::clamp((x + 1.0 / 6 - 0.45) * 3, 0.0, 1.0)), 1e-5,
                     TRAPEZE_GIVES(x < 0.45 ? 0 : 1)});
    cases.push_back({"r = filterstep(0.5, X - 0.25, X + 0.25);",
                     TRAPEZE_GIVES(std::clamp((x + 0.25 - 0.5) / 0.5, 0.0, 1.0)), 1e-5});
}

void add_lights_and_rays(std::vector<BuiltinCase>& cases) {
    // The lights: an ambient one of (0.1, 0.2, 0.3), and one of (1, 2, 4) from where N points.
    const std::string V = "normalize(vector (1, 0, -1))";
    cases.insert(
        cases.end(),
        {
            {"r = K(ambient()) + X;", TRAPEZE_GIVES(0.1 + 2 + 30 + x), 1e-5},
            {"r = K(diffuse(normal (0, 0, -X)));", TRAPEZE_GIVES(x * 421), 1e-3},
            {"r = comp(specular(normal (0, 0, -1), " + V + ", 0.25), 1) + X;",
             TRAPEZE_GIVES(2 * std::pow(std::cos(std::atan(1.0) / 2), 32) + x), 1e-5},
            {"r = comp(specularstd(normal (0, 0, -3), 2 * " + V + ", 0.25), 1) + X;",
             TRAPEZE_GIVES(2 * std::pow(std::cos(std::atan(1.0) / 2), 4) + x), 1e-5},
            {"r = comp(phong(normal (0, 0, -1), " + V + ", 4), 1) + X;", TRAPEZE_GIVES(2 * 0.25 + x), 1e-5},
            {"r = comp(specularbrdf(vector (0, 0, -1), normal (0, 0, -1), " + V + ", 0.25), 1) + X;",
             TRAPEZE_GIVES(std::pow(std::cos(std::atan(1.0) / 2), 32) + x), 1e-5},
            // Rays miss everything.
            {"color c = trace(P, vector (X, 0, 1)); r = K(c) + X;", TRAPEZE_GIVES(x)},
            {"float d = trace(P, vector (X, 0, 1)); r = d > 1e29 ? X : -1;", TRAPEZE_GIVES(x)},
            {"float d = 0; color t = 0, c = trace(P, N, d, \"transmission\", t); r = d > 1e29 ? K(t) + X : -1;",
             TRAPEZE_GIVES(111 + x), 1e-4},
            {"r = K(transmission(P, point (X, Y, 9))) + X;", TRAPEZE_GIVES(111 + x), 1e-4},
            {"color c = visibility(P, point (X, Y, 9)); r = K(c) + X;", TRAPEZE_GIVES(111 + x), 1e-4},
            {"float c = visibility(P, point (X, Y, 9)); r = c + X;", TRAPEZE_GIVES(1 + x)},
            {"r = occlusion(P, N, 16, \"maxdist\", 3) + X;", TRAPEZE_GIVES(x)},
            {"r = occlusion(\"map\", P, N, 0, \"samples\", 3) + X;", TRAPEZE_GIVES(x)},
            {"r = K(indirectdiffuse(P, N, 16)) + X;", TRAPEZE_GIVES(x)},
            {"r = K(indirectdiffuse(\"map\", vector (X, 0, 1))) + X;", TRAPEZE_GIVES(x)},
            {"float d = 3; r = rayinfo(\"depth\", d) * 10 + d + X;", TRAPEZE_GIVES(10 + x)},
            {"float d = 3; r = rayinfo(\"speed\", d) * 10 + d + X;", TRAPEZE_GIVES(3 + x)},
            {"r = raylevel() + X;", TRAPEZE_GIVES(x)},
            {"r = raydepth() + X;", TRAPEZE_GIVES(x)},
            {"r = raylabel() == \"\" ? X : -1;", TRAPEZE_GIVES(x)},
            {"string a = \"\"; r = rayinfo(\"type\", a) + (a == \"camera\" ? X : -1);", TRAPEZE_GIVES(1 + x)},
        });
}

void add_maps(std::vector<BuiltinCase>& cases) {
    cases.insert(
        cases.end(),
        {
            // Maps give 100 times the channel, 10 times the number of coordinates, the first coordinate, and
            // 0, 1
            // and 2 for red, green and blue.
            {"float a = texture(\"m\"); r = a - s + X;", TRAPEZE_GIVES(20 + x), 1e-5},
            {"color a = texture(\"m\"[3]); r = K(a) - 111 * s + X;", TRAPEZE_GIVES(111 * 320 + 210 + x),
             5e-2},
            {"float a = texture(\"m\"[2], X, Y, \"blur\", 0.5); r = a;", TRAPEZE_GIVES(220 + x), 1e-4},
            {"color a = texture(\"m\", X, Y); r = K(a);", TRAPEZE_GIVES(111 * (20 + x) + 210), 1e-2},
            {"float a = texture(\"m\", X, Y, 1, 0, 1, 1, 0, 1); r = a;", TRAPEZE_GIVES(80 + x), 1e-4},
            {"color a = texture(\"m\", X, Y, 1, 0, 1, 1, 0, 1); r = K(a);",
             TRAPEZE_GIVES(111 * (80 + x) + 210), 1e-2},
            {"r = K(bump(\"m\", normal (X, 0, 1), dPdu, dPdv));", TRAPEZE_GIVES(111 * (50 + x) + 210), 1e-2},
            {"r = K(bump(\"m\", normal (X, 0, 1), dPdu, dPdv, X, Y));", TRAPEZE_GIVES(111 * (50 + x) + 210),
             1e-2},
            {"r = K(bump(\"m\", normal (X, 0, 1), dPdu, dPdv, X, Y, 1, 0, 1, 1, 0, 1));",
             TRAPEZE_GIVES(111 * (110 + x) + 210), 1e-2},
            {"float v = 3; r = textureinfo(\"m\", \"known\", v) * 10 + v + X;", TRAPEZE_GIVES(10.25 + x),
             1e-5},
        });
    for (const std::string function : {"environment", "shadow"}) {
        const std::string type = function == "shadow" ? "point" : "vector";
        const std::string one = type + " (X, 1, 2)", four = one + ", " + one + ", " + one + ", " + one;
        cases.push_back(
            {"float a = " + function + "(\"m\", " + one + "); r = a;", TRAPEZE_GIVES(10 + x), 1e-4});
        cases.push_back({"color a = " + function + "(\"m\", " + one + "); r = K(a);",
                         TRAPEZE_GIVES(111 * (10 + x) + 210), 1e-2});
        cases.push_back(
            {"float a = " + function + "(\"m\", " + four + "); r = a;", TRAPEZE_GIVES(40 + x), 1e-4});
        cases.push_back({"color a = " + function + "(\"m\", " + four + "); r = K(a);",
                         TRAPEZE_GIVES(111 * (40 + x) + 210), 1e-2});
    }
}

}  // namespace

std::vector<BuiltinCase> pattern_cases() {
    std::vector<BuiltinCase> cases;
    add_noises(cases);
    add_splines(cases);
    add_derivatives(cases);
    return cases;
}

std::vector<BuiltinCase> asking_cases() {
    std::vector<BuiltinCase> cases;
    add_lights_and_rays(cases);
    add_maps(cases);
    cases.insert(
        cases.end(),
        {
            {"string a = shadername(); r = a == \"test\" ? X : -1;", TRAPEZE_GIVES(x)},
            {"string a = shadername(\"light\"); r = a == \"shader light\" ? X : -1;", TRAPEZE_GIVES(x)},
            {"r = bake(\"f\", X, Y, 1) + bake3d(\"f\", \"\", P, N) + texture3d(\"f\", P, N) + X;",
             TRAPEZE_GIVES(x)},
            {"r = K(photonmap(\"f\", P, N) + caustic(P, N) + irradiance(P, N) + subsurface(P, N)) + X;",
             TRAPEZE_GIVES(x)},
            {"float a = areashadow(P, 4); color b = areashadow(P, 4), c = fulltrace(P, N); r = a + K(b + c) + X;",
             TRAPEZE_GIVES(x)},
            {"float a = fulltrace(P, N); r = a + X;", TRAPEZE_GIVES(x)},
            {"float n = islightcategory(\"a\"); illuminance(P) n += 2 * islightcategory(\"a\"); r = n + X;",
             TRAPEZE_GIVES(2 + x)},
            {"r = raydepth() + isindirectray() + isshadowray() + (rayhittest(P, N) > 1e29 ? X : -1);",
             TRAPEZE_GIVES(x)},
            {"string a = raylabel(); r = a == \"\" ? X : -1;", TRAPEZE_GIVES(x)},
        });
    // Of later renderers, and not there.
    for (const std::string function : {"wnoise", "randomgrid", "randomstrat"})
        cases.push_back({"float a = " + function + "(P, 1); color b = " + function +
                             "(P, 1); point c = " + function + "(P, 1); vector d = " + function +
                             "(P, 1); r = a + K(b) + K(c + d) + X;",
                         TRAPEZE_GIVES(x)});
    for (const std::string function : {"ptexture", "textureatlas"})
        cases.push_back(
            {"float a = " + function + "(\"m\", 0); color b = " + function + "(\"m\", 0); r = a + K(b) + X;",
             TRAPEZE_GIVES(x)});
    // "known" is 0.25; what is not found keeps its value.
    for (const std::string function :
         {"atmosphere", "displacement", "lightsource", "surface", "incident", "opposite", "attribute",
          "option", "rendererinfo", "getvar", "readprimvar"})
        cases.push_back({"float a = 3, b = 4; r = " + function + "(\"known\", a) * 1000 + " + function +
                             "(\"other\", b) * 100 + a + 10 * b + X;",
                         TRAPEZE_GIVES(1000 + 0.25 + 40 + x), 1e-3});
    return cases;
}

}  // namespace trapeze::testing
