#include <gtest/gtest.h>

#include <bit>
#include <cmath>

#include "shade/vm/kernels/kernel_harness.h"

namespace trapeze::vm {
namespace {

using rsl::Op;
using testing::check_kernel;
using testing::for_each_target;
using testing::KernelNumbers;
using testing::Register;

const float kTrue = std::bit_cast<float>(~0u);

/// Runs a kernel of lane masks on every target and compares all bits.
void check_mask(Op op, const std::vector<int>& widths, const std::function<float()>& number,
                const std::function<bool(const std::vector<std::vector<float>>&)>& function) {
    constexpr size_t kCount = 304;
    Register out(1, false, kCount), a(widths[1], false, kCount), b(widths.back(), false, kCount);
    a.fill(number), b.fill(number);
    for (size_t i = 0; i < kCount; i += 3)
        for (int k = 0; k < std::min(widths[1], widths.back()); ++k) b.set(i, k, a.at(i, k));
    std::vector<Operand> operands{out.operand(), a.operand()};
    if (widths.size() > 2) operands.push_back(b.operand());
    for_each_target([&] {
        find_kernel(op, widths)(kCount, operands);
        for (size_t i = 0; i < kCount; ++i) {
            std::vector<std::vector<float>> in(2);
            for (int k = 0; k < widths[1]; ++k) in[0].push_back(a.at(i, k));
            for (int k = 0; k < widths.back(); ++k) in[1].push_back(b.at(i, k));
            ASSERT_EQ(std::bit_cast<uint32_t>(out.at(i, 0)), function(in) ? ~0u : 0u)
                << int(op) << ' ' << in[0][0] << ' ' << in[1][0];
        }
    });
}

TEST(Bools, CompareNumbers) {
    KernelNumbers numbers;
    const auto any = [&] { return numbers.any(); };
    check_mask(Op::Less, {1, 1, 1}, any, [](const auto& in) { return in[0][0] < in[1][0]; });
    check_mask(Op::LessEqual, {1, 1, 1}, any, [](const auto& in) { return in[0][0] <= in[1][0]; });
    check_mask(Op::Greater, {1, 1, 1}, any, [](const auto& in) { return in[0][0] > in[1][0]; });
    check_mask(Op::GreaterEqual, {1, 1, 1}, any, [](const auto& in) { return in[0][0] >= in[1][0]; });
    check_mask(Op::ToBool, {1, 1}, any, [](const auto& in) { return in[0][0] != 0; });
    for (int width : {1, 3, 16}) {
        check_mask(Op::Equal, {1, width, width}, any, [](const auto& in) { return in[0] == in[1]; });
        check_mask(Op::NotEqual, {1, width, width}, any, [](const auto& in) { return in[0] != in[1]; });
    }
}

TEST(Bools, EveryComponentCounts) {
    for (int width : {3, 16})
        for (int different = 0; different < width; ++different) {
            Register out(1, false, 16), a(width, true, 16), b(width, false, 16);
            b.set(5, different, 1);
            find_kernel(Op::Equal, std::vector{1, width, width})(
                16, std::vector{out.operand(), a.operand(), b.operand()});
            for (size_t i = 0; i < 16; ++i) EXPECT_EQ(std::bit_cast<uint32_t>(out.at(i, 0)) == 0, i == 5);
        }
}

TEST(Bools, CombineMasks) {
    KernelNumbers numbers;
    const auto mask = [&] { return numbers.below(2) ? kTrue : 0; };
    const auto is = [](const std::vector<float>& x) { return std::bit_cast<uint32_t>(x[0]) != 0; };
    check_mask(Op::And, {1, 1, 1}, mask, [&](const auto& in) { return is(in[0]) && is(in[1]); });
    check_mask(Op::Or, {1, 1, 1}, mask, [&](const auto& in) { return is(in[0]) || is(in[1]); });
    check_mask(Op::Not, {1, 1}, mask, [&](const auto& in) { return !is(in[0]); });
    check_kernel(
        {Op::ToFloat, {1, 1}, [&](const auto& in, double* out) { out[0] = is(in[0]) ? 1 : 0; }, {mask}});
}

}  // namespace
}  // namespace trapeze::vm
