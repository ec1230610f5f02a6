/// Where the vertices of a block of micropolygons lie.
#pragma once

#include <cstddef>

namespace trapeze {

/// Where a block's 5 x 5 vertices lie in a plane of positions: those of a tile and, where `right` and `down`
/// say, the first column and row of the tiles behind it. At the grid's end, where there is no such tile, they
/// repeat the last ones.
struct BlockView {
    const float* tile;  ///< of the plane x
    size_t plane;       ///< floats to the planes y, z, dx, dy, dz
    int right, down;    ///< offsets of the fifth column and row
    int rows;           ///< of micropolygons

    /// Floats from `tile` to vertex (i, j) of the block, 0 <= i, j <= 4.
    int offset(int i, int j) const { return (j < 4 ? j * 4 : down) + (i < 4 ? i : right); }
};

}  // namespace trapeze
