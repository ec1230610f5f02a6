/// The bottom-up pass that bounds the nodes of a topology [Hou10 sec. 3.3]: grids or lists of micropolygons
/// below.
#pragma once

#include <functional>

#include "accel/builders/paper_options.h"
#include "accel/paper/top_level.h"
#include "core/hyper_trapezoid.h"

namespace trapeze {

/// What a node is known by to its parent: its moving box, and how much that may be off for rays.
struct NodeBound {
    HyperTrapezoid box;
    float absolute_max = 0;  ///< largest coordinate of what is inside
    float quad_extent = 0;   ///< longest side of the box of any one micropolygon inside
    uint32_t axes = 0;       ///< the box's, by number: that of a leaf, counted from left to right, or none's
};

/// How leaves are bounded; called from many threads, perhaps several times for a leaf.
struct LeafBounds {
    std::function<NodeBound(uint32_t leaf)> own;  ///< in the leaf's orientation
    /// The leaf's contents in another orientation, tighter than its own box turned.
    std::function<HyperTrapezoid(uint32_t leaf, const Axes& axes)> in;
    /// A box that is turned into another orientation grows, which a small node feels more than a large one:
    /// nodes of up to this many leaves are bounded from what is in these.
    size_t in_up_to;
};

/// The tree of a topology with `leaf_count` leaves, with boxes at key_count keys (one for WholeMotion), in
/// the orientations that `options` ask for. Deterministic, whatever the number of threads.
TopLevel bound_top_level(const TopTopology& topology, size_t leaf_count, int key_count,
                         const PaperTreeOptions& options, const LeafBounds& leaves);

}  // namespace trapeze
