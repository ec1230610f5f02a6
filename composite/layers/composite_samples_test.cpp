#include "composite/layers/composite_samples.h"

#include <gtest/gtest.h>

#include <array>
#include <bit>
#include <random>
#include <vector>

#include "composite/layers/resolve_layers.h"
#include "core/simd/targets_harness.h"

namespace trapeze {
namespace {

using testing::for_each_target;

/// Samples of 0 to `most` hits on constant grids, which show what `opacity` and `color` give: from those that
/// leave no trace to those that hide all.
struct Pile {
    Grids grids;
    HitBuffer hits;
    SampleTile samples;

    Pile(size_t count, int most, uint32_t seed) : random(seed) {
        grids.arenas.emplace_back();
        for (uint32_t n = 0; n < 40; ++n) {
            Grid grid;
            grid.opaque = n % 5 == 0, grid.float_colors = true, grid.primitive = 100 + n;
            grids.arenas[0].allocate(grid);
            for (int c = 0; c < 3 * grid.shape.vertex_count(); ++c) {
                grid.full_colors()[c] = n % 7 == 3 ? 0 : between(0, 1);
                if (grid.opaque) continue;
                // Some are above 1 or below 0, which count as these.
                grid.full_colors()[3 * grid.shape.vertex_count() + c] = n % 7 == 3   ? 0
                                                                        : n % 4 == 1 ? between(-1, 2)
                                                                        : n % 4 == 2 ? 1
                                                                                     : between(0, 1);
            }
            grids.grids.push_back(grid);
        }
        samples.resize(count);
        hits.first.push_back(0);
        for (size_t s = 0; s < count; ++s) {
            for (int n = std::uniform_int_distribution(0, most)(random); n > 0; --n) {
                const auto grid = std::uniform_int_distribution<uint32_t>(0, 39)(random);
                hits.hits.push_back({between(1, 9), MicropolygonId{grid}.packed()});
            }
            hits.first.push_back(static_cast<uint32_t>(hits.hits.size()));
        }
    }
    float between(float low, float high) { return std::uniform_real_distribution<float>(low, high)(random); }

    std::mt19937 random;
};

TEST(CompositeSamples, AreThoseOfEachSampleAloneOnAllTargets) {
    for (const size_t count : {1, 7, 16, 64, 100})
        for (const int most : {0, 1, 3, 30}) {
            const Pile pile(count, most, static_cast<uint32_t>(count) + static_cast<uint32_t>(most));
            for_each_target([&] {
                HitLayers layers;
                layers.interpolate(pile.samples, pile.hits, 0, count, pile.grids);
                ASSERT_TRUE(layers.all_plain());
                const float* planes[kLayerPlanes];
                for (size_t k = 0; k < kLayerPlanes; ++k) planes[k] = layers.plane(k);
                std::array<std::vector<float>, 4> colors;
                for (auto& plane : colors) plane.resize(count);
                std::vector<int32_t> nearest(count);
                float* const rgba[4] = {colors[0].data(), colors[1].data(), colors[2].data(),
                                        colors[3].data()};
                composite_samples({pile.hits.first.data(), count, planes, layers.places().data()}, rgba,
                                  nearest.data());
                for (size_t s = 0; s < count; ++s) {
                    const SampleColor alone =
                        resolve_layers(pile.samples.rays[s], pile.hits.of(s), pile.grids);
                    for (size_t c = 0; c < 4; ++c)
                        EXPECT_EQ(std::bit_cast<uint32_t>(colors[c][s]),
                                  std::bit_cast<uint32_t>(alone.rgba[c]))
                            << s << ' ' << c;
                    const float depth =
                        nearest[s] < 0 ? kInfinity : pile.hits.hits[static_cast<size_t>(nearest[s])].depth;
                    EXPECT_EQ(depth, alone.depth) << s;
                }
            });
        }
}

}  // namespace
}  // namespace trapeze
