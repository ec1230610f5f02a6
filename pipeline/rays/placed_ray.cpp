#include "pipeline/rays/placed_ray.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <span>

#include "core/scene/poses.h"

namespace trapeze {
namespace {

float largest_part(const V3f& v) {
    return std::max({std::abs(v.x), std::abs(v.y), std::abs(v.z)});
}

}  // namespace

V3f ObjectPlace::to_camera(const V3f& P, float time) const {
    return V3f(V3d(P) * pose_at(std::span<const M44d>(camera_from_shared), time));
}

M44d ObjectPlace::inverse(const M44d& pose) {
    return pose.determinant() == 0 ? M44d(std::numeric_limits<double>::quiet_NaN()) : pose.inverse();
}

PlacedRay::PlacedRay(const RaySegment& ray)
    : space{ray.origin, ray.direction, ray.time}, scale(largest_part(ray.direction)) {}

PlacedRay::PlacedRay(const RaySegment& ray, const ObjectPlace& at) : place(&at) {
    const std::span<const M44d> poses = at.camera_from_shared;
    const M44d to_shared =
        poses.size() == 1 ? at.shared_from_camera : ObjectPlace::inverse(pose_at(poses, ray.time));
    V3d direction;
    to_shared.multDirMatrix(V3d(ray.direction), direction);
    space = {V3f(V3d(ray.origin) * to_shared), V3f(direction), ray.time};
    scale = largest_part(space.direction);
}

RangedRay PlacedRay::ranged(const RaySegment& ray) const {
    return {.ray = space,
            .range = {ray.min * scale, ray.max * scale},
            .sure = {ray.left.sure() * scale, ray.reached.sure() * scale}};
}

}  // namespace trapeze
