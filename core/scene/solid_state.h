/// Constructive solid geometry along a ray (RISpec 5.7) [decision 0013].
#pragma once

#include <vector>

#include "core/scene/scene.h"

namespace trapeze {

/// Which leaves of the trees of solids hold the point that travels along a ray, and so which roots do.
class SolidState {
  public:
    explicit SolidState(const std::vector<Solid>& solids);

    /// Outside of all.
    void reset();
    /// The ray crosses a surface of a leaf (a solid of Operation::Primitive); returns whether it thereby
    /// enters or leaves what the leaf's tree describes.
    bool cross(int leaf);
    /// Whether what the leaf's tree describes holds the point.
    bool whole_holds(int leaf) const;

  private:
    bool holds(int solid) const;

    const std::vector<Solid>& solids_;
    std::vector<int> child_count_;   ///< of each solid
    std::vector<int> holding_;       ///< children that hold the point
    std::vector<bool> first_holds_;  ///< whether the first child does
    std::vector<bool> inside_;       ///< the solid itself does
    std::vector<int> touched_;       ///< solids to reset
};

/// Whether a ray sees a border of a whole solid that it enters there, or leaves: of Sides 1 those that face
/// it. `primitive`: whose surface the border is.
bool sees_border(const Primitive& primitive, bool enters);

}  // namespace trapeze
