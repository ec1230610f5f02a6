/// When the rays of a point meet the scene, and where the point is then.
///
/// Shading is done once for the whole shutter, with everything in its place as the shutter opens [Cook87];
/// only rays go out at times of their own, from where their point is then. What they hit is shaded as the
/// shutter opens, too, and its own rays go on at the time of the ray that hit it. So a reflection, a shadow
/// and what is seen in a reflection agree about where things are. Directions that belong to a surface turn
/// with it.
#pragma once

#include <optional>

#include "core/scene/motion_turn.h"
#include "core/scene/vertex_motion.h"
#include "shade/rays/ray_asker.h"

namespace trapeze {

/// Of one lane in one call.
class LaneMotion {
  public:
    /// `given`: when all of the lane's rays leave, if that is known before; else they have times of their own
    /// where the surface asks for that.
    LaneMotion(const RayAsker& asker, const RayLane& lane, std::optional<float> given = {});

    /// When a ray leaves: 0 at shutter open, below 1 (shutter_time()).
    float time(int sample) const;
    /// How far the point has come since the shutter opened; camera space at shutter open.
    V3f way(float time) const { return vertex_.way(time); }
    /// Where the shaded point itself is at shutter open.
    V3f start() const { return vertex_.start(); }
    /// Where a direction of a ray leads at a time, as its surface turns, also in deforming; and back. All
    /// rays of hits turn, for the ways that these are seen along have been turned back; of what the camera
    /// sees diffuse ones alone, which follow the normal: others, the eye's way through glass, stay as they
    /// are.
    V3f turned(const V3f& direction, float time, bool diffuse) const;
    V3f turned_back(const V3f& direction, float time, bool diffuse) const;
    /// What turned() does where that is the turn of the space alone though the surface deforms and directions
    /// should turn with it: the grid does not tell how. Else nothing.
    std::optional<M33f> turn_of_space_alone(float time, bool diffuse) const;
    /// Where the surface's unit normal of shutter open leads at a time; nothing where the surface stretches
    /// so much that it may be bent otherwise, or deforms.
    std::optional<V3f> normal(const V3f& normal, float time) const;

  private:
    const ShadingGrid* grid_;
    VertexMotion vertex_;
    bool varies_ = false;
    float shift_ = 0, only_time_ = 0;
    bool is_hit_ = false;
    MotionTurn turn_;
    bool tells_shape_ = false;  ///< of what deforms: its grid tells how
};

}  // namespace trapeze
