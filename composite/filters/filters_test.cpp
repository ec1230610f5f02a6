#include "composite/filters/filters.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numeric>

namespace trapeze {
namespace {

const char* const kNames[] = {"box",    "triangle",       "gaussian", "catmull-rom", "separable-catmull-rom",
                              "sinc",   "lanczos",        "b-spline", "mitchell",    "disk",
                              "bessel", "blackman-harris"};

float width_of(const std::string& name) {
    return name == "box" ? 1.0f : name == "gaussian" || name == "triangle" ? 2.0f : 4.0f;
}

std::vector<float> weights_at(const FilterKernel& kernel, float x, float y, FilterTaps* taps = nullptr) {
    std::vector<float> weights(kernel.tap_count());
    const FilterTaps at =
        kernel.weigh(x, y, static_cast<int>(std::floor(x)), static_cast<int>(std::floor(y)), weights.data());
    if (taps) *taps = at;
    return weights;
}

TEST(Filters, TableIsTheFormula) {
    for (const std::string name : kNames)
        for (const auto& [wx, wy] : {std::pair{width_of(name), width_of(name)}, {3.0f, 2.0f}, {2.5f, 5.0f}}) {
            const FilterKernel kernel({name, wx, wy});
            const double largest = filter_value(name, 0, 0, wx, wy);
            for (int s = 0; s < 97; ++s) {
                const float x = 7 + 0.0103f * static_cast<float>(s),
                            y = 3 + std::fmod(0.0617f * static_cast<float>(s), 1.0f);
                FilterTaps taps;
                const std::vector<float> weights = weights_at(kernel, x, y, &taps);
                for (int j = 0; j < kernel.taps_y(); ++j)
                    for (int i = 0; i < kernel.taps_x(); ++i) {
                        const double dx = x - (taps.x0 + i + 0.5), dy = y - (taps.y0 + j + 0.5);
                        const bool inside = std::abs(dx) <= wx / 2 && std::abs(dy) <= wy / 2;
                        const double expected = inside ? filter_value(name, dx, dy, wx, wy) : 0;
                        EXPECT_NEAR(weights[j * kernel.taps_x() + i], expected, 1e-5 * largest)
                            << name << " " << wx << "x" << wy << " at " << dx << " " << dy;
                    }
            }
        }
}

TEST(Filters, TapsHoldTheWholeSupportAndStayInReach) {
    for (const float width : {1.0f, 1.2f, 1.5f, 2.0f, 2.7f, 3.0f, 4.0f, 5.5f, 16.0f}) {
        const FilterKernel kernel({"box", width, width});
        for (int s = 0; s <= 1000; ++s) {
            const float x = 100 + 0.001f * static_cast<float>(s);
            const int pixel = 100;
            std::vector<float> weights(kernel.tap_count());
            const FilterTaps taps = kernel.weigh(x, 100.5f, pixel, 100, weights.data());
            const PixelRect footprint = kernel.footprint({pixel, 100, pixel + 1, 101});
            EXPECT_GE(taps.x0, footprint.x0);
            EXPECT_LE(taps.x0 + kernel.taps_x(), footprint.x1);
            for (int i = 0; i < kernel.taps_x(); ++i)
                for (int j = 0; j < kernel.taps_y(); ++j) {
                    const bool in_reach = std::abs(taps.x0 + i - pixel) <= kernel.reach_x();
                    EXPECT_TRUE(in_reach || weights[j * kernel.taps_x() + i] == 0) << width << " " << x;
                }
            for (int p = pixel - 20; p <= pixel + 20; ++p) {
                const float distance = std::abs(x - (static_cast<float>(p) + 0.5f));
                if (distance < width / 2 - 1e-4f) {
                    EXPECT_TRUE(p >= taps.x0 && p < taps.x0 + kernel.taps_x())
                        << width << " " << x << " " << p;
                }
            }
        }
    }
}

TEST(Filters, ASampleOnTheEdgeOrOutsideOfItsPixelStaysInItsFootprint) {
    for (const float width : {1.0f, 1.2f, 2.0f, 2.5f, 3.0f, 4.0f})
        for (const float x : {101.0f, 101.5f, 99.0f, std::nanf("")}) {
            const FilterKernel kernel({"box", width, width});
            const PixelRect footprint = kernel.footprint({100, 100, 101, 101});
            std::vector<float> weights(kernel.tap_count());
            const FilterTaps taps = kernel.weigh(x, x, 100, 100, weights.data());
            EXPECT_GE(taps.x0, footprint.x0);
            EXPECT_LE(taps.x0 + kernel.taps_x(), footprint.x1);
            EXPECT_GE(taps.y0, footprint.y0);
            EXPECT_LE(taps.y0 + kernel.taps_y(), footprint.y1);
            for (int i = 0; i < kernel.taps_x(); ++i) {
                const bool in_reach = std::abs(taps.x0 + i - 100) <= kernel.reach_x();
                EXPECT_TRUE(in_reach || weights[i] == 0) << width << " " << x;
            }
        }
}

TEST(Filters, SymmetricAndSwappedAxesAgree) {
    for (const std::string name : kNames)
        for (double x = -2; x <= 2; x += 0.17)
            for (double y = -2; y <= 2; y += 0.23) {
                const double w = width_of(name), value = filter_value(name, x, y, w, w);
                EXPECT_EQ(value, filter_value(name, -x, y, w, w)) << name;
                EXPECT_EQ(value, filter_value(name, x, -y, w, w)) << name;
                EXPECT_NEAR(value, filter_value(name, y, x, w, w), 1e-15) << name;
            }
}

TEST(Filters, LargestInTheMiddleAndMirroredSamplesGetMirroredWeights) {
    for (const std::string name : kNames) {
        const float w = width_of(name);
        for (double r = 0.01; r < w / 2; r += 0.1)
            EXPECT_LE(filter_value(name, r, 0, w, w), filter_value(name, 0, 0, w, w)) << name;
        const FilterKernel kernel({name, w, w});
        FilterTaps left_taps, right_taps;
        // 1/4 and 3/4 of pixel 8 are exact, so mirrored distances are equal to the last bit.
        const auto left = weights_at(kernel, 8.25f, 8.5f, &left_taps),
                   right = weights_at(kernel, 8.75f, 8.5f, &right_taps);
        for (int i = 0; i < kernel.taps_x(); ++i) {
            const int mirrored = 16 - (left_taps.x0 + i) - right_taps.x0;
            if (mirrored < 0 || mirrored >= kernel.taps_x()) continue;
            for (int j = 0; j < kernel.taps_y(); ++j)
                EXPECT_EQ(left[j * kernel.taps_x() + i], right[j * kernel.taps_x() + mirrored]) << name;
        }
    }
}

/// Filters that reconstruct a constant exactly: their weights on the pixels around any sample add up to the
/// same.
TEST(Filters, PartitionsOfUnity) {
    for (const auto& [name, width] : {std::pair{"box", 1.0f},
                                      {"triangle", 2.0f},
                                      {"separable-catmull-rom", 4.0f},
                                      {"b-spline", 4.0f},
                                      {"mitchell", 4.0f}}) {
        const FilterKernel kernel({name, width, width});
        const auto total = [&](float x, float y) {
            const auto weights = weights_at(kernel, x, y);
            return std::accumulate(weights.begin(), weights.end(), 0.0);
        };
        const double expected = total(5.5f, 5.5f);
        EXPECT_GT(expected, 0);
        for (int s = 0; s < 50; ++s)
            EXPECT_NEAR(total(5 + 0.0199f * static_cast<float>(s), 5 + 0.0071f * static_cast<float>(s)),
                        expected, 1e-5 * expected)
                << name;
    }
}

TEST(Filters, KnownValues) {
    EXPECT_DOUBLE_EQ(filter_value("gaussian", 0, 0, 2, 2), 1);
    EXPECT_DOUBLE_EQ(filter_value("gaussian", 1, 0, 2, 2), std::exp(-2.0));
    EXPECT_DOUBLE_EQ(filter_value("gaussian", 1, 1, 4, 2), std::exp(-2.0 * 1.25));
    EXPECT_DOUBLE_EQ(filter_value("triangle", 0.5, 0, 2, 2), 0.5);
    EXPECT_DOUBLE_EQ(filter_value("triangle", 0.5, 1, 4, 4), 0.75 * 0.5);
    EXPECT_DOUBLE_EQ(filter_value("catmull-rom", 0, 0, 4, 4), 2);
    EXPECT_NEAR(filter_value("catmull-rom", 0.6, 0.8, 4, 4), 0, 1e-15);
    EXPECT_NEAR(filter_value("catmull-rom", 1.5, 0, 4, 4), -0.125, 1e-15);
    EXPECT_NEAR(filter_value("mitchell", 0, 0, 4, 4), 64.0 / 81, 1e-15);
    EXPECT_NEAR(filter_value("mitchell", 1, 0, 4, 4), 8.0 / 9 / 18, 1e-15);
    EXPECT_NEAR(filter_value("b-spline", 1, 0, 4, 4), 1.0 / 9, 1e-15);
    EXPECT_NEAR(filter_value("sinc", 1, 0, 4, 4), 0, 1e-15);
    EXPECT_EQ(filter_value("disk", 1.5, 0.4, 4, 1), 0);
    EXPECT_EQ(filter_value("disk", 1.5, 0.4, 4, 2), 1);
    EXPECT_NEAR(filter_value("bessel", 1.21967, 0, 8, 8), 0, 1e-5);  // first zero of the jinc
    EXPECT_NEAR(filter_value("blackman-harris", 0, 0, 3, 3), 1, 1e-12);
}

TEST(Filters, AnUnknownNameWarnsOnceAndIsGaussian) {
    Diagnostics diagnostics;
    const FilterKernel unknown({"gausian", 2, 2}, &diagnostics), gaussian({"gaussian", 2, 2}, &diagnostics);
    EXPECT_EQ(diagnostics.count(Severity::Warning), 1u);
    EXPECT_EQ(diagnostics.kinds().count("unknown-filter"), 1u);
    EXPECT_EQ(weights_at(unknown, 3.3f, 4.1f), weights_at(gaussian, 3.3f, 4.1f));
}

TEST(Filters, AbsurdWidthsAreBounded) {
    for (const float width : {0.0f, -3.0f, std::nanf(""), 1e30f}) {
        const FilterKernel kernel({"gaussian", width, width});
        EXPECT_GE(kernel.taps_x(), 1);
        EXPECT_LE(kernel.taps_x(), 64);
        EXPECT_GT(weights_at(kernel, 10.5f, 10.5f)[kernel.tap_count() / 2], 0);
    }
}

}  // namespace
}  // namespace trapeze
