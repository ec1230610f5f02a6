/// What top-level builders know of a grid (its place at mid-shutter, its orientation, its weight), and the
/// bounds of a grid's vertices in any axes.
#pragma once

#include <vector>

#include "accel/builders/paper_options.h"
#include "core/grid.h"
#include "core/hyper_trapezoid.h"

namespace trapeze {

/// Coordinates beyond this may overflow in the predicate's products: such grids cannot be culled safely and
/// are in every bound. Far below kLargestCoordinate, which grids are refused beyond.
inline constexpr float kBoundableCoordinate = 1e15f;

/// One grid for builders. Mid-shutter (time 0.5) stands for the whole motion in all choices of topology
/// [Hou10 sec. 3.3]; what must be conservative holds at all keys.
struct GridSummary {
    Box3f box;               ///< camera space, axis-aligned, at mid-shutter
    uint32_t weight = 0;     ///< micropolygons: the SAH's cost of the grid
    Axes axes;               ///< from the averaged edges at mid-shutter [Hou10 sec. 3.3]
    V3f main_direction;      ///< unit: average normal of a surface, average segment of a curve
    float absolute_max = 0;  ///< largest coordinate at any key; infinity when not boundable
    float quad_extent = 0;   ///< longest side of the axis-aligned box of any one micropolygon at any key

    V3f centroid() const { return box.min * 0.5f + box.max * 0.5f; }
};

/// Reads all vertices of a grid at all of its keys; axes of grids that are not boundable are those of space.
GridSummary summarise(const Grid& grid);

/// Summaries of all grids, in their order, with the axes that a tree's bounds have: those of the grids, or
/// the axes of space unless the tree is oriented.
std::vector<GridSummary> oriented_summaries(const Grids& grids, const PaperTreeOptions& options);

/// Of all grids what trees of single micropolygons along the axes need: weight, absolute_max and quad_extent;
/// the rest is as it is by default. Takes half the time of summarise().
std::vector<GridSummary> summaries_along_axes(const Grids& grids);

/// Bound of a whole grid in any axes: a box at each of the grid's own keys, grown for rounding.
/// `absolute_max` is the summary's. A grid without a bound gets a point for each key: the traversal grows
/// boxes by TraceRay::rounding(absolute_max), which is infinite.
HyperTrapezoid bound_in_axes(const Grid& grid, float absolute_max, const Axes& axes);

/// Positions of a grid's vertices at one of its own keys, in camera space, by GridShape::tiled_index(). Only
/// segments are stored: a key's pose is its segment's start, and the last key's is the last segment's start
/// plus its motion.
class KeyVertices {
  public:
    KeyVertices(const Grid& grid, int key) : at_end_(grid.moves() && key == grid.key_count - 1) {
        const int segment = at_end_ ? key - 1 : key;
        for (int k = 0; k < 3; ++k) {
            start_[k] = grid.plane(segment, k);
            delta_[k] = at_end_ ? grid.plane(segment, 3 + k) : nullptr;
        }
    }
    V3f operator[](int at) const {
        V3f p(start_[0][at], start_[1][at], start_[2][at]);
        if (at_end_) p += V3f(delta_[0][at], delta_[1][at], delta_[2][at]);
        return p;
    }

  private:
    bool at_end_;
    const float* start_[3];
    const float* delta_[3];  ///< null: the key is a segment's first
};

/// Position of vertex (i, j) at one of the grid's own keys, in camera space.
V3f vertex_of_key(const Grid& grid, int key, int i, int j);

/// Grows a box of coordinates in some axes for the rounding of a rotation and of a lerp in time.
/// `absolute_max`: the largest coordinate in space of what was rotated.
Box3f grown_for_axes(const Box3f& box, float absolute_max);

/// Coordinates in some axes of all vertices at one of the grid's own keys; row by row, u fastest.
struct VerticesInAxes {
    float c[3][kMaxGridVertices];
};
/// The rotation is three products and two sums in a fixed order; grown_for_axes() covers what they round.
void vertices_in_axes(const Grid& grid, int key, const Axes& axes, VerticesInAxes& out);

}  // namespace trapeze
