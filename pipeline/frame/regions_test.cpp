#include "pipeline/frame/regions.h"

#include <gtest/gtest.h>

#include <set>

#include "core/samples.h"

namespace trapeze {
namespace {

std::vector<SubpatchInfo> scattered_subpatches(int count) {
    std::vector<SubpatchInfo> infos(count);
    for (int i = 0; i < count; ++i) {
        const int x = (i * 37) % 300 - 10, y = (i * 53) % 200 - 10;
        infos[i].bound = {x, y, x + 5 + i % 40, y + 5 + i % 30};
        infos[i].shape = {16, 16};
    }
    return infos;
}

TEST(Regions, CoverThePictureOnceAndKnowTheirSubpatches) {
    const PixelRect picture{-2, -2, 322, 202};
    const auto infos = scattered_subpatches(500);
    for (const int wanted : {1, 3, 40}) {
        const auto regions = split_into_regions(picture, infos, {~size_t{0}, wanted});
        EXPECT_EQ(static_cast<int>(regions.size()), wanted);
        std::set<std::pair<int, int>> seen;
        for (const Region& region : regions) {
            for (int y = region.pixels.y0; y < region.pixels.y1; ++y)
                for (int x = region.pixels.x0; x < region.pixels.x1; ++x)
                    EXPECT_TRUE(seen.insert({x, y}).second) << x << " " << y;
            EXPECT_TRUE(std::is_sorted(region.subpatches.begin(), region.subpatches.end()));
            const std::set<uint32_t> listed(region.subpatches.begin(), region.subpatches.end());
            for (uint32_t i = 0; i < infos.size(); ++i)
                EXPECT_EQ(listed.count(i) == 1, !intersection(infos[i].bound, region.pixels).empty());
        }
        EXPECT_EQ(seen.size(), static_cast<size_t>(picture.width()) * picture.height());
    }
}

TEST(Regions, InnerBordersLieOnTiles) {
    const PixelRect picture{-2, -2, 322, 202};
    for (const Region& region : split_into_regions(picture, {}, {~size_t{0}, 17}))
        for (const auto& [edge, low, high] : {std::tuple{region.pixels.x0, -2, 322},
                                              {region.pixels.x1, -2, 322},
                                              {region.pixels.y0, -2, 202},
                                              {region.pixels.y1, -2, 202}})
            EXPECT_TRUE(edge == low || edge == high || edge % kTileSide == 0) << edge;
}

TEST(Regions, SplitUntilTheyFitTheBudget) {
    const auto infos = scattered_subpatches(2000);
    const size_t whole = split_into_regions({0, 0, 320, 200}, infos, {~size_t{0}, 1})[0].estimated_bytes;
    const auto regions = split_into_regions({0, 0, 320, 200}, infos, {whole / 4, 1});
    EXPECT_GT(regions.size(), 4u);
    for (const Region& region : regions) EXPECT_LE(region.estimated_bytes, whole / 4);
}

/// A method that takes more has smaller regions.
TEST(Regions, WhatTheMethodTakesCounts) {
    auto infos = scattered_subpatches(2000);
    for (size_t i = 0; i < infos.size(); i += 7) infos[i].key_count = 5;
    const PixelRect pixels{0, 0, 320, 200};
    const auto region_with = [&](const BuildMemory& build) {
        return split_into_regions(pixels, infos, {.bytes = ~size_t{0}, .build = build})[0];
    };
    const auto whole_with = [&](const BuildMemory& build) { return region_with(build).estimated_bytes; };
    const std::vector<uint32_t> seen = region_with({}).subpatches;
    size_t micropolygons = 0, segments = 0, most = 0;
    for (const uint32_t index : seen) {
        const SubpatchInfo& info = infos[index];
        const auto count = static_cast<size_t>(info.shape.micropolygon_count());
        micropolygons += count;
        const auto own = static_cast<size_t>(std::max(1, info.key_count - 1));
        segments += count * own, most = std::max(most, own);
    }
    const size_t nothing = whole_with({0, 0, 0, 0});
    EXPECT_EQ(whole_with({3, 5, 7, 11}) - nothing, 3 * micropolygons + 5 * segments + 7 * seen.size() + 11);
    EXPECT_EQ(whole_with({0, 0, 0, 0, 13}) - nothing, 13 * micropolygons * most);
    const size_t budget = whole_with({});
    EXPECT_EQ(split_into_regions(pixels, infos, {.bytes = budget}).size(), 1u);
    EXPECT_GT(split_into_regions(pixels, infos, {.bytes = budget, .build = {2000, 0, 0, 0}}).size(), 1u);
}

TEST(Regions, AnImpossibleBudgetEndsAtSingleTiles) {
    const auto infos = scattered_subpatches(50);
    const auto regions = split_into_regions({0, 0, 64, 64}, infos, {0, 1});
    for (const Region& region : regions) EXPECT_LE(region.pixels.width() * region.pixels.height(), 4096);
    EXPECT_GE(regions.size(), 8u);
}

TEST(Regions, VariablesOfVerticesCountInTheEstimate) {
    SubpatchInfo subpatch;
    subpatch.shape = {16, 16};
    subpatch.key_count = 1;
    EXPECT_EQ(estimated_bytes(subpatch, {.aov_channels = 5}) - estimated_bytes(subpatch, {}),
              5u * 17 * 17 * sizeof(float));
}

}  // namespace
}  // namespace trapeze
