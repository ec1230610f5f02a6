/// How a primitive's own space turns while the shutter is open. Shading is done as it opens: directions that
/// belong to a surface turn with it until its rays go out.
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "core/math.h"
#include "core/scene/scene.h"

namespace trapeze {

/// Rotations between motion keys, of camera space as the shutter opens. What does not turn has none.
class MotionTurn {
  public:
    MotionTurn() = default;
    /// `keys`: those of the primitive's grids. `held`: Scene::held_from_camera, where positions at the keys
    /// still hold the camera's own motion; else empty.
    MotionTurn(const Primitive& primitive, int keys, std::span<const M44f> held);

    bool is_none() const { return from_first_.empty(); }
    /// Where a direction of shutter open leads at a time; and the other way round.
    V3f forward(const V3f& direction, float time01) const;
    V3f back(const V3f& direction, float time01) const;
    /// Where a plane's unit normal of shutter open leads; nothing where the space has become larger or
    /// smaller by more than a quarter along some axis, or skew, so that what is curved may be curved
    /// otherwise.
    std::optional<V3f> normal(const V3f& normal, float time01) const;

  private:
    /// Rows are where the axes of shutter open lead, of unit length and at right angles.
    struct Axes {
        V3d x, y, z;
    };
    Axes at(float time01) const;

    std::vector<M44d> from_first_;  ///< at each key
};

/// A direction turned as what leads from one unit vector to another by the shortest way; where none does, as
/// it is.
inline V3f turned_from(const V3f& from, const V3f& to, const V3f& direction) {
    const V3f axis = from.cross(to);
    const float cosine = from.dot(to);
    constexpr float kNearlyOpposite = -0.999f;
    const bool are_unit = from != V3f(0, 0, 0) && to != V3f(0, 0, 0);
    if (!are_unit || !(cosine > kNearlyOpposite)) return direction;
    return direction * cosine + axis.cross(direction) + axis * (axis.dot(direction) / (1 + cosine));
}

}  // namespace trapeze
