#include "composite/film/pixel_sums.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "core/random.h"
#include "core/simd/targets_harness.h"

namespace trapeze {
namespace {

using testing::for_each_target;

/// A pixel's samples at random places, with random colours.
struct Pixel {
    int x = 7, y = -3, count;
    std::vector<float> xs, ys, colors;

    explicit Pixel(int samples) : count(samples) {
        const auto number = [](int s, uint32_t n) { return unit_float(hash(static_cast<uint32_t>(s), n)); };
        for (int s = 0; s < samples; ++s) {
            xs.push_back(static_cast<float>(x) + number(s, 1));
            ys.push_back(static_cast<float>(y) + number(s, 2));
            for (uint32_t c = 0; c < 4; ++c) colors.push_back(number(s, 3 + c) * 3 - 1);
        }
        xs[0] = static_cast<float>(x), ys[0] = static_cast<float>(y);
        xs.back() = static_cast<float>(x + 1);  // by rounding; still this pixel's
    }
    void put(PixelSums& sums, bool colored) const {
        for (int s = 0; s < count && colored; ++s) sums.set_color(static_cast<size_t>(s), &colors[4 * s]);
        sums.sum(xs.data(), ys.data(), x, y, colored);
    }
};

/// The same, a sample at a time, in double precision: five numbers for each pixel around.
std::vector<double> sums_one_by_one(const FilterKernel& kernel, const Pixel& pixel, int columns, int rows) {
    std::vector<double> sums(static_cast<size_t>(5 * columns * rows));
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
                double* const sum = &sums[static_cast<size_t>(5 * (row * columns + column))];
                sum[0] += weight;
                for (int c = 0; c < 4; ++c)
                    sum[1 + c] += weight * pixel.colors[static_cast<size_t>(4 * s + c)];
            }
    }
    return sums;
}

TEST(PixelSums, AreThoseOfSamplesOneByOneOnEveryInstructionSet) {
    for (const char* name : {"gaussian", "box", "mitchell", "sinc"})
        for (const auto& [wx, wy] :
             {std::pair{1.0f, 1.0f}, {2.0f, 2.0f}, {3.0f, 2.0f}, {1.5f, 2.5f}, {4.0f, 3.5f}})
            for (const int samples : {8, 16, 23, 64})
                for (const bool colored : {true, false}) {
                    SCOPED_TRACE(std::string(name) + ' ' + std::to_string(wx) + ' ' + std::to_string(wy) +
                                 ' ' + std::to_string(samples));
                    const FilterKernel kernel({name, wx, wy});
                    ASSERT_TRUE(PixelSums::suits(kernel, samples));
                    const Pixel pixel(samples);
                    std::vector<float> of_first;
                    for_each_target([&] {
                        PixelSums sums(kernel, samples);
                        pixel.put(sums, colored);
                        const auto expected = sums_one_by_one(kernel, pixel, sums.columns(), sums.rows());
                        std::vector<float> all;
                        for (int j = 0; j < sums.rows(); ++j)
                            for (int i = 0; i < sums.columns(); ++i)
                                for (int c = 0; c < (colored ? 5 : 1); ++c) {
                                    const auto at = static_cast<size_t>(5 * (j * sums.columns() + i) + c);
                                    EXPECT_NEAR(sums.at(i, j)[c], expected[at], 2e-5) << i << j << c;
                                    all.push_back(sums.at(i, j)[c]);
                                }
                        if (of_first.empty()) of_first = all;
                        EXPECT_EQ(all, of_first);
                    });
                }
}

TEST(PixelSums, AreNotForFewSamplesOrFiltersOfTheDistance) {
    EXPECT_FALSE(PixelSums::suits(FilterKernel({"gaussian", 2, 2}), 4));
    EXPECT_FALSE(PixelSums::suits(FilterKernel({"disk", 2, 2}), 64));
    EXPECT_FALSE(PixelSums::suits(FilterKernel({"gaussian", 6, 2}), 64));
}

}  // namespace
}  // namespace trapeze
