/// The binary tree over boxes by the centroid SAH [Hou10 sec. 3.3], with an order to fall back on where no
/// split lowers the cost.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "core/math.h"

namespace trapeze {

/// SAH splits deeper than this give way to medians of the order to fall back on.
inline constexpr int kSahDepthLimit = 56;

/// Depth of the deepest leaf of any tree of up to 2^31 items: a median split halves what is left.
inline constexpr int kTopDepthLimit = kSahDepthLimit + 32;

/// The cost of visiting a node, in tests of a micropolygon.
inline constexpr double kTraversalCost = 1;

/// Nodes are named by links: to a leaf, or to an inner node, which has two links.
struct TopLink {
    static constexpr uint32_t kLeaf = uint32_t{1} << 31;
    uint32_t value = 0;

    static TopLink leaf(uint32_t index) { return {index | kLeaf}; }
    static TopLink inner(uint32_t index) { return {index}; }
    bool is_leaf() const { return value & kLeaf; }
    uint32_t index() const { return value & ~kLeaf; }
};

struct TopTopology {
    /// Inner nodes in preorder: what is below inner node i comes after it. One fewer than leaves.
    std::vector<std::array<TopLink, 2>> inner;
    TopLink root;  ///< meaningless without leaves
};

/// What the SAH divides.
struct SahItem {
    Box3f box;
    uint32_t weight = 1;  ///< tests that its box stands for
    uint32_t id = 0;      ///< the caller's

    V3f centroid() const { return box.min * 0.5f + box.max * 0.5f; }
};

struct SahOptions {
    size_t leaf_below = 2;  ///< nodes of fewer items are leaves
    /// Parts of up to this many items, at most kMostSwept, are split where of all places it costs least;
    /// larger ones, where of 31 planes along each axis it costs least.
    size_t sweep_up_to = 0;
    bool split_anyway = false;  ///< even if no split lowers the cost
    /// The order whose medians divide what the SAH does not.
    std::function<void(std::span<SahItem>)> fallback_order;

    static constexpr size_t kMostSwept = 256;
};

struct SahTopology {
    TopTopology tree;                  ///< its leaves are numbered from left to right
    std::vector<uint32_t> leaf_first;  ///< leaf -> its first item; one more than leaves
};

double half_area(const Box3f& box);

/// Brings the items into the order of the leaves. Deterministic, whatever the number of threads.
SahTopology build_sah_topology(std::vector<SahItem>& items, const SahOptions& options);

}  // namespace trapeze
