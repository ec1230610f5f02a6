/// The tree over grids, and the order that it falls back on: every grid once, depth within its limit whatever
/// the input, groups by place and, where places tell nothing, by orientation.
#include "accel/builders/top_topology.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <set>

#include "accel/builders/morton_order.h"

namespace trapeze {
namespace {

/// A grid as builders see it: a cube of half side `half` about a centre.
GridSummary box_at(const V3f& centre, float half = 0.1f, const V3f& direction = V3f(0, 0, 1)) {
    GridSummary grid;
    grid.box = {centre - V3f(half), centre + V3f(half)};
    grid.weight = 256;
    grid.main_direction = direction;
    return grid;
}

/// Grids below a link, with the depth of the deepest.
std::set<uint32_t> below(const TopTopology& topology, TopLink link, int depth, int& deepest) {
    deepest = std::max(deepest, depth);
    if (link.is_leaf()) return {link.index()};
    std::set<uint32_t> all;
    for (const TopLink child : topology.inner[link.index()]) {
        const auto part = below(topology, child, depth + 1, deepest);
        for (const uint32_t grid : part) EXPECT_TRUE(all.insert(grid).second) << "twice";
    }
    return all;
}

TEST(TopTopology, HasEveryGridOnceAndIsBounded) {
    std::mt19937 engine(2);
    std::uniform_real_distribution<float> number(-1, 1);
    for (const int count : {1, 2, 3, 100, 5000})
        for (const int kind : {0, 1, 2}) {
            std::vector<GridSummary> grids;
            for (int n = 0; n < count; ++n) {
                const float spread = kind == 0 ? 1.0f : std::ldexp(1.0f, -(n % 120));  // towards a point
                const V3f at = V3f(number(engine), number(engine), number(engine)) * spread;
                grids.push_back(box_at(kind == 2 ? V3f(0) : at, 0.01f * spread));
            }
            const TopTopology topology = build_top_topology(grids);
            int deepest = 0;
            EXPECT_EQ(below(topology, topology.root, 0, deepest).size(), static_cast<size_t>(count));
            EXPECT_LE(deepest, kTopDepthLimit);
            EXPECT_EQ(topology.inner.size(), static_cast<size_t>(count - 1));
        }
}

TEST(TopTopology, SplitsClustersApart) {
    std::vector<GridSummary> grids;
    for (int n = 0; n < 40; ++n)
        grids.push_back(box_at(V3f(n % 2 ? 10.0f : -10.0f, 0.01f * static_cast<float>(n), 0)));
    const TopTopology topology = build_top_topology(grids);
    int deepest = 0;
    for (const TopLink side : topology.inner[topology.root.index()]) {
        const auto part = below(topology, side, 0, deepest);
        EXPECT_EQ(part.size(), 20u);
        for (const uint32_t grid : part) EXPECT_EQ(grid % 2, *part.begin() % 2);
    }
}

TEST(TopTopology, GroupsByOrientationWhereBoxesTellNothing) {
    // Long boxes all over each other: no plane reduces the cost.
    std::vector<GridSummary> grids;
    for (int n = 0; n < 64; ++n) {
        const V3f direction = V3f(n % 2 ? 1.0f : -1.0f, 0, 1).normalized();
        grids.push_back(box_at(V3f(1e-6f * static_cast<float>(n), 0, 0), 10, direction));
    }
    const TopTopology topology = build_top_topology(grids);
    int deepest = 0;
    for (const TopLink side : topology.inner[topology.root.index()])
        for (const auto part = below(topology, side, 0, deepest); const uint32_t grid : part)
            EXPECT_EQ(grid % 2, *part.begin() % 2);
    EXPECT_EQ(deepest, 5);  // medians
}

TEST(TopTopology, WithoutExtentOrFiniteAreaStillATree) {
    std::vector<GridSummary> grids(50, box_at(V3f(0), 0));
    for (int n = 0; n < 50; ++n) grids.push_back(box_at(V3f(0), 3e38f));
    const TopTopology topology = build_top_topology(grids);
    int deepest = 0;
    EXPECT_EQ(below(topology, topology.root, 0, deepest).size(), 100u);
    EXPECT_LE(deepest, kTopDepthLimit);
}

TEST(MortonOrder, OppositeDirectionsAreOneOrientation) {
    const Box3f unit(V3f(0), V3f(1));
    std::mt19937 engine(4);
    std::uniform_real_distribution<float> number(-1, 1);
    for (int n = 0; n < 1000; ++n) {
        V3f d(number(engine), number(engine), number(engine));
        d.normalize();
        const V2f square = square_from_direction(d);
        EXPECT_EQ(square, square_from_direction(-d));
        for (const float coordinate : {square.x, square.y}) {
            EXPECT_GE(coordinate, 0);
            EXPECT_LE(coordinate, 1.000001f);
        }
        EXPECT_EQ(orientation_morton_code(d, V3f(0.5f), unit), orientation_morton_code(-d, V3f(0.5f), unit));
    }
}

TEST(MortonOrder, SpreadsDirectionsEvenly) {
    std::mt19937 engine(5);
    std::normal_distribution<float> number;
    std::vector<int> bins(16);
    for (int n = 0; n < 16000; ++n) {
        V3f d(number(engine), number(engine), number(engine));
        d.normalize();
        const V2f square = square_from_direction(d);
        ++bins[static_cast<size_t>(std::min(3.0f, square.x * 4)) * 4 +
               static_cast<size_t>(std::min(3.0f, square.y * 4))];
    }
    for (const int count : bins) EXPECT_NEAR(count, 1000, 160);  // five sigma
}

}  // namespace
}  // namespace trapeze
