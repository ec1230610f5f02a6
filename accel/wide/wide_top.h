/// The levels of a WideTree above grids: a binned SAH [Wald07] over grids' centroids at mid-shutter,
/// collapsed to nodes of 16 children, as many as AVX-512 has lanes.
#pragma once

#include <span>
#include <vector>

#include "accel/wide/wide_grids.h"

namespace trapeze {

/// A child of a wide node while it is built: a box and what it holds (kGridLink and a grid's number, or a
/// node's).
struct WideChild {
    EndBoxes box;
    uint32_t link;
};

/// A wide node while it is built; node 0 is the root.
struct WideChildren {
    WideChild child[WideNode::kChildren];
    int count = 0;
};

/// Builds the tree over some grids, of which there is at least one; `grids` are indices in `extents`. Every
/// grid is the child of one node. Deterministic, whatever the number of threads.
std::vector<WideChildren> build_wide_top(std::span<const GridExtent> extents,
                                         std::span<const uint32_t> grids);

}  // namespace trapeze
