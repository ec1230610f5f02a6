/// The binary tree over boxes by the surface area heuristic over centroids [Wald07; Hou10 sec. 3.3], with an
/// order to fall back on where no split lowers the cost. Only the topology: bounds are made afterwards,
/// because oriented, axis-aligned and whole-motion bounds are compared on the same topology.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "core/math.h"

namespace trapeze {

/// SAH splits deeper than this give way to medians of the order to fall back on. A bad input (items that lie
/// ever closer to a point) would otherwise make a tree as deep as it has items.
inline constexpr int kSahDepthLimit = 56;

/// Depth of the deepest leaf of any tree of up to 2^31 items: a median split halves what is left. Stacks of
/// traversals rely on it.
inline constexpr int kTopDepthLimit = kSahDepthLimit + 32;

/// The cost of visiting a node, in tests of a micropolygon.
inline constexpr double kTraversalCost = 1;

/// A link names a node: a leaf, or an inner node, which has two links. The top bit tells which.
struct TopLink {
    static constexpr uint32_t kLeaf = uint32_t{1} << 31;
    uint32_t value = 0;

    /// Indices of leaves and of inner nodes count from 0 each, below 2^31.
    static TopLink leaf(uint32_t index) { return {index | kLeaf}; }
    static TopLink inner(uint32_t index) { return {index}; }
    bool is_leaf() const { return value & kLeaf; }
    uint32_t index() const { return value & ~kLeaf; }
};

/// Who is whose child in a binary tree; no bounds.
struct TopTopology {
    /// Inner nodes in preorder: what is below inner node i comes after it. One fewer than leaves.
    std::vector<std::array<TopLink, 2>> inner;
    TopLink root;  ///< meaningless without leaves
};

/// A box that the SAH divides space for: a grid or a micropolygon, at mid-shutter.
struct SahItem {
    Box3f box;
    uint32_t weight = 1;  ///< tests that its box stands for
    uint32_t id = 0;      ///< the caller's

    V3f centroid() const { return box.min * 0.5f + box.max * 0.5f; }
};

/// How far and how carefully to split.
struct SahOptions {
    size_t leaf_below = 2;  ///< nodes of fewer items are leaves
    /// Parts of up to this many items, at most kMostSwept, are split where of all places it costs least;
    /// larger ones, where of 31 planes along each axis it costs least.
    size_t sweep_up_to = 0;
    bool split_anyway = false;  ///< even if no split lowers the cost
    /// The order whose medians divide what the SAH does not.
    std::function<void(std::span<SahItem>)> fallback_order;

    /// The largest part that is sorted along each axis; a larger one would cost time and stack.
    static constexpr size_t kMostSwept = 256;
};

/// What build_sah_topology() returns: leaf i holds items leaf_first[i] .. leaf_first[i + 1] - 1 of the sorted
/// items.
struct SahTopology {
    TopTopology tree;                  ///< its leaves are numbered from left to right
    std::vector<uint32_t> leaf_first;  ///< leaf -> its first item; one more than leaves
};

/// Half the surface of a box, xy + yz + zx, in doubles because a box may be as large as floats go; 0 of an
/// empty one.
inline double half_area(const Box3f& box) {
    if (box.isEmpty()) return 0;
    const V3d size = V3d(box.max) - V3d(box.min);
    return size.x * size.y + size.y * size.z + size.z * size.x;
}

/// Brings the items into the order of the leaves. Deterministic, whatever the number of threads.
SahTopology build_sah_topology(std::span<SahItem> items, const SahOptions& options);

}  // namespace trapeze
