#include "shade/vm/kernels/spline.h"

#include <gtest/gtest.h>

#include <cmath>

#include "shade/vm/kernels/kernel_harness.h"

namespace trapeze::vm {
namespace {

using testing::check_kernel;
using testing::for_each_target;
using testing::KernelNumbers;
using testing::Register;

/// By definition of each kind of curve: de Casteljau's construction, blossoms, tangents.
double curve(SplineBasis basis, const double (&p)[4], double t) {
    const auto mix = [](double a, double b, double at) { return a + (b - a) * at; };
    const auto hermite = [&](double a, double da, double b, double db) {
        const double s = 1 - t;
        return s * s * (1 + 2 * t) * a + s * s * t * da + t * t * (3 - 2 * t) * b - t * t * s * db;
    };
    switch (basis) {
        case SplineBasis::CatmullRom:
            return hermite(p[1], (p[2] - p[0]) / 2, p[2], (p[3] - p[1]) / 2);
        case SplineBasis::Hermite:
            return hermite(p[0], p[1], p[2], p[3]);
        case SplineBasis::Bezier: {
            const double a = mix(p[0], p[1], t), b = mix(p[1], p[2], t), c = mix(p[2], p[3], t);
            return mix(mix(a, b, t), mix(b, c, t), t);
        }
        case SplineBasis::BSpline: {  // de Boor's construction with knots at -2 .. 3
            const double a = mix(p[0], p[1], (t + 2) / 3), b = mix(p[1], p[2], (t + 1) / 3),
                         c = mix(p[2], p[3], t / 3);
            return mix(mix(a, b, (t + 1) / 2), mix(b, c, t / 2), t);
        }
        case SplineBasis::Linear:
            return mix(p[1], p[2], t);
        case SplineBasis::Constant:
            return p[1];
    }
    return 0;
}

double exact_spline(SplineBasis basis, float value, const std::vector<float>& knots) {
    const int step = basis == SplineBasis::Bezier ? 3 : basis == SplineBasis::Hermite ? 2 : 1;
    const int segments = (static_cast<int>(knots.size()) - 4) / step + 1;
    // In floats: where a segment ends is not the spline's precision but the argument's.
    const float t = std::min(value > 0 ? value : 0, 1.0f) * static_cast<float>(segments);
    const int segment = std::min(static_cast<int>(t), segments - 1);
    double p[4];
    for (int j = 0; j < 4; ++j) p[j] = knots[static_cast<size_t>(segment * step + j)];
    return curve(basis, p, t - static_cast<float>(segment));
}

struct Layout {
    int width, knots;
    bool array, value_varies, knots_vary;
};

void check_spline(SplineBasis basis, const Layout& layout) {
    constexpr size_t kCount = 128;
    KernelNumbers numbers;
    Register out(layout.width, false, kCount), value(1, !layout.value_varies, kCount);
    value.fill([&] {
        return numbers.below(4) ? numbers.between(-0.2f, 1.2f) : static_cast<float>(numbers.below(5)) / 4;
    });
    if (layout.value_varies) value.set(3, 0, NAN), value.set(4, 0, INFINITY), value.set(5, 0, -INFINITY);
    std::vector<Register> knots;
    for (int j = 0; j < (layout.array ? 1 : layout.knots); ++j) {
        knots.emplace_back(layout.width, !layout.knots_vary, kCount, layout.array ? layout.knots : 0);
        knots.back().fill([&] { return numbers.between(-1, 2); });
    }
    std::vector<Operand> operands{out.operand(), value.operand()};
    for (Register& k : knots) operands.push_back(k.operand());
    for_each_target([&] {
        find_spline_kernel(basis, layout.width)(kCount, operands);
        for (size_t i = 0; i < kCount; ++i)
            for (int k = 0; k < layout.width; ++k) {
                std::vector<float> here;
                for (int j = 0; j < layout.knots; ++j)
                    here.push_back(layout.array ? knots[0].at(i, k, j)
                                                : knots[static_cast<size_t>(j)].at(i, k));
                ASSERT_NEAR(out.at(i, k), exact_spline(basis, value.at(i, 0), here), 5e-6)
                    << int(basis) << ' ' << value.at(i, 0) << ' ' << layout.knots;
            }
    });
}

TEST(Spline, FollowsItsCurve) {
    for (SplineBasis basis : {SplineBasis::CatmullRom, SplineBasis::Bezier, SplineBasis::BSpline,
                              SplineBasis::Hermite, SplineBasis::Linear, SplineBasis::Constant})
        for (int width : {1, 3})
            for (int knots : {4, 5, 7, 13, 40})
                for (unsigned way = 0; way < 8; ++way)
                    check_spline(basis, {width, knots, (way & 1) != 0, (way & 2) != 0, (way & 4) != 0});
}

TEST(Spline, GivesTheSameBitsOnAllTargets) {
    std::vector<int> widths(9, 1);
    KernelNumbers numbers;
    check_kernel({rsl::Op::Spline,
                  widths,
                  [](const auto& in, double* out) {
                      std::vector<float> knots;
                      for (size_t j = 1; j < in.size(); ++j) knots.push_back(in[j][0]);
                      *out = exact_spline(SplineBasis::CatmullRom, in[0][0], knots);
                  },
                  {[&] { return numbers.between(0, 1); }, [&] { return numbers.between(-1, 1); }},
                  0,
                  2e-6,
                  1,
                  48});
}

TEST(Spline, OfTooFewKnotsIsZero) {
    Register out(1, false, 16), value(1, true, 16), array(1, true, 16, 3);
    array.fill([] { return 5.0f; });
    out.fill([] { return 9.0f; });
    find_spline_kernel(SplineBasis::Bezier, 1)(16,
                                               std::vector{out.operand(), value.operand(), array.operand()});
    for (size_t i = 0; i < 16; ++i) EXPECT_EQ(out.at(i, 0), 0);
}

TEST(Spline, KnowsItsBases) {
    EXPECT_EQ(spline_basis("catmull-rom"), SplineBasis::CatmullRom);
    EXPECT_EQ(spline_basis("catrom"), SplineBasis::CatmullRom);
    EXPECT_EQ(solved_spline_basis("solvecatrom"), SplineBasis::CatmullRom);
    EXPECT_EQ(spline_basis("bspline"), SplineBasis::BSpline);
    EXPECT_EQ(spline_basis("b-spline"), SplineBasis::BSpline);
    EXPECT_FALSE(spline_basis("Bezier"));
    EXPECT_EQ(solved_spline_basis("solveb-spline"), SplineBasis::BSpline);
    EXPECT_FALSE(solved_spline_basis("solveconstant") || solved_spline_basis("solve") ||
                 solved_spline_basis("linear"));
    EXPECT_FALSE(find_spline_inverse(SplineBasis::Constant) || find_named_spline("solvelinear", 3));
}

}  // namespace
}  // namespace trapeze::vm
