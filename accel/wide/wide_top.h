/// The levels of a WideTree above grids: a binned SAH over grids' centroids at mid-shutter, collapsed to
/// nodes of 16 children.
#pragma once

#include <span>
#include <vector>

#include "accel/wide/wide_grids.h"

namespace trapeze {

/// A child of a wide node while it is built: a box and what it holds.
struct WideChild {
    EndBoxes box;
    uint32_t link;
};

/// A wide node while it is built; node 0 is the root.
struct WideChildren {
    WideChild child[WideNode::kChildren];
    int count = 0;
};

/// The tree over some grids, of which there is at least one. Deterministic, whatever the number of threads.
std::vector<WideChildren> build_wide_top(std::span<const GridExtent> extents,
                                         std::span<const uint32_t> grids);

}  // namespace trapeze
