#include "tessellate/surfaces/camera_facing.h"

#include <cmath>

#include "core/portable_math.h"
#include "tessellate/topology/placed_surface.h"

namespace trapeze {
/// One length serves for all directions: the cube root of the determinant, which is exact for spaces that are
/// scaled alike along all axes.
CameraFacing::CameraFacing(const M44f& camera_from_object, const Camera* camera)
    : camera_from_object_(camera_from_object),
      object_from_camera_(M44f(M44d(camera_from_object).inverse())),
      perspective_(!camera || camera->perspective) {
    // In double: determinants of small scales underflow in float.
    const double determinant = M44d(camera_from_object).determinant();
    outside_ = determinant < 0 ? -1.0f : 1.0f;
    scale_ = static_cast<float>(portable::cbrt(std::abs(determinant)));
    // Camera x and, unless mirrored, minus y: their cross product is -z, towards the eye.
    u_axis_ = to_object({scale_, 0, 0});
    v_axis_ = to_object({0, -outside_ * scale_, 0});
}

V3f CameraFacing::to_object(const V3f& camera_vector) const {
    return transform_vector(object_from_camera_, camera_vector);
}

/// The cross product is taken in camera space, where rays are straight lines through the eye, and its result
/// taken back to object space, in which surfaces are evaluated.
V3f CameraFacing::across(const V3f& point, const V3f& tangent) const {
    const V3f ray = perspective_ ? transform_point(camera_from_object_, point) : V3f(0, 0, 1);
    const V3f along = transform_vector(camera_from_object_, tangent);
    // Across the ray and the tangent in camera space; mirrored spaces turn it over.
    V3f side = ray.cross(along) * outside_;
    if (!(side.dot(side) > kParallel * kParallel * ray.dot(ray) * along.dot(along)))
        side = unit_or_zero(ray).cross(std::abs(ray.x) < std::abs(ray.z) ? V3f(1, 0, 0) : V3f(0, 1, 0));
    // Where the way back to object space leaves nothing of it, some direction all the same.
    const V3f unit = unit_or_zero(to_object(side));
    return unit == V3f(0, 0, 0) ? V3f(1, 0, 0) : unit;
}

}  // namespace trapeze
