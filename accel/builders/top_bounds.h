/// The bottom-up pass that bounds the nodes of a topology [Hou10 sec. 3.3].
#pragma once

#include <functional>

#include "accel/paper_options.h"
#include "accel/top_level.h"
#include "core/hyper_trapezoid.h"

namespace trapeze {

struct NodeBound {
    HyperTrapezoid box;
    float absolute_max = 0;  ///< largest coordinate of what is inside
    float quad_extent = 0;   ///< longest side of the box of any one micropolygon inside
};

/// Nodes with boxes at key_count keys. `bound_of(leaf)` is called from many threads.
TopLevel bound_top_level(const TopTopology& topology, size_t leaf_count, int key_count,
                         const PaperTreeOptions& options,
                         const std::function<NodeBound(uint32_t leaf)>& bound_of);

}  // namespace trapeze
