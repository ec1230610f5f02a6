/// The binary tree over grids: centroid SAH with the orientation-aware fallback [Hou10 sec. 3.3], one grid a
/// leaf.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "accel/builders/grid_summary.h"

namespace trapeze {

/// SAH splits deeper than this give way to medians of the orientation-aware order.
inline constexpr int kSahDepthLimit = 56;

/// Depth of the deepest leaf of any tree of up to 2^31 grids: a median split halves what is left.
inline constexpr int kTopDepthLimit = kSahDepthLimit + 32;

/// Nodes are named by links: a leaf holds a grid, an inner node two links.
struct TopLink {
    static constexpr uint32_t kLeaf = uint32_t{1} << 31;
    uint32_t value = 0;

    static TopLink leaf(uint32_t grid) { return {grid | kLeaf}; }
    static TopLink inner(uint32_t index) { return {index}; }
    bool is_leaf() const { return value & kLeaf; }
    uint32_t index() const { return value & ~kLeaf; }
};

struct TopTopology {
    /// Inner nodes in preorder: what is below inner node i comes after it. One fewer than grids.
    std::vector<std::array<TopLink, 2>> inner;
    TopLink root;  ///< meaningless without grids
};

/// Deterministic, whatever the number of threads.
TopTopology build_top_topology(std::span<const GridSummary> grids);

}  // namespace trapeze
