#include "composite/film/pixel_sums.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "core/random.h"
#include "core/simd/targets_harness.h"

namespace trapeze {
namespace {

using testing::for_each_target;

constexpr int kMostChannels = 9;

/// A pixel's samples at random places, with random numbers in each channel.
struct Pixel {
    int x = 7, y = -3, count;
    std::vector<float> xs, ys;
    SamplePlanes numbers;

    explicit Pixel(int samples) : count(samples), numbers(kMostChannels, static_cast<size_t>(samples)) {
        const auto number = [](int s, uint32_t n) { return unit_float(hash(static_cast<uint32_t>(s), n)); };
        for (int s = 0; s < samples; ++s) {
            xs.push_back(static_cast<float>(x) + number(s, 1));
            ys.push_back(static_cast<float>(y) + number(s, 2));
            for (uint32_t c = 0; c < kMostChannels; ++c)
                numbers[c][static_cast<size_t>(s)] = number(s, 3 + c) * 3 - 1;
        }
        xs.back() = static_cast<float>(x + 1);  // by rounding; still this pixel's
        xs[0] = static_cast<float>(x), ys[0] = static_cast<float>(y);
    }
    void sum_up(PixelSums& sums, int channels) const {
        std::vector<const float*> planes;
        for (int c = 0; c < channels; ++c) planes.push_back(numbers[static_cast<size_t>(c)]);
        sums.sum(xs.data(), ys.data(), x, y, planes);
    }
};

/// The same, a sample at a time, in double precision: a weight and the channels for each pixel around.
std::vector<double> sums_one_by_one(const FilterKernel& kernel, const Pixel& pixel, int columns, int rows,
                                    int channels) {
    std::vector<double> sums(static_cast<size_t>((1 + channels) * columns * rows));
    std::vector<float> weights(static_cast<size_t>(kernel.tap_count()));
    for (int s = 0; s < pixel.count; ++s) {
        const FilterTaps taps = kernel.weigh(pixel.xs[s], pixel.ys[s], pixel.x, pixel.y, weights.data());
        for (int j = 0; j < kernel.taps_y(); ++j)
            for (int i = 0; i < kernel.taps_x(); ++i) {
                const int column = taps.x0 + i - (pixel.x - kernel.reach_x()),
                          row = taps.y0 + j - (pixel.y - kernel.reach_y());
                const double weight = weights[static_cast<size_t>(j * kernel.taps_x() + i)];
                if (column >= columns || row >= rows) {
                    EXPECT_EQ(weight, 0);
                    continue;
                }
                double* const sum = &sums[static_cast<size_t>((1 + channels) * (row * columns + column))];
                sum[0] += weight;
                for (int c = 0; c < channels; ++c)
                    sum[1 + c] += weight * pixel.numbers[static_cast<size_t>(c)][s];
            }
    }
    return sums;
}

/// Checks sums of a filter against those one by one, and that all instruction sets give the same bits.
void check(const PixelFilter& filter, int samples, int channels) {
    SCOPED_TRACE(filter.name + ' ' + std::to_string(filter.width_x) + ' ' + std::to_string(filter.width_y) +
                 ' ' + std::to_string(samples) + ' ' + std::to_string(channels));
    const FilterKernel kernel(filter);
    const Pixel pixel(samples);
    std::vector<float> of_first;
    for_each_target([&] {
        PixelSums sums(kernel, static_cast<size_t>(samples), kMostChannels);
        pixel.sum_up(sums, kMostChannels);  // whose channels the next sums leave alone
        pixel.sum_up(sums, channels);
        const auto expected = sums_one_by_one(kernel, pixel, sums.columns(), sums.rows(), channels);
        double most = 1;  // catmull-rom's weights are of the size of 2
        for (const double sum : expected) most = std::max(most, std::abs(sum));
        std::vector<float> all;
        auto at = expected.begin();
        for (int j = 0; j < sums.rows(); ++j)
            for (int i = 0; i < sums.columns(); ++i)
                for (int c = 0; c <= channels; ++c) {
                    EXPECT_NEAR(sums.at(i, j)[c], *at++, 1e-6 * most) << i << ' ' << j << ' ' << c;
                    all.push_back(sums.at(i, j)[c]);
                }
        if (of_first.empty()) of_first = all;
        EXPECT_EQ(all, of_first);
    });
}

TEST(PixelSums, AreThoseOfSamplesOneByOneOnEveryInstructionSet) {
    for (const char* name : {"gaussian", "box", "mitchell", "sinc", "disk", "catmull-rom", "bessel"})
        for (const auto& [wx, wy] :
             {std::pair{1.0f, 1.0f}, {2.0f, 2.0f}, {3.0f, 2.0f}, {1.5f, 2.5f}, {4.0f, 3.5f}, {6.0f, 7.3f}})
            for (const int samples : {1, 4, 7, 8, 16, 23, 64})
                for (const int channels : {0, 4, 5, 9}) check({name, wx, wy}, samples, channels);
}

TEST(PixelSums, OfVariablesHaveWhatIsNotFiniteWhereItsSampleHasAWeight) {
    for (const int samples : {4, 64}) {
        const FilterKernel kernel({"box", 1.5f, 1.5f});
        Pixel pixel(samples);
        pixel.xs[2] = static_cast<float>(pixel.x) + 0.9f;  // reaches the pixel and the one to the right of it
        pixel.ys[2] = static_cast<float>(pixel.y) + 0.5f;
        pixel.numbers[4][2] = std::numeric_limits<float>::infinity();
        for_each_target([&] {
            PixelSums sums(kernel, static_cast<size_t>(samples), 5);
            pixel.sum_up(sums, 5);
            for (int j = 0; j < sums.rows(); ++j)
                for (int i = 0; i < sums.columns(); ++i)
                    EXPECT_EQ(std::isfinite(sums.at(i, j)[5]), j != 1 || i == 0) << i << ' ' << j;
        });
    }
}

}  // namespace
}  // namespace trapeze
