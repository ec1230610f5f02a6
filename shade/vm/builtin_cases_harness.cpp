// Numbers, points, vectors, colours, matrices and texts.
#include "shade/vm/builtin_cases_harness.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace trapeze::testing {

#define TRAPEZE_GIVES(...) [](double x, double y) -> double { return (void)x, (void)y, __VA_ARGS__; }

/// Arrays that are resized, of each type.
void add_array_cases(std::vector<BuiltinCase>& cases) {
    // Of two elements, three and one; the third is 0.
    const std::pair<std::string, std::string> arrays[] = {
        {"float", "a"},         {"color", "comp(a, 0)"},     {"point", "xcomp(a)"},   {"vector", "xcomp(a)"},
        {"normal", "xcomp(a)"}, {"matrix", "comp(a, 0, 0)"}, {"string", "a == \"y\""}};
    for (const auto& [type, number] : arrays) {
        const bool is_text = type == "string";
        const std::string first = is_text ? "\"x\"" : type + " Y", second = is_text ? "\"y\"" : type + " X";
        cases.push_back({type + " many[]; push(many, " + first + "); push(many, " + second +
                             "); reserve(many, 5); resize(many, 3); " + type +
                             " a = pop(many); r = 1000 * (" + number + "); a = pop(many); r += 100 * (" +
                             number + ") + 10 * capacity(many) + arraylength(many);",
                         [is_text](double x, double) { return (is_text ? 1 : x) * 100 + 51; }, 1e-5});
    }
}

std::vector<BuiltinCase> number_cases() {
    std::vector<BuiltinCase> cases{
        {"r = radians(X * 90);", TRAPEZE_GIVES(x * std::numbers::pi / 2)},
        {"r = degrees(X);", TRAPEZE_GIVES(x * 180 / std::numbers::pi), 1e-5},
        {"r = sin(X * 5);", TRAPEZE_GIVES(std::sin(x * 5))},
        {"r = cos(X * 5);", TRAPEZE_GIVES(std::cos(x * 5))},
        {"r = tan(X);", TRAPEZE_GIVES(std::tan(x))},
        {"r = asin(X);", TRAPEZE_GIVES(std::asin(x))},
        {"r = acos(X);", TRAPEZE_GIVES(std::acos(x))},
        {"r = atan(X * 3);", TRAPEZE_GIVES(std::atan(x * 3))},
        {"r = atan(X - 2, Y - 0.5);", TRAPEZE_GIVES(std::atan2(x - 2, y - 0.5))},
        {"r = pow(X + 0.5, Y * 3);", TRAPEZE_GIVES(std::pow(x + 0.5, y * 3)), 1e-5},
        {"r = exp(X);", TRAPEZE_GIVES(std::exp(x))},
        {"r = erf(X);", TRAPEZE_GIVES(std::erf(x))},
        {"r = erfc(X);", TRAPEZE_GIVES(std::erfc(x))},
        {"r = log(X + 0.1);", TRAPEZE_GIVES(std::log(x + 0.1)), 5e-6},
        {"r = log(X + 1, Y + 2);", TRAPEZE_GIVES(std::log(x + 1) / std::log(y + 2))},
        {"r = sqrt(X);", TRAPEZE_GIVES(std::sqrt(x))},
        {"r = inversesqrt(X + 0.5);", TRAPEZE_GIVES(1 / std::sqrt(x + 0.5))},
        {"r = abs(X - 0.6);", TRAPEZE_GIVES(std::abs(x - 0.6))},
        {"r = sign(X - 0.5);", TRAPEZE_GIVES(x > 0.5 ? 1 : -1)},
        {"r = floor(X * 3.7 - 1);", TRAPEZE_GIVES(std::floor(x * 3.7 - 1))},
        {"r = ceil(X * 3.7 - 1);", TRAPEZE_GIVES(std::ceil(x * 3.7 - 1))},
        {"r = round(X * 3.7 - 1);", TRAPEZE_GIVES(std::round(x * 3.7 - 1))},
        {"r = mod(X * 5 - 2, Y + 0.7);",
         TRAPEZE_GIVES(x * 5 - 2 - (y + 0.7) * std::floor((x * 5 - 2) / (y + 0.7))), 5e-6},
        {"r = min(X, Y) + 10 * min(X, Y, 0.4, 0.2);",
         TRAPEZE_GIVES(std::min(x, y) + 10 * std::min({x, y, 0.4, 0.2}))},
        {"r = max(X, Y) + 10 * max(X, Y, 0.4, 0.6);",
         TRAPEZE_GIVES(std::max(x, y) + 10 * std::max({x, y, 0.4, 0.6}))},
        {"r = clamp(X * 3, 0.5, Y + 1);", TRAPEZE_GIVES(std::clamp(x * 3, 0.5, y + 1))},
        {"r = clamp(X * 3, 1.5, 1);", TRAPEZE_GIVES(x * 3 < 1.5 ? 1.5 : 1)},
        {"r = K(pow(color (X, Y, 0.5), color (2, 1, 3)));", TRAPEZE_GIVES(x * x + 10 * y + 12.5), 1e-5},
        {"r = mix(2, X, Y);", TRAPEZE_GIVES(2 + (x - 2) * y)},
        {"r = step(0.5, X) + 2 * step(X, Y + 0.1);",
         TRAPEZE_GIVES((x < 0.5 ? 0 : 1) + 2 * (y + 0.1 < x ? 0 : 1))},
        {"r = smoothstep(0.2, 0.8, X);",
         TRAPEZE_GIVES([](double t) { return t * t * (3 - 2 * t); }(std::clamp((x - 0.2) / 0.6, 0.0, 1.0)))},
        {"float a[3]; r = arraylength(a) + X;", TRAPEZE_GIVES(3 + x)},
        {"r = isoutput(r) + X;", TRAPEZE_GIVES(1 + x)},
        {"string a = concat(\"a\", \"b\", \"c\"); if (a == \"abc\") r = X; else r = 9;", TRAPEZE_GIVES(x)},
        {"string a = format(\"%d %s\", 3, \"x\"); if (a == \"3 x\") r = X; else r = 9;", TRAPEZE_GIVES(x)},
        {"printf(\"%g\", X); r = X;", TRAPEZE_GIVES(x)},
        {"r = match(\"b.d\", \"abcde\") + 10 * match(\"^b\", \"abc\") + X;", TRAPEZE_GIVES(1 + x)},
    };
    add_array_cases(cases);
    // Those of triples are those of their components.
    for (const std::string type : {"color", "point", "vector", "normal"}) {
        const std::string a = type + " (X, Y, 0.5)", b = type + " (Y, 0.4, X)";
        const auto of = [](const std::string& value) { return "r = K(" + value + ");"; };
        const auto by_component = [](auto function) {
            return [=](double x, double y) {
                return function(x, y) + 10 * function(y, 0.4) + 100 * function(0.5, x);
            };
        };
        cases.push_back({of("min(" + a + ", " + b + ")"),
                         by_component([](double p, double q) { return std::min(p, q); }), 1e-5});
        cases.push_back({of("max(" + a + ", " + b + ", " + b + ")"),
                         by_component([](double p, double q) { return std::max(p, q); }), 1e-5});
        cases.push_back({of("clamp(" + a + ", " + type + " 0.1, " + b + ")"),
                         by_component([](double p, double q) { return p < 0.1 ? 0.1 : std::min(p, q); }),
                         1e-5});
        if (type != "normal")
            cases.push_back(
                {of("pow(" + a + ", 3)"), TRAPEZE_GIVES(x * x * x + 10 * y * y * y + 100 * 0.125), 1e-5});
        cases.push_back({of("mix(" + a + ", " + b + ", 0.25)"),
                         by_component([](double p, double q) { return p + (q - p) * 0.25; }), 1e-5});
        for (const std::string& third : {type, std::string("color")})
            cases.push_back({of("mix(" + a + ", " + b + ", " + third + " (0.25, 0.5, 0.75))"),
                             TRAPEZE_GIVES(x + (y - x) * 0.25 + 10 * (y + (0.4 - y) * 0.5) +
                                           100 * (0.5 + (x - 0.5) * 0.75)),
                             1e-5});
    }
    return cases;
}

std::vector<BuiltinCase> geometry_cases() {
    const std::string m = "translate(matrix 1, vector (X, 2, 3))";
    std::vector<BuiltinCase> cases{
        {"r = xcomp(vector (X, 2, 3));", TRAPEZE_GIVES(x)},
        {"r = ycomp(vector (1, X, 3));", TRAPEZE_GIVES(x)},
        {"r = zcomp(vector (1, 2, X));", TRAPEZE_GIVES(x)},
        {"vector v = 1; setxcomp(v, X); r = K(v);", TRAPEZE_GIVES(x + 110), 1e-4},
        {"vector v = 1; setycomp(v, X); r = K(v);", TRAPEZE_GIVES(10 * x + 101), 1e-4},
        {"vector v = 1; setzcomp(v, X); r = K(v);", TRAPEZE_GIVES(100 * x + 11), 1e-4},
        {"r = length(vector (X, Y, 2));", TRAPEZE_GIVES(std::hypot(x, y, 2))},
        {"r = K(normalize(vector (X, 3, 4)));", TRAPEZE_GIVES((x + 30 + 400) / std::hypot(x, 3, 4)), 1e-4},
        {"r = distance(point (X, 1, 2), point (0, Y, 4));", TRAPEZE_GIVES(std::hypot(x, 1 - y, 2))},
        {"r = ptlined(point (0, 0, 0), point (X + 1, 0, 0), point (3, Y, 0));",
         TRAPEZE_GIVES(std::hypot(2 - x, y))},
        {"r = K(rotate(point (1, X, 2), PI / 2, point (0, 0, 0), point (0, 0, 1)));",
         TRAPEZE_GIVES(-x + 10 + 200), 1e-4},
        {"r = K(rotate(vector (1, X, 2), PI / 2, point (0, 0, 0), point (0, 0, 1)));",
         TRAPEZE_GIVES(-x + 10 + 200), 1e-4},
        {"r = K(vtransform(rotate(matrix 1, PI / 2, vector (0, 0, 1)), vector (1, X, 2)));",
         TRAPEZE_GIVES(-x + 10 + 200), 1e-4},
        // Against the view along +z; Ng is (0, 0, -1).
        {"r = K(faceforward(vector (X, 1, 2), vector (0, 0, 1)));", TRAPEZE_GIVES(x + 10 + 200), 1e-4},
        {"r = K(faceforward(vector (X, 1, 2), vector (0, 0, 1), vector (0, 0, 1)));",
         TRAPEZE_GIVES(-x - 10 - 200), 1e-4},
        {"r = K(reflect(vector (X, 1, 2), vector (0, 0, 1)));", TRAPEZE_GIVES(x + 10 - 200), 1e-4},
        // sin of the way in and out are as eta to 1.
        {"vector d = refract(normalize(vector (X, 0, 1)), vector (0, 0, -1), 0.5); r = xcomp(d) / length(d);",
         TRAPEZE_GIVES(0.5 * x / std::hypot(x, 1))},
        {"float kr, kt; fresnel(vector (0, 0, 1), vector (0, 0, -1), 1 / (X + 1), kr, kt); r = kr;",
         TRAPEZE_GIVES(std::pow(x / (2 + x), 2)), 1e-5},
        {"float kr, kt; vector R, T; fresnel(normalize(vector (X, 0, 1)), vector (0, 0, -1), 0.5, kr, kt, R, "
         "T);"
         "r = zcomp(R) * 10 + xcomp(T);",
         TRAPEZE_GIVES(-10 / std::hypot(x, 1) + 0.5 * x / std::hypot(x, 1)), 1e-5},
        // "far" is five to the right and ten ahead, and twice as large.
        {"r = K(transform(\"far\", point (X, 1, 2)));", TRAPEZE_GIVES((x - 5) / 2 + 5 - 400), 1e-3},
        {"r = K(transform(\"far\", \"current\", point (X, 1, 2)));", TRAPEZE_GIVES(2 * x + 5 + 20 + 1400),
         1e-3},
        {"r = K(transform(\"far\", " + m + ", point (X, 1, 2)));",
         TRAPEZE_GIVES(2 * x + 5 + x + 20 + 20 + 1400 + 300), 1e-3},
        {"r = K(transform(" + m + ", point (X, 1, 2)));", TRAPEZE_GIVES(2 * x + 30 + 500), 1e-3},
        {"r = K(vtransform(\"far\", vector (X, 1, 2)));", TRAPEZE_GIVES(x / 2 + 5 + 100), 1e-4},
        {"r = K(vtransform(\"far\", \"current\", vector (X, 1, 2)));", TRAPEZE_GIVES(2 * x + 20 + 400), 1e-3},
        {"r = K(vtransform(\"far\", " + m + ", vector (X, 1, 2)));", TRAPEZE_GIVES(2 * x + 20 + 400), 1e-3},
        {"r = K(vtransform(scale(matrix 1, vector (2, 3, Y)), vector (X, 1, 2)));",
         TRAPEZE_GIVES(2 * x + 30 + 200 * y), 1e-3},
        // Normals turn the other way.
        {"r = K(ntransform(\"far\", normal (X, 1, 2)));", TRAPEZE_GIVES(2 * x + 20 + 400), 1e-3},
        {"r = K(ntransform(\"far\", \"current\", normal (X, 1, 2)));", TRAPEZE_GIVES(x / 2 + 5 + 100), 1e-4},
        {"r = K(ntransform(\"far\", " + m + ", normal (X, 1, 2)));", TRAPEZE_GIVES(x / 2 + 5 + 100), 1e-4},
        {"r = K(ntransform(scale(matrix 1, vector (2, 4, Y + 1)), normal (X, 1, 2)));",
         TRAPEZE_GIVES(x / 2 + 2.5 + 200 / (y + 1)), 1e-4},
        {"r = comp(mtransform(\"far\", matrix (X + 1)), 3, 2) + comp(mtransform(\"far\", matrix 1), 0, 0) * "
         "X;",
         TRAPEZE_GIVES(-5 * (x + 1) + x / 2)},
        {"r = comp(mtransform(\"far\", \"current\", " + m + "), 3, 0);", TRAPEZE_GIVES(2 * x + 5)},
        {"r = comp(mtransform(\"far\", " + m + ", matrix 1), 3, 0);", TRAPEZE_GIVES(5 + x)},
        {"r = comp(mtransform(scale(matrix 1, vector (2, 3, 4)), " + m + "), 3, 0);", TRAPEZE_GIVES(2 * x)},
        // From the near plane at 0.5 to the far one at 4.5.
        {"r = depth(point (X, Y, 1.5 + X));", TRAPEZE_GIVES((1 + x) / 4)},
        {"r = comp(color (X, Y, 3), 1);", TRAPEZE_GIVES(y)},
        {"r = comp(point (X, Y, 3), 0) + comp(vector (X, Y, 3), 2);", TRAPEZE_GIVES(x + 3)},
        {"r = comp(" + m + ", 3, 0);", TRAPEZE_GIVES(x)},
        {"color c = 1; setcomp(c, 2, X); r = K(c);", TRAPEZE_GIVES(11 + 100 * x), 1e-4},
        {"point c = 1; setcomp(c, 1, X); r = K(c);", TRAPEZE_GIVES(101 + 10 * x), 1e-4},
        {"matrix k = 1; setcomp(k, 2, 1, X); r = comp(k, 2, 1) + comp(k, 1, 1);", TRAPEZE_GIVES(x + 1)},
        {"r = K(ctransform(\"hsv\", color (X, X, X)));", TRAPEZE_GIVES(100 * x), 1e-4},
        {"r = K(ctransform(\"hsv\", \"rgb\", color (1 / 3, 1, X)));", TRAPEZE_GIVES(10 * x), 1e-4},
        {"r = determinant(scale(matrix 1, vector (X + 1, 2, 3)));", TRAPEZE_GIVES(6 * (x + 1)), 1e-5},
    };
    // ptransform is another name of what transforms points.
    const std::string name = "K(transform(";
    for (size_t i = 0, count = cases.size(); i < count; ++i)
        if (const size_t at = cases[i].code.find(name); at != std::string::npos) {
            BuiltinCase other = cases[i];
            other.code.replace(at, name.size(), "K(ptransform(");
            cases.push_back(std::move(other));
        }
    return cases;
}

}  // namespace trapeze::testing
