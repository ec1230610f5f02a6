/// The SAH's tree against its definition: leaves small, numbered from left to right, splits the cheapest of
/// all, the same from any number of threads, and a tree even over items without a place.
#include "accel/builders/sah_topology.h"

#include <gtest/gtest.h>
#include <tbb/global_control.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <limits>
#include <numeric>
#include <random>

namespace trapeze {
namespace {

/// Cubes of sides up to about 0.2 in a cube of side 2.
std::vector<SahItem> random_items(size_t count, uint32_t seed) {
    std::mt19937 engine(seed);
    std::uniform_real_distribution<float> number(-1, 1);
    std::vector<SahItem> items;
    for (size_t n = 0; n < count; ++n) {
        const V3f at(number(engine), number(engine), number(engine)), half(0.05f * (1.1f + number(engine)));
        items.push_back({{at - half, at + half}, 1, static_cast<uint32_t>(n)});
    }
    return items;
}

SahOptions options_of(size_t leaf_below, size_t sweep_up_to) {
    SahOptions options;
    options.leaf_below = leaf_below;
    options.sweep_up_to = sweep_up_to;
    options.fallback_order = [](std::span<SahItem>) {};
    return options;
}

/// The depth of the deepest leaf; adds what leaves hold to `counts`.
int walk(const SahTopology& topology, TopLink link, std::vector<size_t>& counts) {
    if (link.is_leaf()) {
        EXPECT_EQ(link.index(), counts.size()) << "leaves are numbered from left to right";
        counts.push_back(topology.leaf_first[link.index() + 1] - topology.leaf_first[link.index()]);
        return 0;
    }
    int deepest = 0;
    for (const TopLink child : topology.tree.inner[link.index()]) {
        if (!child.is_leaf()) {
            EXPECT_GT(child.index(), link.index()) << "preorder";
        }
        deepest = std::max(deepest, walk(topology, child, counts));
    }
    return deepest + 1;
}

TEST(SahTopology, HasEveryItemOnceInLeavesThatAreSmall) {
    for (const size_t count : {0, 1, 7, 8, 500, 20000})
        for (const size_t leaf_below : {2, 8, 32})
            for (const size_t sweep_up_to : {0, 64, 256}) {
                std::vector<SahItem> items = random_items(count, 3);
                const SahTopology topology = build_sah_topology(items, options_of(leaf_below, sweep_up_to));
                std::vector<size_t> counts;
                if (count > 0) walk(topology, topology.tree.root, counts);
                EXPECT_EQ(std::accumulate(counts.begin(), counts.end(), size_t{0}), count);
                EXPECT_TRUE(std::all_of(counts.begin(), counts.end(),
                                        [&](size_t n) { return n > 0 && n < leaf_below; }));
                EXPECT_EQ(topology.tree.inner.size() + 1, std::max(counts.size(), size_t{1}));
                std::vector<bool> seen(count);
                for (const SahItem& item : items) seen[item.id] = true;
                EXPECT_EQ(std::count(seen.begin(), seen.end(), true), static_cast<int>(count));
            }
}

/// The SAH's term for one side, computed anew.
double cost_of(std::span<const SahItem> part) {
    Box3f box;
    for (const SahItem& item : part) box.extendBy(item.box);
    return half_area(box) * static_cast<double>(part.size());
}

TEST(SahTopology, SweepingFindsTheCheapestOfAllSplits) {
    for (uint32_t seed = 0; seed < 50; ++seed) {
        std::vector<SahItem> items = random_items(40, seed), sorted = items;
        SahOptions options = options_of(40, 256);  // of 40 items one split
        options.split_anyway = true;
        const SahTopology topology = build_sah_topology(items, options);
        ASSERT_EQ(topology.tree.inner.size(), 1u);
        const std::span<const SahItem> all(items);
        const double found =
            cost_of(all.first(topology.leaf_first[1])) + cost_of(all.subspan(topology.leaf_first[1]));
        double cheapest = std::numeric_limits<double>::infinity();
        for (int axis = 0; axis < 3; ++axis) {
            std::sort(sorted.begin(), sorted.end(), [axis](const SahItem& a, const SahItem& b) {
                return a.centroid()[axis] < b.centroid()[axis];
            });
            for (size_t i = 1; i < sorted.size(); ++i)
                cheapest = std::min(
                    cheapest, cost_of(std::span(sorted).first(i)) + cost_of(std::span(sorted).subspan(i)));
        }
        EXPECT_DOUBLE_EQ(found, cheapest);
    }
}

TEST(SahTopology, FallsBackWhereNoSplitLowersTheCostUnlessToldToSplit) {
    // Large boxes all over each other: any split costs more than none.
    std::vector<SahItem> items;
    for (uint32_t n = 0; n < 64; ++n) {
        const V3f at(1e-3f * static_cast<float>(n), 0, 0);
        items.push_back({{at - V3f(10), at + V3f(10)}, 1, n});
    }
    for (const bool split_anyway : {false, true}) {
        int fallbacks = 0;
        SahOptions options = options_of(2, 64);
        options.split_anyway = split_anyway;
        options.fallback_order = [&](std::span<SahItem> part) {
            ++fallbacks;
            std::sort(part.begin(), part.end(),
                      [](const SahItem& a, const SahItem& b) { return a.id % 8 < b.id % 8; });
        };
        std::vector<SahItem> ordered = items;
        build_sah_topology(ordered, options);
        EXPECT_EQ(fallbacks, split_anyway ? 0 : 1);
        EXPECT_EQ(ordered[1].id % 8 == 0, !split_anyway);
    }
}

TEST(SahTopology, OfWhatHasNoPlaceIsStillATree) {
    const float nan = std::numeric_limits<float>::quiet_NaN();
    for (const size_t sweep_up_to : {0, 256}) {
        std::vector<SahItem> items = random_items(100, 4);
        for (uint32_t n = 0; n < 100; ++n) {
            items.push_back({{V3f(nan), V3f(nan)}, 1, n});
            items.push_back({{V3f(-3e38f), V3f(3e38f)}, 1, n});
            items.push_back({{V3f(0), V3f(0)}, 1, n});
        }
        const SahTopology topology = build_sah_topology(items, options_of(2, sweep_up_to));
        std::vector<size_t> counts;
        EXPECT_LE(walk(topology, topology.tree.root, counts), kTopDepthLimit);
        EXPECT_EQ(counts.size(), 400u);
    }
}

TEST(SahTopology, IsTheSameFromAnyNumberOfThreads) {
    std::vector<std::vector<SahItem>> orders;
    std::vector<SahTopology> topologies;
    for (const int threads : {1, 2, 7}) {
        const tbb::global_control control(tbb::global_control::max_allowed_parallelism,
                                          static_cast<size_t>(threads));
        tbb::task_arena arena(threads);
        arena.execute([&] {
            orders.push_back(random_items(200'000, 5));  // enough for bins in parallel
            topologies.push_back(build_sah_topology(orders.back(), options_of(8, 64)));
        });
    }
    for (const size_t other : {1, 2}) {
        EXPECT_TRUE(std::equal(orders[0].begin(), orders[0].end(), orders[other].begin(),
                               [](const SahItem& a, const SahItem& b) { return a.id == b.id; }));
        EXPECT_EQ(topologies[0].leaf_first, topologies[other].leaf_first);
    }
}

}  // namespace
}  // namespace trapeze
