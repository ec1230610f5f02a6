/// The first pass of a WideTree's build: every grid's axes and boxes.
#pragma once

#include "accel/wide/wide_tree.h"

namespace trapeze {

/// A box at shutter open and at shutter close, linear between.
struct EndBoxes {
    KeyBounds at[2];
};

/// What the pass finds of a grid besides WideGrid and its block boxes.
struct GridExtent {
    EndBoxes box;  ///< the grid's space, grown for rounding; linear in time around all keys
    float absolute_max;
    float largest_micropolygon;  ///< the extent of the largest along any axis
};

/// Bounds one grid: fills in its record (all but first_pair, which is set, and leaf) and what it has at its
/// keys, in WideGrid::keys_bytes() bytes at `keys`. `scale` and `base`: bounds grow by scale * largest
/// coordinate + base, which must cover what rounds for rays within reach (WideTree::rounding()). A grid
/// beyond kBoundableCoordinate gets an absolute_max of infinity, and boxes that mean nothing. Safe from many
/// threads.
void bound_grid(const Grid& grid, float scale, float base, WideGrid& record, uint8_t* keys,
                GridExtent& extent);

}  // namespace trapeze
