#include "accel/builders/grid_pose.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "accel/builders/grid_summary.h"
#include "core/grids_harness.h"
#include "core/noise_harness.h"

namespace trapeze {
namespace {

using testing::GridMaker;
using testing::Noise;

/// Anywhere within a reach of 9; the same place each time.
V3f anywhere(int i, int j, float time01) {
    Noise noise;
    noise.engine.seed(static_cast<uint32_t>(i + 100 * j) + static_cast<uint32_t>(time01 * 4e6f));
    return noise.point(9, -5, 5);
}

/// Grids of all widths of a tile, whole and not, still and moving.
GridMaker grids_of_all_shapes() {
    GridMaker maker;
    for (const int nu : {1, 2, 3, 4, 7, 16})
        for (const int nv : {1, 4, 15})
            for (const int keys : {1, 2, 5}) maker.add(nu, nv, keys, anywhere);
    return maker;
}

void expect_boxes(const Grid& grid, int key, const GridPose& pose) {
    int count = 0;
    pose.for_each_box([&](int i, const Box3f& box) {
        EXPECT_EQ(i, count++);
        Box3f expected;
        for (int c = 0; c < 4; ++c)
            expected.extendBy(
                vertex_of_key(grid, key, i % grid.shape.nu + (c & 1), i / grid.shape.nu + (c >> 1)));
        EXPECT_EQ(box.min, expected.min) << i;
        EXPECT_EQ(box.max, expected.max) << i;
    });
    EXPECT_EQ(count, grid.shape.micropolygon_count());
}

TEST(GridPose, HasTheBoxesOfCorners) {
    const GridMaker maker = grids_of_all_shapes();
    GridPose pose;
    for (const Grid& grid : maker.grids().grids)
        for (int key = 0; key < grid.key_count; ++key) {
            float largest = 0;
            for (int j = 0; j <= grid.shape.nv; ++j)
                for (int i = 0; i <= grid.shape.nu; ++i) {
                    const V3f p = vertex_of_key(grid, key, i, j);
                    for (int k = 0; k < 3; ++k) largest = std::max(largest, std::abs(p[k]));
                }
            EXPECT_EQ(pose.read(grid, key), largest);
            expect_boxes(grid, key, pose);
            pose.set(grid.shape, [&](int i, int j) { return vertex_of_key(grid, key, i, j); });
            expect_boxes(grid, key, pose);
        }
}

TEST(GridPose, TellsWhatCannotBeBounded) {
    for (const float bad :
         {std::numeric_limits<float>::quiet_NaN(), std::numeric_limits<float>::infinity(), -2e15f})
        for (const int keys : {1, 3})
            for (int axis = 0; axis < 3; ++axis) {
                GridMaker maker;
                maker.add(3, 5, keys, [&](int i, int j, float time01) {
                    V3f p = anywhere(i, j, time01);
                    if (i == 3 && j == 5) p[axis] = bad;
                    return p;
                });
                GridPose pose;
                EXPECT_TRUE(std::isinf(pose.read(maker.grids().grids[0], 0))) << bad;
            }
}

/// Box3f::extendBy() passes over coordinates that are no numbers.
TEST(GridPose, PassesOverWhatIsNoNumber) {
    const float nan = std::numeric_limits<float>::quiet_NaN();
    for (int bad = 0; bad < 4; ++bad) {
        GridPose pose;
        Box3f expected;
        const auto at = [&](int i, int j) {
            return V3f(static_cast<float>(i), i + 2 * j == bad ? nan : static_cast<float>(j), 1);
        };
        for (int c = 0; c < 4; ++c) expected.extendBy(at(c & 1, c >> 1));
        pose.set(GridShape{1, 1}, at);
        pose.for_each_box([&](int, const Box3f& box) {
            EXPECT_EQ(box.min, expected.min);
            EXPECT_EQ(box.max, expected.max);
        });
    }
}

}  // namespace
}  // namespace trapeze
