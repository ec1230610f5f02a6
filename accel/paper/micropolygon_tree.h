/// The paper's tree without its parametric splits [Hou10 table 4]: a greedy SAH build over single
/// micropolygons at mid-shutter, bounded as in PaperTree. A leaf takes that orientation which makes it
/// smallest: from the averaged edges of its own micropolygons, or that of one of their grids.
#pragma once

#include <vector>

#include "accel/builders/grid_summary.h"
#include "accel/builders/paper_options.h"
#include "accel/paper/list_tree.h"
#include "accel/paper/top_bounds.h"

namespace trapeze {

/// Leaves are lists of at most options.leaf - 1 micropolygons of any grids. Finds what testing everything
/// finds, bit for bit.
class MicropolygonTree final : public ListTree {
  public:
    /// Keeps a reference to the grids.
    explicit MicropolygonTree(const Grids& grids, const PaperTreeOptions& options = {});

  private:
    /// Sorts micropolygons into leaves and bounds the nodes above them.
    void build_topology(const std::vector<GridSummary>& summaries, const PaperTreeOptions& options);
    /// Bound of a leaf in given axes, at as many keys as its grids have at most.
    HyperTrapezoid leaf_bound_in(const Axes& axes, uint32_t index, const std::vector<GridSummary>& summaries,
                                 const PaperTreeOptions& options) const;
    /// Bound of a leaf in that orientation which makes its expected area least.
    NodeBound leaf_bound(uint32_t index, const std::vector<GridSummary>& summaries,
                         const PaperTreeOptions& options) const;
};

}  // namespace trapeze
