/// What is particular to the rasterizer "interval"; that it agrees with other methods is in
/// agreement_test.cpp.
#include <gtest/gtest.h>

#include <cmath>
#include <numeric>
#include <random>

#include "sample/frame_harness.h"
#include "sample/visibility.h"

namespace trapeze {
namespace {

using testing::GridMaker;
using testing::TestFrame;

/// Wavy squares that fly across the picture, some through the near plane.
void add_squares(GridMaker& maker, int count, int keys) {
    std::mt19937 engine(5);
    const auto noise = [&](float from, float to) {
        return std::uniform_real_distribution<float>(from, to)(engine);
    };
    for (int n = 0; n < count; ++n) {
        const V3f at(noise(-4, 4), noise(-3, 3), n % 7 == 0 ? noise(-0.5f, 0.5f) : noise(2, 9));
        const V3f shift(noise(-1, 1), noise(-1, 1), noise(-0.5f, 0.5f));
        const int nu = 1 + n % 16, nv = 1 + n * 5 % 16;
        maker.add(nu, nv, keys, [&](int i, int j, float t) {
            const V3f p(0.1f * static_cast<float>(i), 0.1f * static_cast<float>(j),
                        0.1f * std::sin(static_cast<float>(i + j)));
            return at + p + shift * (keys == 1 ? 0 : t * t);
        });
    }
}

struct ResolvedWithHeat {
    HitBuffer hits;
    SampleStats stats;
    SampleHeat heat;
};

ResolvedWithHeat resolve(const TestFrame& frame, const Grids& grids, std::string_view method,
                         std::string_view pattern_name, const PixelRect& pixels) {
    std::string error;
    const auto sampler = choose_sampler(method, pattern_name, &error);
    EXPECT_TRUE(sampler) << error;
    const auto pattern = sampler->make_pattern(frame.context);
    SampleTile samples;
    pattern->make_tile(pixels, samples);
    ResolvedWithHeat resolved;
    resolved.heat.tests.assign(samples.size(), 0);
    resolved.heat.nodes.assign(samples.size(), 0);
    SampleScratch scratch;
    scratch.heat = &resolved.heat;
    sampler->prepare(frame.context, grids)->resolve(samples, resolved.hits, scratch, resolved.stats);
    return resolved;
}

TestFrame small_frame(int nx, int ny, bool motion, bool defocus) {
    TestFrame frame(150, 100, 1, motion, defocus);
    frame.context.samples_x = nx, frame.context.samples_y = ny;
    return frame;
}

struct Form {
    const char *method, *pattern;
};
constexpr Form kIntervalForms[] = {{"interval", "interval"},
                                   {"interval:cull=on", "interval"},
                                   {"interval:pairing=shuffled", "stratified"},
                                   {"interval:pairing=shuffled,cull=on", "stratified"}};

TEST(Interval, RefusesPatternsThatItsSlotsDoNotFit) {
    std::string error;
    EXPECT_FALSE(choose_sampler("interval", "stratified", &error));
    EXPECT_NE(error.find("its own is \"interval\""), std::string::npos) << error;
    EXPECT_FALSE(choose_sampler("interval:pairing=shuffled", "interval", &error));
    EXPECT_TRUE(choose_sampler("raytrace", "interval", &error)) << error;
}

TEST(Interval, IsRightForAnyRectangleRateAndEffect) {
    GridMaker maker;
    add_squares(maker, 18, 3);
    add_squares(maker, 6, 1);
    for (const auto& [nx, ny] : {std::pair{1, 1}, {2, 1}, {2, 2}, {5, 3}})
        for (const bool motion : {false, true})
            for (const bool defocus : {false, true}) {
                const TestFrame frame = small_frame(nx, ny, motion, defocus);
                for (const PixelRect& pixels :
                     {PixelRect{0, 0, 64, 64}, {33, 17, 40, 22}, {70, 50, 71, 51}, {-9, -9, 70, 3}}) {
                    for (const Form& form : kIntervalForms) {
                        const auto truth = resolve(frame, maker.grids(), "bruteforce", form.pattern, pixels);
                        const auto found = resolve(frame, maker.grids(), form.method, form.pattern, pixels);
                        EXPECT_TRUE(found.hits == truth.hits)
                            << form.method << " " << nx << " x " << ny << " " << motion << defocus;
                        EXPECT_EQ(found.stats.rays, truth.stats.rays);
                    }
                }
            }
}

TEST(Interval, CountsEveryTestAtItsSample) {
    GridMaker maker;
    add_squares(maker, 40, 2);
    for (const Form& form : kIntervalForms)
        for (const bool blurred : {false, true}) {
            const auto found = resolve(small_frame(4, 4, blurred, blurred), maker.grids(), form.method,
                                       form.pattern, {8, 8, 72, 72});
            const auto sum = std::accumulate(found.heat.tests.begin(), found.heat.tests.end(), uint64_t{0});
            EXPECT_EQ(sum, found.stats.predicate_tests) << form.method;
            EXPECT_GT(found.stats.predicate_hits, 0u);
            EXPECT_GT(found.stats.nodes_visited, 0u);
        }
}

TEST(Interval, BoxesOfSlotsLeaveLittleToTest) {
    GridMaker maker;
    add_squares(maker, 40, 2);
    const TestFrame frame = small_frame(8, 8, true, true);
    for (const Form& form : kIntervalForms) {
        const auto all = resolve(frame, maker.grids(), "bruteforce", form.pattern, {0, 0, 64, 64});
        const auto found = resolve(frame, maker.grids(), form.method, form.pattern, {0, 0, 64, 64});
        EXPECT_LT(found.stats.predicate_tests, all.stats.predicate_tests / 2) << form.method;
    }
}

TEST(Interval, WhatIsStillHasOneBoxForAllSlots) {
    GridMaker maker;
    maker.add(16, 16, 1, [](int i, int j, float) { return V3f(0.1f * i - 0.8f, 0.1f * j - 0.8f, 4); });
    const auto found =
        resolve(small_frame(8, 8, true, false), maker.grids(), "interval", "interval", {50, 20, 114, 84});
    EXPECT_GT(found.stats.predicate_hits, 0u);
    EXPECT_EQ(found.stats.nodes_visited, 256u);
}

TEST(Interval, CullingSkipsWhatLiesBehind) {
    GridMaker maker;
    for (const float z : {9.0f, 8.0f, 7.0f, 2.0f})
        maker.add(16, 16, 2, [=](int i, int j, float t) { return V3f(i - 8 + t, j - 8 + t, z); });
    const TestFrame frame = small_frame(4, 4, true, true);
    const auto plain = resolve(frame, maker.grids(), "interval", "interval", {30, 30, 94, 94});
    const auto culled = resolve(frame, maker.grids(), "interval:cull=on", "interval", {30, 30, 94, 94});
    EXPECT_TRUE(plain.hits == culled.hits);
    EXPECT_LT(culled.stats.predicate_tests, plain.stats.predicate_tests / 2);
}

/// Front to back is not the order of ids: what ties with all that has been found may still come first.
TEST(Interval, CullingLeavesTiesToTheSmallerId) {
    GridMaker maker;
    maker.add(8, 8, 1, [](int i, int j, float) { return V3f(2.0f * i - 8, 2.0f * j - 8, 4); });
    maker.add(8, 8, 1, [](int i, int j, float) {
        return V3f(2.0f * i - 8, 2.0f * j - 8, i == 8 && j == 8 ? 3.5f : 4.0f);
    });
    for (const bool defocus : {false, true}) {
        const TestFrame frame = small_frame(4, 4, false, defocus);
        const auto found = resolve(frame, maker.grids(), "interval:cull=on", "interval", {30, 30, 94, 94});
        ASSERT_FALSE(found.hits.hits.empty());
        for (const Hit& hit : found.hits.hits) ASSERT_EQ(MicropolygonId::unpack(hit.id).grid, 0u);
    }
}

}  // namespace
}  // namespace trapeze
