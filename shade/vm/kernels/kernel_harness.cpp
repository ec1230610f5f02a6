#include "shade/vm/kernels/kernel_harness.h"

#include <bit>
#include <cmath>
#include <limits>

namespace trapeze::testing {

Register::Register(int width, bool uniform, size_t lanes, int length)
    : width_(width),
      length_(length),
      uniform_(uniform),
      plane_(uniform ? kLanes : padded_size(lanes)),
      storage_(plane_ / kLanes * static_cast<size_t>(width * std::max(length, 1))) {}

vm::Operand Register::operand() {
    vm::Operand o;
    o.data = storage_.data()->lanes;
    o.lane_mask = uniform_ ? 0 : ~size_t{0};
    o.stride = width_ == 1 ? 0 : plane_;
    o.element_stride = length_ > 0 ? plane_ * static_cast<size_t>(width_) : 0;
    o.length = length_;
    return o;
}

void Register::set(size_t lane, int k, float value, int element) {
    const auto put = [&](size_t i) {
        const size_t at = index(i, k, element);
        storage_[at / kLanes].lanes[at % kLanes] = value;
    };
    if (!uniform_) return put(lane);
    for (size_t i = 0; i < kLanes; ++i) put(i);
}

void Register::fill(const std::function<float()>& number) {
    for (int element = 0; element < std::max(length_, 1); ++element)
        for (int k = 0; k < width_; ++k)
            for (size_t i = 0; i < (uniform_ ? 1 : plane_); ++i) set(i, k, number(), element);
}

float KernelNumbers::any() {
    constexpr float kInfinity = std::numeric_limits<float>::infinity();
    constexpr float kTable[] = {0,
                                -0.0f,
                                1,
                                -1,
                                2,
                                0.5f,
                                -0.5f,
                                1.5f,
                                2.5f,
                                1e-40f,
                                -3e-42f,
                                3e38f,
                                -3e38f,
                                1e20f,
                                kInfinity,
                                -kInfinity,
                                1e-38f,
                                -7,
                                std::numeric_limits<float>::quiet_NaN()};
    if (below(3) == 0) return kTable[below(static_cast<int>(std::size(kTable)))];
    const float magnitude = std::exp2(between(-40, 40));
    return below(2) ? magnitude : -magnitude;
}

float KernelNumbers::moderate() {
    if (below(8) == 0) return 0;
    const float magnitude = std::exp2(between(-20, 20));
    return below(2) ? magnitude : -magnitude;
}

::testing::AssertionResult same_float(float a, float b) {
    if (std::isnan(a) && std::isnan(b)) return ::testing::AssertionSuccess();
    if (std::bit_cast<uint32_t>(a) == std::bit_cast<uint32_t>(b)) return ::testing::AssertionSuccess();
    return ::testing::AssertionFailure() << a << " and " << b;
}

double ulps(float value, double exact) {
    if (std::isnan(exact) || std::isnan(value)) return std::isnan(exact) && std::isnan(value) ? 0 : INFINITY;
    if (static_cast<float>(exact) == value) return 0;
    if (std::isinf(value) || std::isinf(exact)) return INFINITY;
    const int exponent = std::max(std::ilogb(exact == 0 ? 1e-300 : exact), -126);
    return std::fabs(value - exact) / std::ldexp(1.0, exponent - 23);
}

namespace {

using KernelRegisters = std::vector<Register>;

KernelRegisters make_inputs(const KernelCheck& check, unsigned varying, KernelNumbers& numbers) {
    KernelRegisters inputs;
    for (size_t j = check.outputs; j < check.widths.size(); ++j) {
        const size_t input = j - check.outputs;
        inputs.emplace_back(check.widths[j], !(varying >> input & 1), check.lanes);
        if (check.numbers.empty())
            inputs.back().fill([&] { return numbers.any(); });
        else
            inputs.back().fill(check.numbers[std::min(input, check.numbers.size() - 1)]);
    }
    return inputs;
}

KernelRegisters run(const KernelCheck& check, bool uniform, KernelRegisters& inputs) {
    KernelRegisters outputs;
    std::vector<vm::Operand> operands;
    for (size_t j = 0; j < check.outputs; ++j) outputs.emplace_back(check.widths[j], uniform, check.lanes);
    for (Register& output : outputs) operands.push_back(output.operand());
    for (Register& input : inputs) operands.push_back(input.operand());
    const vm::Kernel kernel = vm::find_kernel(check.op, check.widths);
    EXPECT_NE(kernel, nullptr);
    if (kernel) kernel(uniform ? kLanes : check.lanes, operands);
    return outputs;
}

void expect_near_scalar(const KernelCheck& check, const KernelRegisters& inputs,
                        const KernelRegisters& outputs, size_t lane) {
    std::vector<std::vector<float>> in;
    std::string text;
    for (const Register& input : inputs) {
        in.emplace_back();
        for (int k = 0; k < input.width(); ++k) {
            in.back().push_back(input.at(lane, k));
            text += std::to_string(input.at(lane, k)) + ' ';
        }
    }
    double exact[64];
    check.exact(in, exact);
    const double* next = exact;
    for (const Register& output : outputs)
        for (int k = 0; k < output.width(); ++k, ++next) {
            const float value = output.at(lane, k);
            const double scale = std::max(1.0, std::fabs(*next));
            if (std::fabs(value - *next) <= check.most_error * scale) continue;
            ASSERT_LE(ulps(value, *next), check.most_ulps)
                << value << " for " << *next << " in lane " << lane << " component " << k << " of " << text;
        }
}

}  // namespace

void check_kernel(const KernelCheck& check) {
    const size_t input_count = check.widths.size() - check.outputs;
    KernelNumbers numbers;
    for (unsigned varying = 0; varying < 1u << input_count; ++varying) {
        SCOPED_TRACE(::testing::Message() << "varying inputs: " << varying);
        KernelRegisters inputs = make_inputs(check, varying, numbers);
        const KernelRegisters first = run(check, varying == 0, inputs);
        for (size_t lane = 0; lane < (varying == 0 ? kLanes : check.lanes); ++lane) {
            expect_near_scalar(check, inputs, first, lane);
            if (::testing::Test::HasFatalFailure()) return;
        }
        for_each_target([&] {
            const KernelRegisters again = run(check, varying == 0, inputs);
            for (size_t j = 0; j < again.size(); ++j)
                for (size_t i = 0; i < first[j].planes().size(); ++i)
                    ASSERT_TRUE(same_float(again[j].planes()[i], first[j].planes()[i])) << i;
        });
        if (::testing::Test::HasFatalFailure()) return;
    }
}

}  // namespace trapeze::testing
