/// What an earlier bundle has left in the scratch changes nothing.
#include "accel/wide/bundle_scratch.h"

#include <gtest/gtest.h>

#include <limits>

#include "sample/frame_harness.h"
#include "sample/raytrace/wide_raytrace.h"

namespace trapeze {
namespace {

using testing::GridMaker;
using testing::TestFrame;

/// All that rays leave, of a value: past the end of the next rays it is still there.
void poison(ActiveRays& active, float value) {
    for (size_t i = 0; i < ActiveRays::kRoom; ++i) {
        active.ox[i] = active.oy[i] = active.ux[i] = active.uy[i] = active.local[i] = active.limit[i] = value;
        for (int k = 0; k < 3; ++k) active.inverse[k][i] = active.offset[k][i] = value;
        active.ray[i] = 0;
    }
}

SampleStats resolve(const TestFrame& frame, const Grids& grids, SampleScratch& scratch, HitBuffer& hits) {
    std::string error;
    const auto sampler = choose_sampler("raytrace", "", &error);
    const auto pattern = sampler->make_pattern(frame.context);
    const auto visibility = sampler->prepare(frame.context, grids);
    SampleTile samples;
    pattern->make_tile({0, 0, 16, 16}, samples);
    SampleStats stats;
    visibility->resolve(samples, hits, scratch, stats);
    return stats;
}

TEST(BundleScratch, WhatIsLeftInItChangesNothing) {
    constexpr float kInfinite = std::numeric_limits<float>::infinity();
    for (const bool motion : {false, true}) {
        for (const bool defocus : {false, true}) {
            const TestFrame frame(16, 16, 3, motion, defocus);
            GridMaker maker;
            for (int k = 0; k < 5; ++k)
                maker.add(9, 9, motion ? 2 : 1, [k](int i, int j, float t) {
                    return V3f(0.2f * i - 1 + 0.1f * k + t, 0.2f * j - 1 - 0.2f * k, 4 + k - 0.3f * i);
                });
            SampleScratch clean;
            poison(clean.own.of<WideScratch>().tracing->active, 0);
            HitBuffer clean_hits;
            const SampleStats wanted = resolve(frame, maker.grids(), clean, clean_hits);
            for (const float value :
                 {kInfinite, -kInfinite, std::numeric_limits<float>::quiet_NaN(), 1e38f}) {
                SampleScratch scratch;
                poison(scratch.own.of<WideScratch>().tracing->active, value);
                HitBuffer hits;
                const SampleStats stats = resolve(frame, maker.grids(), scratch, hits);
                EXPECT_EQ(hits, clean_hits) << value;
                EXPECT_EQ(stats.predicate_tests, wanted.predicate_tests) << value;
            }
        }
    }
}

}  // namespace
}  // namespace trapeze
