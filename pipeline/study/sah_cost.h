/// How well parametric splits approximate the SAH inside a grid [Hou10 sec. 5.2, figure 9].
#pragma once

#include "core/grid.h"

namespace trapeze {

/// Expected costs of a random line that meets the grid's box. A node is met with the ratio of its area to the
/// box's; a leaf costs as many tests as it has micropolygons, an inner node as much as one test.
struct SahCosts {
    double parametric;  ///< midpoint splits, as in InGridTrees
    double greedy;      ///< at each node the best of all splits along the axes of the grid's orientation

    /// How much more the parametric splits cost, as a part of the greedy cost; negative where they cost less.
    double relative_difference() const { return greedy > 0 ? parametric / greedy - 1 : 0; }
};

/// Both costs of a grid at mid-shutter, boxes in its orientation and not grown, with leaves of fewer than
/// `leaf_below` micropolygons. Both are 0 when the grid's box has no area.
SahCosts sah_costs(const Grid& grid, int leaf_below = 8);

}  // namespace trapeze
