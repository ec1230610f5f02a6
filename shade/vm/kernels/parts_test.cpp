#include <gtest/gtest.h>

#include <cmath>

#include "shade/vm/kernels/kernel_harness.h"

namespace trapeze::vm {
namespace {

using rsl::Op;
using testing::check_kernel;
using testing::for_each_target;
using testing::KernelNumbers;
using testing::Register;
using testing::same_float;
using Inputs = std::vector<std::vector<float>>;

int index_of(float x, int count) {
    return x > 0 ? static_cast<int>(std::min(x, static_cast<float>(count - 1))) : 0;
}

/// Mostly inside an array of `count`, but also outside, fractional and not a number.
std::function<float()> indices(KernelNumbers& numbers, float count) {
    return [&numbers, count] { return numbers.below(3) ? numbers.between(-1, count + 1) : numbers.any(); };
}

TEST(Parts, AreAssembled) {
    check_kernel({Op::Triple, {3, 1, 1, 1}, [](const Inputs& in, double* out) {
                      for (size_t k = 0; k < 3; ++k) out[k] = in[k][0];
                  }});
    std::vector<Register> registers;
    for (int k = 0; k < 17; ++k) registers.emplace_back(k == 0 ? 16 : 1, k % 3 == 1, 48);
    KernelNumbers numbers;
    std::vector<Operand> operands;
    for (Register& r : registers) r.fill([&] { return numbers.any(); }), operands.push_back(r.operand());
    std::vector<int> widths(17, 1);
    widths[0] = 16;
    for_each_target([&] {
        find_kernel(Op::Sixteen, widths)(48, operands);
        for (size_t i = 0; i < 48; ++i)
            for (int k = 0; k < 16; ++k)
                EXPECT_TRUE(
                    same_float(registers[0].at(i, k), registers[static_cast<size_t>(k) + 1].at(i, 0)));
    });
}

TEST(Parts, AreTakenOut) {
    KernelNumbers numbers;
    const auto value = [&] { return numbers.any(); };
    check_kernel({Op::Component,
                  {1, 3, 1},
                  [](const Inputs& in, double* out) { *out = in[0][index_of(in[1][0], 3)]; },
                  {value, indices(numbers, 3)}});
    check_kernel({Op::MatrixElement,
                  {1, 16, 1, 1},
                  [](const Inputs& in, double* out) {
                      *out = in[0][4 * index_of(in[1][0], 4) + index_of(in[2][0], 4)];
                  },
                  {value, indices(numbers, 4), indices(numbers, 4)}});
}

/// Runs a kernel that sets a part of operand 0 and checks which part changed.
void check_set(Op op, int width, const std::function<int(const std::vector<float>&)>& part) {
    constexpr size_t kCount = 64;
    KernelNumbers numbers;
    const int index_count = width == 16 ? 2 : 1;
    for (unsigned varying = 0; varying < 8; ++varying) {
        std::vector<Register> inputs;
        for (int j = 0; j < index_count; ++j) {
            inputs.emplace_back(1, !(varying >> j & 1), kCount);
            inputs.back().fill(indices(numbers, width == 16 ? 4 : 3));
        }
        inputs.emplace_back(1, !(varying >> 2 & 1), kCount);
        inputs.back().fill([&] { return numbers.any(); });
        Register before(width, false, kCount);
        before.fill([&] { return numbers.any(); });
        for_each_target([&] {
            Register target = before;
            std::vector<Operand> operands{target.operand()};
            std::vector<int> widths{width};
            for (Register& input : inputs) operands.push_back(input.operand()), widths.push_back(1);
            find_kernel(op, widths)(kCount, operands);
            for (size_t i = 0; i < kCount; ++i) {
                std::vector<float> index;
                for (int j = 0; j < index_count; ++j)
                    index.push_back(inputs[static_cast<size_t>(j)].at(i, 0));
                for (int k = 0; k < width; ++k) {
                    const float expected = k == part(index) ? inputs.back().at(i, 0) : before.at(i, k);
                    ASSERT_TRUE(same_float(target.at(i, k), expected)) << i << ' ' << k << ' ' << index[0];
                }
            }
        });
    }
}

TEST(Parts, AreSet) {
    check_set(Op::SetComponent, 3, [](const auto& index) { return index_of(index[0], 3); });
    check_set(Op::SetMatrixElement, 16,
              [](const auto& index) { return 4 * index_of(index[0], 4) + index_of(index[1], 4); });
}

void check_elements(int width, int length, bool array_varies, bool index_varies) {
    constexpr size_t kCount = 64;
    KernelNumbers numbers;
    Register array(width, !array_varies, kCount, length), index(1, !index_varies, kCount);
    Register out(width, false, kCount);
    array.fill([&] { return numbers.any(); });
    index.fill(indices(numbers, static_cast<float>(length)));
    for_each_target([&] {
        find_kernel(Op::Element, std::vector{width, width, 1})(
            kCount, std::vector{out.operand(), array.operand(), index.operand()});
        for (size_t i = 0; i < kCount; ++i)
            for (int k = 0; k < width; ++k)
                ASSERT_TRUE(same_float(out.at(i, k), array.at(i, k, index_of(index.at(i, 0), length))))
                    << i << ' ' << index.at(i, 0);
    });
    if (!array_varies) return;
    Register value(width, index_varies, kCount);
    value.fill([&] { return numbers.any(); });
    for_each_target([&] {
        Register target = array;
        find_kernel(Op::SetElement, std::vector{width, 1, width})(
            kCount, std::vector{target.operand(), index.operand(), value.operand()});
        for (size_t i = 0; i < kCount; ++i)
            for (int e = 0; e < length; ++e)
                for (int k = 0; k < width; ++k) {
                    const bool here = e == index_of(index.at(i, 0), length);
                    ASSERT_TRUE(same_float(target.at(i, k, e), here ? value.at(i, k) : array.at(i, k, e)));
                }
    });
}

TEST(Parts, OfArrays) {
    for (int width : {1, 3, 16})
        for (int length : {1, 2, 7})
            for (bool array_varies : {false, true})
                for (bool index_varies : {false, true})
                    check_elements(width, length, array_varies, index_varies);
}

TEST(Parts, OfUniformArraysAreSetInAllLanes) {
    Register array(3, true, kLanes, 4), index(1, true, kLanes), value(3, true, kLanes);
    index.set(0, 0, 2.5f);
    value.fill([] { return 7.0f; });
    for_each_target([&] {
        Register target = array;
        find_kernel(Op::SetElement, std::vector{3, 1, 3})(
            kLanes, std::vector{target.operand(), index.operand(), value.operand()});
        for (size_t i = 0; i < kLanes; ++i)
            for (int e = 0; e < 4; ++e) EXPECT_EQ(target.at(i, 1, e), e == 2 ? 7 : 0) << i << ' ' << e;
    });
}

}  // namespace
}  // namespace trapeze::vm
