/// For tests of kernels: registers of random numbers, runs on every instruction set, and comparisons with a
/// function of one lane in doubles.
#pragma once

#include <gtest/gtest.h>

#include <functional>
#include <random>
#include <span>
#include <string>
#include <vector>

#include "core/simd/targets_harness.h"
#include "shade/vm/kernels/kernel.h"

namespace trapeze::testing {

/// A register, or an array of them, with its planes.
class Register {
  public:
    /// The planes of a float have no stride, those of a uniform register 16 lanes.
    Register(int width, bool uniform, size_t lanes, int length = 0);

    vm::Operand operand();
    int width() const { return width_; }
    float at(size_t lane, int k, int element = 0) const { return planes()[index(lane, k, element)]; }
    /// Of a uniform register: in all lanes.
    void set(size_t lane, int k, float value, int element = 0);
    /// Equal values in all lanes of a uniform register.
    void fill(const std::function<float()>& number);
    std::span<const float> planes() const { return {storage_.data()->lanes, storage_.size() * kLanes}; }

  private:
    size_t index(size_t lane, int k, int element) const {
        return (static_cast<size_t>(element) * width_ + k) * plane_ + (uniform_ ? lane % kLanes : lane);
    }
    int width_, length_;
    bool uniform_;
    size_t plane_;
    struct alignas(64) Group {
        float lanes[kLanes] = {};
    };
    std::vector<Group> storage_;
};

/// Random numbers for tests, the same in each run.
class KernelNumbers {
  public:
    float between(float low, float high) { return std::uniform_real_distribution<float>(low, high)(random_); }
    /// Of any sign and magnitude, a third of them from a table of zeros, whole numbers and extremes.
    float any();
    /// Finite ones of magnitude 1e-6..1e6, and zeros.
    float moderate();
    int below(int n) { return static_cast<int>(random_() % static_cast<unsigned>(n)); }

  private:
    std::mt19937 random_{11};
};

/// Equal bits, or both NaN.
::testing::AssertionResult same_float(float a, float b);

/// In units of the last place of `exact` as a float. 0 for equal infinities and two NaNs.
double ulps(float value, double exact);

/// One lane's inputs, each a span of its width's floats, to the outputs in turn.
using LaneFunction = std::function<void(const std::vector<std::vector<float>>& in, double* out)>;

struct KernelCheck {
    rsl::Op op;
    std::vector<int> widths;  ///< outputs first
    LaneFunction exact;
    std::vector<std::function<float()>> numbers = {};  ///< of each input; the last serves all that follow
    double most_ulps = 0;                              ///< NaN for NaN always
    double most_error =
        0;  ///< absolute, or relative to numbers greater than 1; an error within either is none
    size_t outputs = 1;
    size_t lanes = 304;
};

/// Runs the kernel with uniform and varying inputs in all combinations, on every target; all must give the
/// same bits and be near the exact values. `numbers` default to KernelNumbers::any().
void check_kernel(const KernelCheck& check);

}  // namespace trapeze::testing
