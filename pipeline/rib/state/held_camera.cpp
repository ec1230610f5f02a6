#include "pipeline/rib/state/held_camera.h"

#include <algorithm>
#include <cmath>

#include "core/motion_keys.h"
#include "pipeline/rib/state/deforming_shape.h"

namespace trapeze::rib {
namespace {

/// A matrix near to singular has an inverse of infinite elements, which no test of its determinant finds.
bool is_finite(const M44d& m) {
    return std::all_of(&m[0][0], &m[0][0] + 16, [](double x) { return std::isfinite(x); });
}

}  // namespace

/// At each key: from the camera of that moment back to the world, then to the camera as the shutter opens.
/// Keys are as many as any motion has, so that those of a primitive are all among them.
std::vector<M44f> held_camera(const MovingTransform& camera_from_world, float open, float close) {
    if (!camera_from_world.moves_between(open, close)) return {};
    const M44d at_open = camera_from_world.at(open);
    std::vector<M44f> held;
    for (int key = 0; key < kMaxKeyCount; ++key) {
        const M44d at_key = camera_from_world.at(key_time(open, close, key, kMaxKeyCount));
        if (at_key.determinant() == 0) return {};
        const M44d from_key = at_key.inverse() * at_open;
        if (!is_finite(from_key)) return {};
        held.emplace_back(from_key);
    }
    return held;
}

}  // namespace trapeze::rib
