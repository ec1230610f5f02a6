/// What is kept of a cell that trim loops go through: polygons with holes, made of the cell's border and of
/// the loops' parts in it.
#pragma once

#include <span>
#include <vector>

#include "core/math.h"

namespace trapeze {

using V2d = Imath::V2d;

/// Loops' parts in a cell, as point numbers.
struct CellLoops {
    std::vector<std::vector<int>> paths;   ///< from one crossing of the border to another, both included
    std::vector<std::vector<int>> closed;  ///< that never leave the cell
};

/// A corner of a cell, or where a loop crosses its border.
struct CellBorderNode {
    int vertex = 0;
    bool kept_after = false;  ///< the border from here to the next node
};

/// One polygon with its holes, as point numbers.
struct CellOutline {
    std::vector<int> outer;               ///< anticlockwise
    std::vector<std::vector<int>> holes;  ///< clockwise
};

/// The area of a polygon of point numbers, positive when it runs anticlockwise.
double signed_area(const std::vector<V2d>& points, const std::vector<int>& polygon);

/// The outlines of a cell, whose border runs anticlockwise from its least corner. Sides of a loop take turns:
/// one is kept. Where loops cross, points are added. No three lines may meet in a point, and none may end on
/// another. Of loops that cross more often in a cell than anybody draws, the border may run straight through.
std::vector<CellOutline> outlines_of_cell(std::span<const CellBorderNode> border, const CellLoops& loops,
                                          std::vector<V2d>& points);

}  // namespace trapeze
