/// Cuts a rectangle of unit cells by closed loops: polygons that cover what is kept, within one cell each,
/// and share their vertices. Loops are followed point by point, so that the border is as smooth as they are.
#pragma once

#include <vector>

#include "core/math.h"

namespace trapeze {

using V2d = Imath::V2d;

/// A mesh of polygons in the plane of cells.
struct TrimmedCells {
    /// A cell, by column and row.
    struct Cell {
        int i = 0, j = 0;
    };
    std::vector<V2d> points;             ///< in cells, 0..nx, 0..ny
    std::vector<int> vertices_per_face;  ///< of convex polygons, anticlockwise
    std::vector<int> vertices;
    std::vector<Cell> cells;  ///< by face
};

/// Cuts nx x ny cells by loops (points in cells, each closed from its last point to its first) and keeps what
/// is inside, or outside. The inside is what a ray leaves through loops an odd number of times [RISpec 5.2].
/// Loops may cross themselves and each other, and lie in each other.
TrimmedCells trim_cells(std::vector<std::vector<V2d>> loops, int nx, int ny, bool keep_outside);

}  // namespace trapeze
