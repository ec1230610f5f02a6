#include <gtest/gtest.h>

#include <cmath>

#include "shade/vm/kernels/kernel_harness.h"

namespace trapeze::vm {
namespace {

using rsl::Op;
using testing::check_kernel;
using testing::KernelNumbers;
using testing::Register;
using Floats = std::vector<float>;

/// Checks the kernels for floats and triples, and for triples of floats, against a function of components.
void check_components(Op op, int inputs, const std::function<float(const Floats&)>& function) {
    for (int output : {1, 3})
        for (int input : {1, 3}) {
            if (input > output) continue;
            SCOPED_TRACE(::testing::Message() << "op " << int(op) << " widths " << output << ' ' << input);
            std::vector<int> widths(static_cast<size_t>(inputs) + 1, output);
            widths.back() = input;
            check_kernel({op, widths, [&](const auto& in, double* out) {
                              for (int k = 0; k < output; ++k) {
                                  Floats x;
                                  for (const Floats& v : in) x.push_back(v.size() == 1 ? v[0] : v[k]);
                                  out[k] = function(x);
                              }
                          }});
        }
}

TEST(Arithmetic, OfOneNumber) {
    check_components(Op::Move, 1, [](const Floats& x) { return x[0]; });
    check_components(Op::Negate, 1, [](const Floats& x) { return -x[0]; });
    check_components(Op::Abs, 1, [](const Floats& x) { return std::fabs(x[0]); });
    check_components(Op::Sign, 1, [](const Floats& x) { return x[0] < 0 ? -1.0f : x[0] > 0 ? 1.0f : 0.0f; });
    check_components(Op::Floor, 1, [](const Floats& x) { return std::floor(x[0]); });
    check_components(Op::Ceil, 1, [](const Floats& x) { return std::ceil(x[0]); });
    check_components(Op::Round, 1, [](const Floats& x) {
        if (std::fabs(x[0]) > 1e7f) return x[0];
        return static_cast<float>(std::floor(double{x[0]} + 0.5));
    });
    check_components(Op::Sqrt, 1, [](const Floats& x) { return x[0] > 0 ? std::sqrt(x[0]) : 0; });
    check_components(Op::InverseSqrt, 1, [](const Floats& x) {
        return 1 / std::sqrt(x[0] > 1.17549435e-38f ? x[0] : 1.17549435e-38f);
    });
}

TEST(Arithmetic, OfTwoNumbers) {
    check_components(Op::Add, 2, [](const Floats& x) { return x[0] + x[1]; });
    check_components(Op::Subtract, 2, [](const Floats& x) { return x[0] - x[1]; });
    check_components(Op::Multiply, 2, [](const Floats& x) { return x[0] * x[1]; });
    check_components(Op::Divide, 2, [](const Floats& x) { return x[0] / x[1]; });
    check_components(Op::Step, 2, [](const Floats& x) { return x[1] < x[0] ? 0.0f : 1.0f; });
    check_components(Op::Min, 2, [](const Floats& x) { return x[0] < x[1] ? x[0] : x[1]; });
    check_components(Op::Max, 2, [](const Floats& x) { return x[0] > x[1] ? x[0] : x[1]; });
    check_components(Op::Max, 4, [](const Floats& x) {
        float most = x[0];
        for (float other : {x[1], x[2], x[3]}) most = most > other ? most : other;
        return most;
    });
}

TEST(Arithmetic, OfThreeNumbers) {
    check_components(Op::Clamp, 3, [](const Floats& x) {
        if (!(x[0] >= x[1])) return x[1];
        return x[0] < x[2] ? x[0] : x[2];
    });
    check_components(Op::Mix, 3, [](const Floats& x) { return x[0] * (1 - x[2]) + x[1] * x[2]; });
    check_components(Op::SmoothStep, 3, [](const Floats& x) {
        if (!(x[0] < x[1])) return x[2] < x[0] ? 0.0f : 1.0f;
        const float t = (x[2] - x[0]) / (x[1] - x[0]);
        const float u = !(t > 0) ? 0.0f : t < 1 ? t : 1.0f;
        return u * u * (3 - 2 * u);
    });
}

TEST(Arithmetic, RemaindersAreInsideTheirPeriod) {
    KernelNumbers numbers;
    const auto whole = [&] { return std::floor(numbers.between(-1e6f, 1e6f)); };
    const auto period = [&] { return static_cast<float>(numbers.below(100) - 50); };
    const auto floored = [](const auto& in, double* out) {
        const double a = in[0][0], b = in[1][0];
        out[0] = b == 0 ? 0 : a - b * std::floor(a / b);
    };
    check_kernel({Op::Mod, {1, 1, 1}, floored, {whole, period}});

    const Kernel kernel = find_kernel(Op::Mod, std::vector{1, 1, 1});
    Register out(1, false, 4096), a(1, false, 4096), b(1, false, 4096);
    a.fill([&] { return numbers.moderate(); });
    b.fill([&] { return numbers.moderate(); });
    kernel(4096, std::vector{out.operand(), a.operand(), b.operand()});
    for (size_t i = 0; i < 4096; ++i) {
        const float r = out.at(i, 0), period_here = b.at(i, 0);
        if (period_here == 0) {
            EXPECT_EQ(r, 0);
        } else if (std::fabs(a.at(i, 0) / period_here) < 1e6f) {
            EXPECT_GE(r * std::copysign(1.0f, period_here), 0) << a.at(i, 0) << ' ' << period_here;
            EXPECT_LT(std::fabs(r), std::fabs(period_here)) << a.at(i, 0);
        }
    }
}

TEST(Arithmetic, OfMatrices) {
    check_kernel({Op::Move, {16, 16}, [](const auto& in, double* out) {
                      std::copy(in[0].begin(), in[0].end(), out);
                  }});
    check_kernel({Op::Move, {16, 1}, [](const auto& in, double* out) {
                      for (int k = 0; k < 16; ++k) out[k] = k / 4 == k % 4 ? in[0][0] : 0.0f;
                  }});
    check_kernel({Op::Subtract, {16, 16, 16}, [](const auto& in, double* out) {
                      for (int k = 0; k < 16; ++k) out[k] = in[0][k] - in[1][k];
                  }});
}

TEST(Arithmetic, SelectsByMask) {
    KernelNumbers numbers;
    const auto mask = [&] { return std::bit_cast<float>(numbers.below(2) ? ~0u : 0u); };
    const auto value = [&] { return numbers.any(); };
    for (int width : {1, 3, 16})
        check_kernel({Op::Select,
                      {width, 1, width, width},
                      [&](const auto& in, double* out) {
                          const bool chosen = std::bit_cast<uint32_t>(in[0][0]) != 0;
                          for (int k = 0; k < width; ++k) out[k] = chosen ? in[1][k] : in[2][k];
                      },
                      {mask, value}});
}

TEST(Arithmetic, OutputsMayBeInputs) {
    Register a(3, false, 64), b(1, true, 64);
    KernelNumbers numbers;
    a.fill([&] { return numbers.moderate(); });
    b.fill([] { return 0.25f; });
    const Register before = a;
    find_kernel(Op::Multiply, std::vector{3, 3, 1})(64, std::vector{a.operand(), a.operand(), b.operand()});
    for (size_t i = 0; i < 64; ++i)
        for (int k = 0; k < 3; ++k) EXPECT_EQ(a.at(i, k), before.at(i, k) * 0.25f);
}

TEST(Arithmetic, RefusesWidthsItLacks) {
    EXPECT_EQ(find_kernel(Op::Add, std::vector{2, 2, 2}), nullptr);
    EXPECT_EQ(find_kernel(Op::Add, std::vector{1, 1}), nullptr);
    EXPECT_EQ(find_kernel(Op::Illuminance, std::vector{3, 3}), nullptr);
}

}  // namespace
}  // namespace trapeze::vm
