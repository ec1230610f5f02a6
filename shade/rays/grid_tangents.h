/// The tangents of a grid at a vertex as its vertices have them: of surfaces that deform normals are known at
/// shutter open alone, and points at all times.
#pragma once

#include <algorithm>
#include <cstddef>

#include "core/grid.h"
#include "core/math.h"

namespace trapeze {

/// From the vertex before to the one behind along u and v, at the grid's sides from or to the vertex itself:
/// off the surface's own by half of what it turns along a micropolygon's side, at sides by all of it.
class GridTangents {
  public:
    /// `place(vertex)`: where a vertex is.
    template <class Place>
    GridTangents(const GridShape& shape, size_t vertex, const Place& place) {
        const size_t row = static_cast<size_t>(shape.nu) + 1, u = vertex % row, v = vertex / row;
        const auto last_u = static_cast<size_t>(shape.nu), last_v = static_cast<size_t>(shape.nv);
        const auto at = [&](size_t column, size_t line) { return place(line * row + column); };
        u_ = at(std::min(u + 1, last_u), v) - at(u > 0 ? u - 1 : 0, v);
        v_ = at(u, std::min(v + 1, last_v)) - at(u, v > 0 ? v - 1 : 0);
    }

    /// Whether a grid has vertices enough: in one of a single row of micropolygons each tangent is a side's
    /// own, and nothing tells how the surface bends.
    static bool tell_of(const GridShape& shape) { return shape.nu > 1 && shape.nv > 1; }

    /// Of unit length, along dPdu x dPdv; 0 where there is none.
    V3f normal() const { return u_.cross(v_).normalized(); }

  private:
    V3f u_, v_;
};

}  // namespace trapeze
