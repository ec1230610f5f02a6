#include "composite/film/matte_sums.h"

#include <gtest/gtest.h>

#include "composite/mattes/murmur_hash.h"

namespace trapeze {
namespace {

/// A scene of primitives p0, p1 and so on, of materials m0 and m1 by turns.
Scene scene_of_many(int count) {
    Scene scene;
    for (int i = 0; i < count; ++i) {
        auto attributes = std::make_shared<Attributes>();
        auto surface = std::make_shared<ShaderInstance>();
        attributes->name = "p" + std::to_string(i);
        surface->name = i % 2 ? "m1" : "m0";
        attributes->surface = surface;
        scene.primitives.emplace_back().attributes = attributes;
    }
    return scene;
}

TEST(RankMattes, TheGreatestComeFirstAndTheRestIsTold) {
    const Diagnostics sources;
    const Scene scene = scene_of_many(8);
    const MatteKeys keys(scene, {MatteLayer::Object, MatteLayer::Material}, sources);
    MattePixel pixel;
    pixel.weight = 2;
    const float covered[] = {.1f, .4f, .2f, .3f, .05f, .15f, .25f, .35f};
    for (uint32_t i = 0; i < 8; ++i)
        pixel.add(keys.key_of(i), covered[i] / 2), pixel.add(keys.key_of(i), covered[i] / 2);
    std::vector<float> ranks(2 * kMatteFloats, -1);
    EXPECT_NEAR(rank_mattes(pixel, keys, ranks.data()), (.1f + .05f) / 2, 1e-6f);
    const uint32_t order[] = {1, 7, 3, 6, 2, 5};
    for (size_t rank = 0; rank < kMatteRanks; ++rank) {
        EXPECT_EQ(ranks[2 * rank], matte_id(murmur_hash_3("p" + std::to_string(order[rank]))));
        EXPECT_NEAR(ranks[2 * rank + 1], covered[order[rank]] / 2, 1e-6f);
    }
    const float* const materials = &ranks[kMatteFloats];
    EXPECT_EQ(materials[0], matte_id(murmur_hash_3("m1")));
    EXPECT_NEAR(materials[1], .6f, 1e-6f);
    EXPECT_EQ(materials[2], matte_id(murmur_hash_3("m0")));
    EXPECT_NEAR(materials[3], .3f, 1e-6f);
    for (int i = 4; i < kMatteFloats; ++i) EXPECT_EQ(materials[i], 0);
}

TEST(RankMattes, EqualOnesAreInTheOrderOfTheirIdsAndNothingIsNothing) {
    const Diagnostics sources;
    const Scene scene = scene_of_many(3);
    const MatteKeys keys(scene, {MatteLayer::Object}, sources);
    MattePixel forwards, backwards;
    forwards.weight = backwards.weight = 1;
    for (uint32_t i = 0; i < 3; ++i) {
        forwards.add(keys.key_of(i), .25f);
        backwards.add(keys.key_of(2 - i), .25f);
    }
    std::vector<float> a(kMatteFloats), b(kMatteFloats), c(kMatteFloats, 1);
    rank_mattes(forwards, keys, a.data()), rank_mattes(backwards, keys, b.data());
    EXPECT_EQ(a, b);
    EXPECT_EQ(rank_mattes({}, keys, c.data()), 0);
    EXPECT_EQ(c, std::vector<float>(kMatteFloats, 0.0f));
}

}  // namespace
}  // namespace trapeze
