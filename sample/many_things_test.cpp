/// Agreement beyond the sizes of agreement_test.cpp: thousands of grids, tiles of any side, hundreds of
/// samples a pixel.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <random>

#include "sample/every_method_harness.h"
#include "sample/frame_harness.h"
#include "sample/visibility.h"

namespace trapeze {
namespace {

using testing::every_method;
using testing::GridMaker;
using testing::TestFrame;

/// Bent sheets of up to side x side micropolygons before the camera, every third of them not opaque.
void add_sheets(GridMaker& maker, int count, int side, float size, int keys) {
    std::mt19937 engine(11);
    const auto noise = [&](float from, float to) {
        return std::uniform_real_distribution<float>(from, to)(engine);
    };
    for (int n = 0; n < count; ++n) {
        maker.opaque = n % 3 != 0;
        const V3f at(noise(-4, 4), noise(-3, 3), noise(2, 9));
        const V3f shift(noise(-1, 1), noise(-1, 1), noise(-0.5f, 0.5f));
        const float tilt = noise(-1, 1);
        const int nu = 1 + static_cast<int>(engine() % static_cast<uint32_t>(side)), nv = 1 + n % side;
        maker.add(nu, nv, keys, [&](int i, int j, float t) {
            const auto u = size * static_cast<float>(i), v = size * static_cast<float>(j);
            return at + V3f(u, v, tilt * u + 0.1f * std::sin(9 * v)) + shift * (t * t);
        });
    }
}

/// What the samples of a rectangle of pixels see, by a method and the pattern that it was made for (or
/// another).
struct ResolvedRectangle {
    SampleTile samples;
    HitBuffer hits;
    SampleStats stats;
};

class Prepared {
  public:
    Prepared(const TestFrame& frame, const Grids& grids, std::string_view method, std::string_view pattern) {
        std::string error;
        const auto sampler = choose_sampler(method, pattern, &error);
        EXPECT_TRUE(sampler) << error;
        pattern_ = sampler->make_pattern(frame.context);
        visibility_ = sampler->prepare(frame.context, grids);
    }
    void resolve(const PixelRect& pixels, ResolvedRectangle& result) {
        pattern_->make_tile(pixels, result.samples);
        result.stats = {};
        visibility_->resolve(result.samples, result.hits, scratch_, result.stats);
    }

  private:
    std::unique_ptr<SamplePattern> pattern_;
    std::unique_ptr<Visibility> visibility_;
    SampleScratch scratch_;
};

/// How many samples see other things in `a` than in `b`.
size_t differing(const ResolvedRectangle& a, const ResolvedRectangle& b) {
    EXPECT_EQ(a.hits.size(), b.hits.size());
    size_t count = 0;
    for (size_t s = 0; s < a.hits.size(); ++s) count += !std::ranges::equal(a.hits.of(s), b.hits.of(s));
    return count;
}

TEST(ManyThings, ThousandsOfGridsAreSeenAsByBruteForce) {
    for (const int keys : {1, 2}) {
        const TestFrame frame(48, 40, 1, keys > 1, true);
        GridMaker maker;
        add_sheets(maker, 5000, 4, 0.05f, keys);
        ASSERT_GT(maker.grids().grids.size(), 4096u);
        const PixelRect all{0, 0, 48, 40};
        std::map<std::string, ResolvedRectangle> truths;
        for (const auto& [method, pattern] : every_method({.few_numbers = true})) {
            ResolvedRectangle& truth = truths[pattern];
            if (truth.hits.size() == 0)
                Prepared(frame, maker.grids(), "bruteforce", pattern).resolve(all, truth);
            uint32_t last = 0;
            for (const Hit& hit : truth.hits.hits) last = std::max(last, MicropolygonId::unpack(hit.id).grid);
            EXPECT_GT(last, 4096u);
            ResolvedRectangle found;
            Prepared(frame, maker.grids(), method, pattern).resolve(all, found);
            EXPECT_EQ(differing(found, truth), 0u) << method;
        }
    }
}

/// visibility.h: any size of tile is right. Each sample sees in any tile what it sees in the tiles of the
/// program.
TEST(ManyThings, TilesOfAnySideShowTheSame) {
    const TestFrame frame(150, 140, 1, true, true);
    GridMaker maker;
    add_sheets(maker, 60, 16, 0.08f, 2);
    const PixelRect all{-3, -3, 153, 143};
    std::map<std::string, ResolvedRectangle> truths;
    for (const auto& [method, pattern] : every_method({.one_of_each_tree = true})) {
        ResolvedRectangle& whole = truths[pattern];
        if (whole.hits.size() == 0) Prepared(frame, maker.grids(), "bruteforce", pattern).resolve(all, whole);
        Prepared tested(frame, maker.grids(), method, pattern);
        ResolvedRectangle tile;
        const auto spp = static_cast<size_t>(whole.samples.samples_per_pixel);
        ASSERT_GT(whole.hits.hits.size(), 5000u);
        for (const int side : {7, 16, 32, 48, 64, 100, 200}) {
            size_t wrong = 0;
            for (int y = all.y0; y < all.y1; y += side)
                for (int x = all.x0; x < all.x1; x += side) {
                    const PixelRect pixels{x, y, std::min(x + side, all.x1), std::min(y + side, all.y1)};
                    tested.resolve(pixels, tile);
                    for (int py = pixels.y0; py < pixels.y1; ++py)
                        for (int px = pixels.x0; px < pixels.x1; ++px)
                            for (size_t s = 0; s < spp; ++s)
                                wrong += !std::ranges::equal(
                                    tile.hits.of(tile.samples.first_of_pixel(px, py) + s),
                                    whole.hits.of(whole.samples.first_of_pixel(px, py) + s));
                }
            EXPECT_EQ(wrong, 0u) << method << " in tiles of " << side;
        }
    }
}

/// 13 x 13 samples a pixel, as in the paper's tables: 169 slots of INTERVAL, 676 of which pairing is
/// shuffled, and 2704 tuples of INTERLEAVEUVT k = 4.
TEST(ManyThings, HundredsOfSlotsAndThousandsOfTuplesAreRight) {
    const TestFrame frame(24, 20, 13, true, true);
    GridMaker maker;
    add_sheets(maker, 12, 12, 0.2f, 2);
    const PixelRect pixels{3, 2, 21, 18};
    std::map<std::string, ResolvedRectangle> truths;
    for (const auto& [method, pattern] : every_method({.one_of_each_tree = true})) {
        ResolvedRectangle& truth = truths[pattern];
        if (truth.hits.size() == 0)
            Prepared(frame, maker.grids(), "bruteforce", pattern).resolve(pixels, truth);
        ASSERT_GT(truth.hits.hits.size(), 5000u);
        ResolvedRectangle found;
        Prepared(frame, maker.grids(), method, pattern).resolve(pixels, found);
        EXPECT_EQ(differing(found, truth), 0u) << method;
    }
}

/// A micropolygon that all tuples can see is set up in each of them.
TEST(ManyThings, TuplesAreAsManyAsTheirNumbersSay) {
    const TestFrame frame(24, 20, 13, true, true);
    GridMaker maker;
    maker.add(3, 5, 2, [](int i, int j, float t) { return V3f(0.1f * i + 0.1f * t, 0.1f * j, 4); });
    ResolvedRectangle found;
    Prepared(frame, maker.grids(), "interleaveuvt:k=4", "").resolve({0, 0, 24, 20}, found);
    EXPECT_EQ(found.samples.samples_per_pixel, 169);
    EXPECT_EQ(found.stats.nodes_visited, 15u * 2704);
}

}  // namespace
}  // namespace trapeze
