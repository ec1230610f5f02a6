#include "sample/rasterize/tile_bins.h"

#include <gtest/gtest.h>
#include <tbb/task_arena.h>

#include <random>

#include "sample/frame_harness.h"

namespace trapeze {
namespace {

using testing::GridMaker;
using testing::TestFrame;

/// Small moving squares all over the picture and around it, some through the near plane, some behind.
GridMaker scattered_squares(int count) {
    std::mt19937 engine(3);
    const auto noise = [&](float from, float to) {
        return std::uniform_real_distribution<float>(from, to)(engine);
    };
    GridMaker maker;
    for (int n = 0; n < count; ++n) {
        const V3f at(noise(-8, 8), noise(-8, 8), noise(-1, 12)), shift(noise(-1, 1), noise(-1, 1), 0);
        maker.add(2, 2, 2,
                  [&](int i, int j, float t) { return at + V3f(0.2f * i, 0.2f * j, 0) + shift * t; });
    }
    return maker;
}

std::vector<uint32_t> scan(const TileBins& bins, size_t grid_count, const PixelRect& pixels) {
    std::vector<uint32_t> found;
    for (uint32_t grid = 0; grid < grid_count; ++grid)
        if (!pixels_within(bins.box(grid), pixels).empty()) found.push_back(grid);
    return found;
}

TEST(TileBins, FindWhatLookingAtEveryBoxFinds) {
    TestFrame frame(150, 90, 2, true, true);
    frame.options.crop_window = {0.2f, 0.9f, 0.1f, 1};
    frame.update();
    const GridMaker maker = scattered_squares(500);
    const size_t count = maker.grids().grids.size();
    for (const int side : {16, 32, 64, 1024}) {
        const TileBins bins(frame.context.camera, maker.grids(), side);
        std::vector<uint32_t> found{7};
        size_t total = 0;
        for (const PixelRect& pixels : {PixelRect{30, 9, 62, 41},
                                        {-20, -20, -3, 5},
                                        {140, 80, 170, 130},
                                        {50, 50, 51, 51},
                                        {0, 0, 150, 90},
                                        {-2000, 40, 3000, 42},
                                        {900, 900, 901, 901},
                                        {63, 63, 65, 65}}) {
            bins.find(pixels, found);
            EXPECT_EQ(found, scan(bins, count, pixels)) << side;
            total += found.size();
        }
        EXPECT_GT(total, 100u);
        bins.find({5, 5, 5, 9}, found);
        EXPECT_TRUE(found.empty());
    }
}

TEST(TileBins, AreTheSameForAnyNumberOfThreads) {
    const TestFrame frame(150, 90, 2, true, true);
    const GridMaker maker = scattered_squares(500);
    std::vector<std::vector<uint32_t>> found(2);
    std::vector<size_t> bytes;
    for (size_t n = 0; n < 2; ++n)
        tbb::task_arena(n == 0 ? 1 : 5).execute([&] {
            const TileBins bins(frame.context.camera, maker.grids(), 32);
            bins.find({10, 10, 60, 60}, found[n]);
            bytes.push_back(bins.bytes());
        });
    EXPECT_FALSE(found[0].empty());
    EXPECT_EQ(found[0], found[1]);
    EXPECT_EQ(bytes[0], bytes[1]);
    EXPECT_GT(bytes[0], 500 * sizeof(RasterBox));
}

TEST(TileBins, OfNoGridsFindNothing) {
    const TestFrame frame(16, 16, 2, false, false);
    const TileBins bins(frame.context.camera, Grids{}, 64);
    std::vector<uint32_t> found{7};
    bins.find({0, 0, 16, 16}, found);
    EXPECT_TRUE(found.empty());
}

}  // namespace
}  // namespace trapeze
