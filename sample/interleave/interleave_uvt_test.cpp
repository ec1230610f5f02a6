#include <gtest/gtest.h>

#include <cmath>

#include "sample/frame_harness.h"
#include "sample/visibility.h"

namespace trapeze {
namespace {

using testing::GridMaker;
using testing::TestFrame;

/// A wavy sheet, all of it in the picture, that moves sideways; 2 x 2 grids.
void add_sheet(GridMaker& maker, float shift, int side) {
    for (int part = 0; part < 4; ++part)
        maker.add(side, side, shift == 0 ? 1 : 2, [=](int i, int j, float t) {
            const float u = static_cast<float>(i + side * (part & 1)) / static_cast<float>(side) - 1,
                        v = static_cast<float>(j + side * (part >> 1)) / static_cast<float>(side) - 1;
            return V3f(1.5f * u + shift * (t - 0.5f), 1.2f * v, 4 + 0.3f * std::sin(7 * u + 5 * v));
        });
}

struct ResolvedTile {
    SampleTile samples;
    HitBuffer hits;
    SampleStats stats;
    SampleScratch scratch;
};

void resolve(const TestFrame& frame, const Grids& grids, std::string_view method,
             std::string_view pattern_name, const PixelRect& pixels, ResolvedTile& result) {
    std::string error;
    const auto sampler = choose_sampler(method, pattern_name, &error);
    ASSERT_TRUE(sampler) << error;
    const auto pattern = sampler->make_pattern(frame.context);
    const auto visibility = sampler->prepare(frame.context, grids);
    pattern->make_tile(pixels, result.samples);
    result.stats = {};
    visibility->resolve(result.samples, result.hits, result.scratch, result.stats);
}

class InterleaveUvt : public ::testing::TestWithParam<int> {
  protected:
    std::string k() const { return "k=" + std::to_string(GetParam()); }
};

TEST_P(InterleaveUvt, AnyRectangleIsRight) {
    const TestFrame frame(90, 70, 2, true, true);
    GridMaker maker;
    add_sheet(maker, 1, 12);
    ResolvedTile truth, found;
    for (const PixelRect& pixels :
         {PixelRect{0, 0, 90, 70}, PixelRect{-5, -3, 62, 66}, PixelRect{13, 7, 14, 8},
          PixelRect{31, 30, 36, 67}, PixelRect{-200, -200, -190, -190}}) {
        resolve(frame, maker.grids(), "bruteforce", "interleaved:" + k(), pixels, truth);
        resolve(frame, maker.grids(), "interleaveuvt:" + k(), "", pixels, found);
        EXPECT_TRUE(found.hits == truth.hits) << pixels.x0 << " " << pixels.x1;
    }
}

/// Every tuple sets up all micropolygons, blurred or not.
TEST_P(InterleaveUvt, SetUpsDoNotDependOnBlur) {
    const PixelRect all{0, 0, 90, 70};
    std::vector<uint64_t> nodes;
    for (const float shift : {0.0f, 0.02f, 0.5f}) {
        GridMaker maker;
        add_sheet(maker, shift, 12);
        const TestFrame frame(90, 70, 2, true, true);
        ResolvedTile found;
        resolve(frame, maker.grids(), "interleaveuvt:" + k(), "", all, found);
        nodes.push_back(found.stats.nodes_visited);
    }
    const auto micropolygons = uint64_t{4 * 12 * 12},
               tuples = static_cast<uint64_t>(4 * GetParam() * GetParam());
    for (const uint64_t n : nodes) EXPECT_EQ(n, micropolygons * tuples);
}

/// Boxes at a tuple's time and lens point are tight: few tests miss.
TEST_P(InterleaveUvt, MostTestsHit) {
    GridMaker maker;
    add_sheet(maker, 2, 16);
    const TestFrame frame(90, 70, 4, true, true);
    ResolvedTile found;
    resolve(frame, maker.grids(), "interleaveuvt:" + k(), "", {0, 0, 90, 70}, found);
    EXPECT_GT(found.stats.predicate_hits, 0u);
    EXPECT_LT(found.stats.predicate_tests, 2 * found.stats.predicate_hits);
}

TEST_P(InterleaveUvt, CullingSavesTestsBehindWalls) {
    GridMaker maker;
    for (int layer = 0; layer < 5; ++layer)
        for (int part = 0; part < 9; ++part)
            maker.add(16, 16, 1, [=](int i, int j, float) {
                return V3f(0.25f * static_cast<float>(i + 16 * (part % 3) - 24),
                           0.25f * static_cast<float>(j + 16 * (part / 3) - 24),
                           8.0f - static_cast<float>(layer));
            });
    const TestFrame frame(64, 64, 2, false, true);
    ResolvedTile all, culled;
    resolve(frame, maker.grids(), "interleaveuvt:" + k(), "", {0, 0, 64, 64}, all);
    resolve(frame, maker.grids(), "interleaveuvt:cull=on," + k(), "", {0, 0, 64, 64}, culled);
    EXPECT_TRUE(culled.hits == all.hits);
    EXPECT_LT(culled.stats.predicate_tests, all.stats.predicate_tests / 3);
    EXPECT_LT(culled.stats.nodes_visited, all.stats.nodes_visited / 2);
}

TEST_P(InterleaveUvt, HeatAddsUpToTheCounts) {
    GridMaker maker;
    add_sheet(maker, 1, 12);
    const TestFrame frame(90, 70, 2, true, true);
    const PixelRect pixels{3, 5, 70, 60};
    SampleHeat heat;
    heat.tests.assign(static_cast<size_t>(pixels.width()) * pixels.height() * 4, 0);
    heat.nodes = heat.tests;
    ResolvedTile found;
    found.scratch.heat = &heat;
    resolve(frame, maker.grids(), "interleaveuvt:" + k(), "", pixels, found);
    uint64_t sum = 0;
    for (size_t s = 0; s < heat.tests.size(); ++s) {
        sum += heat.tests[s];
        ASSERT_GE(heat.tests[s], found.hits.of(s).size());
    }
    EXPECT_EQ(sum, found.stats.predicate_tests);
}

INSTANTIATE_TEST_SUITE_P(Sides, InterleaveUvt, ::testing::Values(1, 2, 4));

}  // namespace
}  // namespace trapeze
