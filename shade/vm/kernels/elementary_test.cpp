#include <gtest/gtest.h>

#include <cmath>

#include "shade/vm/kernels/kernel_harness.h"

namespace trapeze::vm {
namespace {

using rsl::Op;
using testing::check_kernel;
using testing::KernelNumbers;
using testing::Register;
using Inputs = std::vector<std::vector<float>>;
constexpr double kLeastNormal = 1.17549435e-38f;

struct OneNumber {
    Op op;
    double (*exact)(double);
    double least, most;  ///< of the argument
    double ulps, error;  ///< within either
};

/// Many arguments in a range, every magnitude alike where the range is wide, at both widths.
void check_function(const OneNumber& f) {
    SCOPED_TRACE(::testing::Message() << "op " << int(f.op) << " from " << f.least << " to " << f.most);
    KernelNumbers numbers;
    const auto argument = [&] {
        const float low = static_cast<float>(f.least), high = static_cast<float>(f.most);
        if (high <= 100 && numbers.below(2)) return numbers.between(low, high);
        const float magnitude = std::exp2(numbers.between(-30, std::log2(high)));
        return low < 0 && numbers.below(2) ? -magnitude : std::max(magnitude, low);
    };
    for (int width : {1, 3}) {
        const auto exact = [&](const Inputs& in, double* out) {
            for (int k = 0; k < width; ++k) out[k] = f.exact(in[0][k]);
        };
        check_kernel({f.op, {width, width}, exact, {argument}, f.ulps, f.error, 1, 20000});
    }
}

TEST(Elementary, Sines) {
    for (double most : {3.0, 100.0, 1e4, 1e6}) {
        check_function({Op::Sin, std::sin, -most, most, 2, 0});
        check_function({Op::Cos, std::cos, -most, most, 2, 0});
        check_function({Op::Tan, std::tan, -most, most, 3, 0});
    }
    check_function({Op::Sin, std::sin, -1e9, 1e9, 0, 2e-7});
    check_function({Op::Cos, std::cos, -1e9, 1e9, 0, 2e-7});
}

TEST(Elementary, Arcs) {
    check_function({Op::Asin, std::asin, -1, 1, 3, 0});
    check_function({Op::Acos, std::acos, -1, 1, 3, 0});
    check_function({Op::Atan, std::atan, -1e30, 1e30, 3, 0});
    check_function({Op::Atan, std::atan, -10, 10, 3, 0});
}

TEST(Elementary, ExponentialsAndLogarithms) {
    check_function({Op::Exp, std::exp, -87, 88.7, 2, 0});
    check_function({Op::Log, std::log, kLeastNormal, 3.4e38, 2, 0});
    check_function({Op::Log, std::log, 0.4, 2.5, 2, 0});
}

/// Where erfc is small z * z is rounded, by up to 1 in 2^24 of some 80.
TEST(Elementary, ErrorFunctions) {
    check_function({Op::Erf, std::erf, -0.5, 0.5, 3, 0});
    check_function({Op::Erf, std::erf, -12, 12, 0, 3e-7});
    check_function({Op::Erfc, std::erfc, -12, 1, 0, 4e-7});
    check_function({Op::Erfc, std::erfc, 1, 9, 120, 0});
}

TEST(Elementary, AnglesOfVectors) {
    KernelNumbers numbers;
    const auto exact = [](const Inputs& in, double* out) {
        const double y = in[0][0], x = in[1][0];
        *out = x == 0 && y == 0 ? y : std::atan2(y, x);
    };
    check_kernel({Op::Atan2, {1, 1, 1}, exact, {[&] { return numbers.moderate(); }}, 3, 0, 1, 20000});
    check_kernel({Op::Atan2, {1, 1, 1}, exact, {[&] { return numbers.between(-1, 1) * 3.3e38f; }}, 3, 0});
}

TEST(Elementary, Powers) {
    KernelNumbers numbers;
    const auto exact = [](const Inputs& in, double* out) {
        *out = std::pow(double{in[0][0]}, double{in[1][0]});
    };
    const auto base = [&] { return std::exp2(numbers.between(-20, 20)); };
    const auto near_one = [&] { return numbers.between(0.5f, 1.5f); };
    // The results are normal floats.
    check_kernel({Op::Pow, {1, 1, 1}, exact, {base, [&] { return numbers.between(-6, 6); }}, 2, 0, 1, 20000});
    check_kernel(
        {Op::Pow, {1, 1, 1}, exact, {near_one, [&] { return numbers.between(-120, 120); }}, 2, 0, 1, 20000});
    const auto whole = [&] { return static_cast<float>(numbers.below(13) - 6); };
    check_kernel({Op::Pow, {1, 1, 1}, exact, {[&] { return -base(); }, whole}, 2, 0});
}

float call(Op op, std::vector<float> arguments) {
    std::vector<Register> registers(arguments.size() + 1, Register(1, true, kLanes));
    std::vector<Operand> operands;
    for (size_t j = 0; j < arguments.size(); ++j) registers[j + 1].set(0, 0, arguments[j]);
    for (Register& r : registers) operands.push_back(r.operand());
    find_kernel(op, std::vector<int>(registers.size(), 1))(kLanes, operands);
    return registers[0].at(0, 0);
}

TEST(Elementary, ArgumentsOutsideTheDomainAreClamped) {
    EXPECT_FLOAT_EQ(call(Op::Asin, {2}), M_PI_2);
    EXPECT_FLOAT_EQ(call(Op::Acos, {-7}), M_PI);
    EXPECT_EQ(call(Op::Acos, {1}), 0);
    EXPECT_FLOAT_EQ(call(Op::Log, {0}), std::log(1.17549435e-38f));
    EXPECT_EQ(call(Op::Log, {-5}), call(Op::Log, {0}));
    EXPECT_EQ(call(Op::Exp, {1000}), INFINITY);
    EXPECT_EQ(call(Op::Exp, {-1000}), 0);
    EXPECT_EQ(call(Op::Erf, {0}), 0);
    EXPECT_EQ(call(Op::Erf, {INFINITY}), 1);
    EXPECT_EQ(call(Op::Erf, {-INFINITY}), -1);
    EXPECT_EQ(call(Op::Erfc, {INFINITY}), 0);
    EXPECT_EQ(call(Op::Erfc, {-INFINITY}), 2);
    EXPECT_EQ(call(Op::Pow, {0, 0}), 1);
    EXPECT_EQ(call(Op::Pow, {0, 0.5f}), 0);
    EXPECT_EQ(call(Op::Pow, {-2, 0.5f}), 0);
    EXPECT_EQ(call(Op::Pow, {-2, 3}), -8);
    EXPECT_EQ(call(Op::Pow, {2, 1000}), INFINITY);
    EXPECT_EQ(call(Op::Pow, {2, -1000}), 0);
    EXPECT_EQ(call(Op::Atan2, {0, 0}), 0);
    EXPECT_FLOAT_EQ(call(Op::Atan2, {0, -1}), M_PI);
}

TEST(Elementary, NothingGivesNoNumber) {
    KernelNumbers numbers;
    for (Op op :
         {Op::Exp, Op::Log, Op::Sin, Op::Cos, Op::Tan, Op::Asin, Op::Acos, Op::Atan, Op::Erf, Op::Erfc})
        for (int i = 0; i < 300; ++i) {
            const float x = numbers.any();
            EXPECT_FALSE(std::isnan(call(op, {x}))) << int(op) << ' ' << x;
        }
    for (Op op : {Op::Pow, Op::Atan2})
        for (int i = 0; i < 1000; ++i) {
            const float x = numbers.any(), y = numbers.any();
            EXPECT_FALSE(std::isnan(call(op, {x, y}))) << int(op) << ' ' << x << ' ' << y;
        }
}

}  // namespace
}  // namespace trapeze::vm
