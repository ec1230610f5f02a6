#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <cstdlib>

#include "core/math.h"
#include "shade/vm/kernels/exact_noise_harness.h"
#include "shade/vm/kernels/kernel_harness.h"
#include "shade/vm/kernels/random.h"

namespace trapeze::vm {
namespace {

using rsl::Op;
using testing::check_kernel;
using testing::for_each_target;
using testing::KernelCheck;
using testing::KernelNumbers;
using testing::Register;
using testing::same_float;
using Inputs = std::vector<std::vector<float>>;

std::vector<int> input_widths(int dimensions) {
    const std::vector<int> widths[] = {{1}, {1, 1}, {3}, {3, 1}};
    return widths[dimensions - 1];
}

std::vector<double> flatten(const Inputs& in) {
    std::vector<double> x;
    for (const auto& v : in) x.insert(x.end(), v.begin(), v.end());
    return x;
}

std::vector<int> widths_of(int output, int dimensions, bool periodic) {
    std::vector<int> widths{output};
    for (int times = 0; times < (periodic ? 2 : 1); ++times)
        for (int width : input_widths(dimensions)) widths.push_back(width);
    return widths;
}

TEST(Noise, IsASumOverCorners) {
    KernelNumbers numbers;
    const auto coordinate = [&] {
        return numbers.below(5) ? numbers.between(-20, 20) : float(numbers.below(9) - 4);
    };
    for (int dimensions = 1; dimensions <= 4; ++dimensions)
        for (int output : {1, 3}) {
            SCOPED_TRACE(::testing::Message() << dimensions << " dimensions to " << output);
            const auto exact = [&](const Inputs& in, double* out) {
                for (int k = 0; k < output; ++k) out[k] = testing::exact_noise(flatten(in), {}, k);
            };
            check_kernel({Op::Noise, widths_of(output, dimensions, false), exact, {coordinate}, 0, 3e-6});
        }
}

TEST(Noise, MayBePeriodic) {
    KernelNumbers numbers;
    const auto coordinate = [&] {
        return numbers.below(5) ? numbers.between(-20, 20) : float(numbers.below(9) - 4);
    };
    const auto period = [&] { return numbers.between(0.5f, 9); };
    for (int dimensions = 1; dimensions <= 4; ++dimensions)
        for (int output : {1, 3}) {
            SCOPED_TRACE(::testing::Message() << dimensions << " dimensions to " << output);
            const auto exact = [&](const Inputs& in, double* out) {
                const auto all = flatten(in);
                const auto half = all.begin() + dimensions;
                for (int k = 0; k < output; ++k)
                    out[k] = testing::exact_noise({all.begin(), half}, {half, all.end()}, k);
            };
            KernelCheck check{
                Op::PeriodicNoise, widths_of(output, dimensions, true), exact, {coordinate}, 0, 3e-6};
            if (dimensions % 2 == 0) check.numbers.push_back(coordinate);
            check.numbers.push_back(period);
            check_kernel(check);
        }
}

/// Values of a kernel of one triple along a line; every register is varying.
Register along(Op op, int width, const V3f& from, const V3f& step, size_t count, float period = 0) {
    Register out(width, false, count), p(3, false, count), periods(3, true, count);
    for (size_t i = 0; i < count; ++i)
        for (int k = 0; k < 3; ++k) p.set(i, k, from[k] + static_cast<float>(i) * step[k]);
    periods.fill([&] { return period; });
    std::vector<Operand> operands{out.operand(), p.operand()};
    std::vector<int> widths{width, 3};
    if (period > 0) operands.push_back(periods.operand()), widths.push_back(3);
    find_kernel(op, widths)(padded_size(count), operands);
    return out;
}

struct Moments {
    double mean = 0, deviation = 0, least = 1, most = 0;
};
Moments moments(const Register& values, int k, size_t count) {
    Moments m;
    double squares = 0;
    for (size_t i = 0; i < count; ++i) {
        const double x = values.at(i, k);
        m.mean += x / static_cast<double>(count), squares += x * x / static_cast<double>(count);
        m.least = std::min(m.least, x), m.most = std::max(m.most, x);
    }
    m.deviation = std::sqrt(squares - m.mean * m.mean);
    return m;
}

double correlation(const Register& a, int ka, size_t shift, const Register& b, int kb, size_t count) {
    const Moments ma = moments(a, ka, count), mb = moments(b, kb, count);
    double sum = 0;
    for (size_t i = 0; i + shift < count; ++i)
        sum += (a.at(i + shift, ka) - ma.mean) * (b.at(i, kb) - mb.mean);
    return sum / static_cast<double>(count - shift) / (ma.deviation * mb.deviation);
}

/// A million points at random, of all cells or of those of a period.
struct Scattered {
    std::vector<Register> registers;  ///< the output, the coordinates, their periods

    Scattered(int dimensions, int output, bool periodic) {
        const std::vector<int> widths = widths_of(output, dimensions, periodic);
        const size_t first_period = 1 + input_widths(dimensions).size();
        std::vector<Operand> operands;
        KernelNumbers numbers;
        for (size_t i = 0; i < widths.size(); ++i) {
            const bool is_period = i >= first_period;
            registers.emplace_back(widths[i], is_period, is_period ? kLanes : kPoints);
            if (is_period) registers[i].fill([] { return 2000.0f; });
            if (i > 0 && !is_period) registers[i].fill([&] { return numbers.between(-5000, 5000); });
        }
        for (Register& r : registers) operands.push_back(r.operand());
        find_kernel(periodic ? Op::PeriodicNoise : Op::Noise, widths)(kPoints, operands);
    }

    static constexpr size_t kPoints = 1 << 20;
};

// What shaders make of noise, they make for the contrast that it has in every renderer.
TEST(Noise, HasTheContrastOfOthersInEveryForm) {
    for (int dimensions = 1; dimensions <= 4; ++dimensions)
        for (int output : {1, 3})
            for (bool periodic : {false, true}) {
                SCOPED_TRACE(::testing::Message() << dimensions << " to " << output << ' ' << periodic);
                const Scattered noise(dimensions, output, periodic);
                for (int k = 0; k < output; ++k) {
                    const Moments m = moments(noise.registers[0], k, Scattered::kPoints);
                    EXPECT_NEAR(m.mean, 0.5, 0.005);
                    EXPECT_NEAR(m.deviation, 0.085, 0.005);
                    EXPECT_GE(m.least, 0.1);
                    EXPECT_LE(m.most, 0.9);
                }
            }
}

TEST(Noise, HasItInPlanesOfTheLatticeToo) {
    constexpr size_t kCount = 1 << 20;
    const Register plane = along(Op::Noise, 1, V3f(-3000.2f, 10.1f, 7), V3f(0.0317f, 0.0713f, 0), kCount);
    EXPECT_NEAR(moments(plane, 0, kCount).deviation, 0.085, 0.005);
}

TEST(Noise, HasAContinuousSlopeAcrossCells) {
    constexpr float kStep = 1.0f / 512;
    for (int i = 0; i < 100; ++i) {
        const float where = static_cast<float>(i);
        const Register r = along(Op::Noise, 3, V3f(where - kStep, 0.3f + where, 5.6f), V3f(kStep, 0, 0), 3);
        for (int k = 0; k < 3; ++k)
            EXPECT_NEAR((r.at(2, k) - r.at(1, k)) / kStep, (r.at(1, k) - r.at(0, k)) / kStep, 0.01) << i;
    }
}

TEST(Noise, FillsItsRangeAroundAHalf) {
    constexpr size_t kCount = 200000;
    const Register noise =
        along(Op::Noise, 3, V3f(-3000.2f, 10.1f, 7), V3f(0.0317f, 0.0713f, -0.0519f), kCount);
    for (int k = 0; k < 3; ++k) {
        const Moments m = moments(noise, k, kCount);
        EXPECT_NEAR(m.mean, 0.5, 0.005);
        EXPECT_NEAR(m.deviation, 0.085, 0.005);
        EXPECT_LT(m.least, 0.25);
        EXPECT_GT(m.most, 0.75);
        EXPECT_LT(std::fabs(correlation(noise, k, 0, noise, (k + 1) % 3, kCount)), 0.03);
    }
}

TEST(Noise, IsContinuousAndAHalfOnTheLattice) {
    const Register fine = along(Op::Noise, 3, V3f(-2, 1, 5), V3f(1.0f / 1024, 0, 1.0f / 2048), 8192);
    for (size_t i = 0; i + 1 < 8192; ++i)
        for (int k = 0; k < 3; ++k) EXPECT_LT(std::fabs(fine.at(i + 1, k) - fine.at(i, k)), 2.7e-3);
    const Register lattice = along(Op::Noise, 3, V3f(-50, 3, 20), V3f(1, 2, -1), 200);
    for (size_t i = 0; i < 200; ++i)
        for (int k = 0; k < 3; ++k) EXPECT_EQ(lattice.at(i, k), 0.5f);
}

TEST(Noise, OfNeighbouringCellsIsUnrelated) {
    constexpr size_t kCount = 100000;
    for (const V3f& step : {V3f(1, 0, 0), V3f(0, 1, 0), V3f(0, 0, 1), V3f(1, -1, 2)}) {
        const Register noise = along(Op::Noise, 1, V3f(-999.7f, 0.45f, 0.6f), step, kCount);
        const Register cells = along(Op::CellNoise, 3, V3f(-999.5f, 0.5f, 0.5f), step, kCount);
        for (size_t shift = 2; shift < 20; ++shift) {
            EXPECT_LT(std::fabs(correlation(noise, 0, shift, noise, 0, kCount)), 0.02) << shift;
            EXPECT_LT(std::fabs(correlation(cells, 0, shift - 1, cells, 1, kCount)), 0.02) << shift;
            EXPECT_LT(std::fabs(correlation(cells, 2, shift - 1, cells, 2, kCount)), 0.02) << shift;
        }
    }
}

TEST(Noise, RepeatsWithItsPeriod) {
    for (float period : {1.0f, 3.0f, 7.0f, 1000.0f}) {
        const V3f from(-2.3f * period, 0.25f, 1.75f), step(0.25f, 0.5f, 0.125f);
        const Register here = along(Op::PeriodicNoise, 3, from, step, 512, period);
        const Register there =
            along(Op::PeriodicNoise, 3, from + V3f(3 * period, -period, 8 * period), step, 512, period);
        for (size_t i = 0; i < 512; ++i)
            for (int k = 0; k < 3; ++k)
                ASSERT_NEAR(here.at(i, k), there.at(i, k), 2e-3) << period << ' ' << i;
    }
}

TEST(CellNoise, IsUniformAndConstantInEachCell) {
    constexpr size_t kCount = 160000;
    const Register cells = along(Op::CellNoise, 3, V3f(-5e4f, 0.1f, 3), V3f(1, 0.5f, 0), kCount);
    for (int k = 0; k < 3; ++k) {
        std::vector<int> counts(16);
        for (size_t i = 0; i < kCount; ++i) {
            const float x = cells.at(i, k);
            ASSERT_TRUE(x >= 0 && x < 1);
            ++counts[static_cast<size_t>(x * 16)];
        }
        for (int count : counts) EXPECT_NEAR(count, kCount / 16, 500);
        EXPECT_LT(std::fabs(correlation(cells, k, 0, cells, (k + 1) % 3, kCount)), 0.02);
    }
    const Register one = along(Op::CellNoise, 1, V3f(-3, 2, 0), V3f(0.999f / 1000), 1000);
    for (size_t i = 0; i < 1000; ++i) EXPECT_EQ(one.at(i, 0), one.at(0, 0));
    EXPECT_NE(along(Op::CellNoise, 1, V3f(-3.001f, 2, 0), V3f(0), 1).at(0, 0), one.at(0, 0));
}

TEST(CellNoise, HashesItsCell) {
    KernelNumbers numbers;
    for (int dimensions = 1; dimensions <= 4; ++dimensions)
        for (int output : {1, 3}) {
            const auto exact = [&](const Inputs& in, double* out) {
                constexpr uint32_t kFactors[] = {0x297a2d39u, 0x85ebca6bu, 0xc2b2ae35u};
                std::vector<int64_t> cell;
                for (double x : flatten(in))
                    cell.push_back(static_cast<int64_t>(
                        std::floor(x < 2147483520.0 ? std::max(x, -2147483520.0) : 2147483520.0)));
                for (int k = 0; k < output; ++k)
                    out[k] = (testing::hash_of(cell, 0x3c6ef372u, kFactors[k]) >> 8) * 0x1p-24;
            };
            check_kernel({Op::CellNoise, widths_of(output, dimensions, false), exact, {[&] {
                              return numbers.any();
                          }}});
        }
}

TEST(Noise, OfAnyNumbersIsInRange) {
    KernelNumbers numbers;
    for (int dimensions = 1; dimensions <= 4; ++dimensions) {
        const std::vector<int> widths = widths_of(3, dimensions, true);
        std::vector<Register> registers;
        std::vector<Operand> operands;
        for (int width : widths) registers.emplace_back(width, false, 4096);
        for (Register& r : registers) r.fill([&] { return numbers.any(); }), operands.push_back(r.operand());
        for_each_target([&] {
            find_kernel(Op::PeriodicNoise, widths)(4096, operands);
            for (float x : registers[0].planes()) ASSERT_TRUE(x >= 0 && x <= 1) << x;
        });
    }
}

/// Images depend on these values; they may not change.
TEST(Noise, IsTheSameForEver) {
    const V3f from(0.3f, -1.7f, 4.1f), step(0.37f, 0.61f, -0.83f);
    const Register noise = along(Op::Noise, 3, from, step, 4), cells = along(Op::CellNoise, 3, from, step, 4);
    const float expected_noise[] = {0.35977804660797119f, 0.44386360049247742f, 0.42064392566680908f,
                                    0.38147294521331787f, 0.49907159805297852f, 0.45352891087532043f};
    const float expected_cells[] = {0.65782022476196289f, 0.15254604816436768f, 0.5694546103477478f,
                                    0.9470212459564209f,  0.85817223787307739f, 0.72345322370529175f};
    for (int i = 0; i < 6; ++i) {
        EXPECT_TRUE(same_float(noise.at(static_cast<size_t>(i / 3), i % 3), expected_noise[i])) << i;
        EXPECT_TRUE(same_float(cells.at(static_cast<size_t>(i / 3), i % 3), expected_cells[i])) << i;
    }
}

TEST(Random, DiffersByLaneCallAndComponent) {
    constexpr size_t kCount = 65536;
    Register seeds(1, false, kCount), first(3, false, kCount), second(3, false, kCount);
    for (size_t i = 0; i < kCount; ++i) seeds.set(i, 0, std::bit_cast<float>(static_cast<uint32_t>(i)));
    random_numbers(kCount, 3, seeds.operand(), 1, first.operand());
    random_numbers(kCount, 3, seeds.operand(), 2, second.operand());
    for (int k = 0; k < 3; ++k) {
        const Moments m = moments(first, k, kCount);
        EXPECT_NEAR(m.mean, 0.5, 0.005);
        EXPECT_NEAR(m.deviation, std::sqrt(1.0 / 12), 0.005);
        EXPECT_GE(m.least, 0);
        EXPECT_LT(m.most, 1);
        for (int other = 0; other < 3; ++other) {
            EXPECT_LT(std::fabs(correlation(first, k, 0, second, other, kCount)), 0.02) << k << other;
            EXPECT_LT(std::fabs(correlation(first, k, 1, first, other, kCount)), 0.02) << k << other;
        }
        EXPECT_LT(std::fabs(correlation(first, k, 0, first, (k + 1) % 3, kCount)), 0.02) << k;
    }
    for_each_target([&] {
        Register again(3, false, kCount);
        random_numbers(kCount, 3, seeds.operand(), 1, again.operand());
        EXPECT_TRUE(std::equal(again.planes().begin(), again.planes().end(), first.planes().begin()));
    });
}

}  // namespace
}  // namespace trapeze::vm
