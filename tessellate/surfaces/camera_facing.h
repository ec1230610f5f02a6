/// Directions of an object's space that face the camera.
#pragma once

#include "core/math.h"
#include "core/scene/camera.h"

namespace trapeze {

/// The camera as a primitive's object space sees it, at one motion key. Curves and points have one for each
/// motion key, since they face the camera anew at each.
class CameraFacing {
  public:
    /// Without a camera: perspective from the origin.
    CameraFacing(const M44f& camera_from_object, const Camera* camera);

    /// The object-space direction, of length 1, that is perpendicular to a tangent and to the ray that sees a
    /// point, both as the camera sees them. `across` x tangent points to the viewer, in a space that is not
    /// mirrored. Where the ray runs along the tangent, some direction across the ray.
    V3f across(const V3f& point, const V3f& tangent) const;

    /// Axes of a square that is parallel to the picture, as long as a unit of object space is on an average;
    /// u_axis() x v_axis() points to the viewer.
    V3f u_axis() const { return u_axis_; }
    V3f v_axis() const { return v_axis_; }
    /// How many times longer an object-space length is in camera space, on an average.
    float scale() const { return scale_; }
    const M44f& camera_from_object() const { return camera_from_object_; }
    const M44f& object_from_camera() const { return object_from_camera_; }
    bool is_perspective() const { return perspective_; }
    /// -1 in mirrored spaces, else 1.
    float outside() const { return outside_; }
    /// Sine of the angle between ray and tangent below which a direction across both is mostly rounding.
    static constexpr float kParallel = 1e-5f;

  private:
    /// A direction of camera space in object space, not of unit length.
    V3f to_object(const V3f& camera_vector) const;

    M44f camera_from_object_, object_from_camera_;
    bool perspective_;
    float outside_;
    float scale_;
    V3f u_axis_, v_axis_;
};

}  // namespace trapeze
