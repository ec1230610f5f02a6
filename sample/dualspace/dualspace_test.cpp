#include <gtest/gtest.h>

#include <cmath>

#include "sample/dualspace/sample_masks.h"
#include "sample/frame_harness.h"
#include "sample/patterns/stratified_pattern.h"
#include "sample/visibility.h"

namespace trapeze {
namespace {

using testing::GridMaker;
using testing::TestFrame;

struct Resolved {
    SampleTile samples;
    HitBuffer hits;
    SampleStats stats;
    SampleScratch scratch;
};

void resolve(const TestFrame& frame, const Grids& grids, std::string_view method, const PixelRect& pixels,
             Resolved& result) {
    std::string error;
    const auto sampler = choose_sampler(method, "stratified", &error);
    ASSERT_TRUE(sampler) << error;
    const auto pattern = sampler->make_pattern(frame.context);
    const auto visibility = sampler->prepare(frame.context, grids);
    pattern->make_tile(pixels, result.samples);
    result.stats = {};
    visibility->resolve(result.samples, result.hits, result.scratch, result.stats);
}

/// A sheet of micropolygons half a pixel large before the focal plane, that flies sideways and turns.
void add_flying_sheet(GridMaker& maker, int keys) {
    maker.add(16, 16, keys, [](int i, int j, float t) {
        const float x = 0.03f * static_cast<float>(i - 8), y = 0.03f * static_cast<float>(j - 8);
        return V3f(x * std::cos(t) - y * std::sin(t) + 2 * t - 1,
                   x * std::sin(t) + y * std::cos(t) + 0.5f * t, 3.5f + 0.5f * t);
    });
}

TEST(SampleMasks, HoldTheSamplesBelowEachBin) {
    for (const int rate : {1, 3, 8, 13})
        for (const bool lens : {false, true}) {
            const TestFrame frame(32, 32, rate, true, lens);
            SampleTile samples;
            StratifiedPattern(frame.context).make_tile({3, 5, 6, 7}, samples);
            SampleMasks masks;
            masks.build({}, lens);
            masks.build(samples, lens);
            const auto per_pixel = static_cast<size_t>(rate) * rate;
            for (size_t i = 0; i < samples.size(); ++i) {
                const size_t pixel = i / per_pixel, s = i % per_pixel;
                const int px = 3 + static_cast<int>(pixel % 3), py = 5 + static_cast<int>(pixel / 3);
                const float places[] = {
                    lens ? (samples.lens_u[i] + 1) / 2 : samples.x[i] - static_cast<float>(px),
                    lens ? (samples.lens_v[i] + 1) / 2 : samples.y[i] - static_cast<float>(py),
                    samples.time[i]};
                for (int axis = 0; axis < SampleMasks::kAxes; ++axis)
                    for (int bin = 0; bin <= SampleMasks::kBins; ++bin) {
                        const uint64_t* set = masks.below(pixel, static_cast<SampleMasks::Axis>(axis)) +
                                              static_cast<size_t>(bin) * masks.words();
                        const bool has = set[s / 64] >> (s % 64) & 1;
                        ASSERT_EQ(has, SampleMasks::bin(places[axis]) < bin) << axis << " " << bin;
                    }
            }
        }
}

TEST(DualSpace, AnyRectangleIsRight) {
    const TestFrame frame(90, 70, 3, true, true);
    GridMaker maker;
    add_flying_sheet(maker, 5);
    Resolved truth, found;
    for (const PixelRect& pixels : {PixelRect{0, 0, 90, 70}, PixelRect{-5, -3, 62, 66},
                                    PixelRect{43, 37, 44, 38}, PixelRect{31, 30, 36, 67}}) {
        resolve(frame, maker.grids(), "bruteforce", pixels, truth);
        resolve(frame, maker.grids(), "dualspace", pixels, found);
        EXPECT_TRUE(found.hits == truth.hits) << pixels.x0 << " " << pixels.x1;
    }
}

/// What the bounds are for: brute force tests all samples in the swept box.
TEST(DualSpace, FewSamplesAreTested) {
    for (const int keys : {2, 5}) {
        const TestFrame frame(90, 70, 8, true, true);
        GridMaker maker;
        add_flying_sheet(maker, keys);
        Resolved all, few;
        resolve(frame, maker.grids(), "bruteforce", {0, 0, 90, 70}, all);
        resolve(frame, maker.grids(), "dualspace", {0, 0, 90, 70}, few);
        EXPECT_TRUE(few.hits == all.hits);
        EXPECT_GT(few.stats.predicate_hits, 0u);
        EXPECT_LT(few.stats.predicate_tests, all.stats.predicate_tests / 20);
    }
}

/// Pixels that add nearly a word's worth to a queue that is nearly full; the address sanitizer looks on.
TEST(DualSpace, OneMicropolygonMayHoldAllSamples) {
    TestFrame frame(40, 30, 1, true, true);
    frame.context.samples_x = 9, frame.context.samples_y = 7;
    GridMaker maker;
    for (const int keys : {1, 2})
        maker.add(1, 1, keys, [=](int i, int j, float t) {
            return V3f(20 * static_cast<float>(i) - 10 + t, 20 * static_cast<float>(j) - 10,
                       4 + static_cast<float>(keys));
        });
    Resolved truth, found;
    resolve(frame, maker.grids(), "bruteforce", {0, 0, 40, 30}, truth);
    resolve(frame, maker.grids(), "dualspace", {0, 0, 40, 30}, found);
    EXPECT_TRUE(found.hits == truth.hits);
    EXPECT_EQ(found.hits.hits.size(), found.samples.size());
}

/// More parts than segments, and fewer.
TEST(DualSpace, PartsOfTheShutterChangeNoHit) {
    const TestFrame frame(90, 70, 4, true, true);
    for (const int keys : {1, 2, 5, 65}) {
        GridMaker maker;
        maker.opaque = false;
        add_flying_sheet(maker, keys);
        Resolved truth, found;
        resolve(frame, maker.grids(), "bruteforce", {0, 0, 90, 70}, truth);
        uint64_t tests = ~uint64_t{0};
        for (const std::string parts : {"1", "2", "4", "8"}) {
            resolve(frame, maker.grids(), "dualspace:parts=" + parts, {0, 0, 90, 70}, found);
            EXPECT_TRUE(found.hits == truth.hits) << keys << " " << parts;
            EXPECT_LE(found.stats.predicate_tests, tests);
            tests = found.stats.predicate_tests;
        }
    }
}

TEST(DualSpace, WithoutALensThePlaceInThePixelIsBounded) {
    const TestFrame frame(90, 70, 8, false, false);
    GridMaker maker;
    maker.add(16, 16, 1, [](int i, int j, float) {
        return V3f(0.02f * static_cast<float>(i - 8), 0.02f * static_cast<float>(j - 8), 4);
    });
    Resolved found;
    resolve(frame, maker.grids(), "dualspace", {0, 0, 90, 70}, found);
    EXPECT_GT(found.stats.predicate_hits, 0u);
    EXPECT_LT(found.stats.predicate_tests, 3 * found.stats.predicate_hits);
}

TEST(DualSpace, HeatAddsUpToTheCounts) {
    const TestFrame frame(90, 70, 2, true, true);
    GridMaker maker;
    add_flying_sheet(maker, 2);
    SampleHeat heat;
    heat.tests.assign(size_t{90} * 70 * 4, 0);
    heat.nodes = heat.tests;
    Resolved found;
    found.scratch.heat = &heat;
    resolve(frame, maker.grids(), "dualspace", {0, 0, 90, 70}, found);
    uint64_t sum = 0;
    for (size_t s = 0; s < heat.tests.size(); ++s) {
        sum += heat.tests[s];
        ASSERT_GE(heat.tests[s], found.hits.of(s).size());
    }
    EXPECT_EQ(sum, found.stats.predicate_tests);
}

}  // namespace
}  // namespace trapeze
