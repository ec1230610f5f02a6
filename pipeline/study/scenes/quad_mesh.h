/// Many quadrilaterals in one PointsPolygons, each corner with a place and a colour of its own.
#pragma once

#include <array>

#include "pipeline/study/scenes/rib_writer.h"

namespace trapeze::scenes {

using Corners = std::array<V3d, 4>;  ///< around the quadrilateral

/// Quadrilaterals that are written as one mesh, each with corners of its own, so that colours need not be
/// continuous.
class QuadMesh {
  public:
    void add(const Corners& places, const Corners& colors);
    void add(const Corners& places, const V3d& color) { add(places, Corners{color, color, color, color}); }

    /// Adds an upright quadrilateral, its lower edge from `a` to `b`; the colour goes from `low` to `high`.
    void add_wall(const V3d& a, const V3d& b, double height, const V3d& low, const V3d& high);

    /// Adds a rectangle of x and z on the ground.
    void add_ground(const V3d& from, const V3d& to, const V3d& color);

    /// Adds a box along the axes, without a lower side.
    void add_box(const V3d& low, const V3d& high, const V3d& color);

    /// Adds a lamp: a rectangle that faces along z, towards the eye.
    void add_lamp(const V3d& center, double half_width, double half_height, const V3d& color);

    void write(RibWriter& rib) const;

  private:
    std::vector<V3d> places_, colors_;
};

}  // namespace trapeze::scenes
