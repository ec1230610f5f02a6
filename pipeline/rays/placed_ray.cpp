#include "pipeline/rays/placed_ray.h"

#include <algorithm>
#include <cmath>
#include <span>

#include "core/scene/poses.h"

namespace trapeze {
namespace {

float largest_part(const V3f& v) {
    return std::max({std::abs(v.x), std::abs(v.y), std::abs(v.z)});
}

}  // namespace

V3f ObjectPlace::to_camera(const V3f& P, float time) const {
    return P * pose_at(std::span<const M44f>(camera_from_shared), time);
}

/// In doubles: places move by what rounds here.
M44f ObjectPlace::inverse(const M44f& pose) {
    return M44f(M44d(pose).inverse());
}

PlacedRay::PlacedRay(const RaySegment& ray)
    : space{ray.origin, ray.direction, ray.time}, scale(largest_part(ray.direction)) {}

PlacedRay::PlacedRay(const RaySegment& ray, const ObjectPlace& at) : place(&at) {
    const std::span<const M44f> poses = at.camera_from_shared;
    const M44f to_shared =
        poses.size() == 1 ? at.shared_from_camera : ObjectPlace::inverse(pose_at(poses, ray.time));
    V3f direction;
    to_shared.multDirMatrix(ray.direction, direction);
    space = {ray.origin * to_shared, direction, ray.time};
    scale = largest_part(direction);
}

RangedRay PlacedRay::ranged(const RaySegment& ray) const {
    return {space, {ray.min * scale, ray.max * scale}, ray.left.most * scale};
}

}  // namespace trapeze
