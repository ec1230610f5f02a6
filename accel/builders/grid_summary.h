/// What top-level builders know of a grid: its place at mid-shutter, its orientation, its weight.
#pragma once

#include <vector>

#include "accel/builders/paper_options.h"
#include "core/grid.h"
#include "core/hyper_trapezoid.h"

namespace trapeze {

/// Coordinates beyond this may overflow in the predicate's products: such grids are in every bound.
inline constexpr float kBoundableCoordinate = 1e15f;

struct GridSummary {
    Box3f box;               ///< camera space, axis-aligned, at mid-shutter
    uint32_t weight = 0;     ///< micropolygons: the SAH's cost of the grid
    Frame frame;             ///< from the averaged edges at mid-shutter [Hou10 sec. 3.3]
    V3f main_direction;      ///< unit: average normal of a surface, average segment of a curve
    float absolute_max = 0;  ///< largest coordinate at any key; infinity when not boundable
    float quad_extent = 0;   ///< longest side of the axis-aligned box of any one micropolygon at any key

    V3f centroid() const { return box.min * 0.5f + box.max * 0.5f; }
};

GridSummary summarise(const Grid& grid);

/// Of all grids, with the frames that a tree's bounds have: all axis-aligned unless it is oriented.
std::vector<GridSummary> framed_summaries(const Grids& grids, const PaperTreeOptions& options);

/// A grid's bound in any frame, at its own keys. What has no bound is a point: its rounding makes it
/// infinite.
HyperTrapezoid bound_in_frame(const Grid& grid, float absolute_max, const Frame& frame);

/// A vertex at one of the grid's own keys.
V3f vertex_of_key(const Grid& grid, int key, int i, int j);

/// Grows a box of coordinates in a frame for the rounding of a rotation and of a lerp in time.
Box3f grown_for_frame(const Box3f& box, float absolute_max);

/// Coordinates in a frame of all vertices at one of the grid's own keys; row by row, u fastest.
struct FramedVertices {
    float c[3][kMaxGridVertices];
};
void vertices_in_frame(const Grid& grid, int key, const Frame& frame, FramedVertices& out);

}  // namespace trapeze
