#include "accel/moving/swept_boxes.h"

#include <gtest/gtest.h>

#include <cmath>

#include "core/grids_harness.h"
#include "core/noise_harness.h"

namespace trapeze {
namespace {

using testing::GridMaker;
using testing::Noise;

/// Sheets that swing, of several numbers of keys; one of them reaches for infinity.
GridMaker swinging_sheets(std::initializer_list<int> key_counts, bool with_infinite) {
    GridMaker maker;
    Noise noise;
    for (const int keys : key_counts) {
        const V3f at = noise.point(9), swing = noise.point(3);
        maker.add(5, 3, keys, [=](int i, int j, float t) {
            return at + V3f(static_cast<float>(i), static_cast<float>(j), .3f * static_cast<float>(i * j)) +
                   swing * std::sin(4 * t);
        });
    }
    if (with_infinite)
        maker.add(2, 2, 2, [](int i, int j, float t) {
            return V3f(1e30f * static_cast<float>(i), static_cast<float>(j), t);
        });
    return maker;
}

/// Corners of a micropolygon at any time lie in its box at that time, and in that of its whole way.
void expect_held(const Grids& grids, const SweptBoxes& boxes, float slack) {
    for (size_t i = 0; i < boxes.size(); ++i) {
        const MicropolygonId& id = boxes.id(i);
        const Grid& grid = grids.grids[id.grid];
        EXPECT_EQ(boxes.keys(i).size(), grid.key_count);
        for (const float time : {0.f, .1f, .25f, .5f, .77f, 1.f}) {
            Box3f box = boxes.at(i, time), swept = boxes.swept(i);
            box.min -= V3f(slack), box.max += V3f(slack), swept.min -= V3f(slack), swept.max += V3f(slack);
            for (int c = 0; c < 4; ++c) {
                const V3f p = grid.vertex(id.u + (c & 1), id.v + (c >> 1), time);
                EXPECT_TRUE(box.intersects(p)) << i << " at " << time;
                EXPECT_TRUE(swept.intersects(p)) << i;
            }
        }
    }
}

TEST(SweptBoxes, HoldMicropolygonsAtAllTimes) {
    for (const auto& keys : {std::initializer_list<int>{1, 2, 3, 5, 17}, {2, 2, 2}}) {
        const GridMaker maker = swinging_sheets(keys, false);
        const SweptBoxes grown(maker.grids(), summaries_along_axes(maker.grids())), plain(maker.grids());
        EXPECT_EQ(grown.size(), 15 * keys.size());
        EXPECT_EQ(plain.size(), 15 * keys.size());
        expect_held(maker.grids(), grown, 0);
        expect_held(maker.grids(), plain, 1e-5f);
    }
}

TEST(SweptBoxes, AtKeysAreNoLargerThanTheirMicropolygons) {
    const GridMaker maker = swinging_sheets({1, 3, 5}, false);
    const SweptBoxes boxes(maker.grids());
    for (size_t i = 0; i < boxes.size(); ++i) {
        const MicropolygonId& id = boxes.id(i);
        const Grid& grid = maker.grids().grids[id.grid];
        EXPECT_EQ(boxes.index_of(id, grid.shape), i);
        Box3f first;
        for (int c = 0; c < 4; ++c) first.extendBy(grid.vertex(id.u + (c & 1), id.v + (c >> 1), 0));
        EXPECT_EQ(boxes.keys(i)[0].min, first.min);
        EXPECT_EQ(boxes.keys(i)[0].max, first.max);
    }
}

/// Where grids differ in keys places are kept, else a product finds them: the same micropolygons by either.
TEST(SweptBoxes, ArePlacedInTheOrderOfTheirNumbers) {
    for (const auto& keys : {std::initializer_list<int>{2, 1, 17, 1, 3}, {1, 1}, {2, 2}, {5, 5}}) {
        const GridMaker maker = swinging_sheets(keys, false);
        const SweptBoxes boxes(maker.grids());
        const bool differ = *keys.begin() != *(keys.end() - 1);
        EXPECT_EQ(boxes.places().size(), differ ? boxes.size() : 0);
        for (size_t i = 0; i < boxes.size(); ++i) {
            const size_t place = boxes.place(i);
            if (differ) {
                EXPECT_EQ(place, boxes.places()[i]);
            }
            if (i > 0) {
                EXPECT_GT(place, boxes.place(i - 1));
            }
            EXPECT_EQ(boxes.id_at(place).packed(), boxes.id(i).packed());
            EXPECT_EQ(boxes.keys_at(place).data(), boxes.keys(i).data());
        }
    }
}

TEST(SweptBoxes, OfWhatCannotBeBounded) {
    const GridMaker maker = swinging_sheets({2, 1}, true);
    const SweptBoxes bounded(maker.grids(), summaries_along_axes(maker.grids())), all(maker.grids());
    EXPECT_EQ(bounded.size(), 30u);
    ASSERT_EQ(all.size(), 34u);
    for (size_t i = 30; i < 34; ++i) EXPECT_FALSE(std::isfinite(all.keys(i)[0].max.x));
    EXPECT_TRUE(std::isfinite(all.keys(29)[0].max.x));
}

}  // namespace
}  // namespace trapeze
