/// Clipping planes (RISpec 4.1.1) as the camera sees them.
#include <cmath>

#include "core/motion_keys.h"
#include "pipeline/rib/state/deforming_shape.h"
#include "pipeline/rib/state/graphics_state.h"

namespace trapeze::rib {

/// Normals go with the inverse transpose of the matrix.
bool ReadPlane::at(float time, ClippingPlane::Key& key) const {
    const M44d camera_from_plane = transform.at(time);
    const M44d normals = camera_from_plane.inverse().transposed();
    V3d camera_normal, camera_point;
    normals.multDirMatrix(normal, camera_normal);
    camera_from_plane.multVecMatrix(point, camera_point);
    if (!(camera_normal.length() > 0 && std::isfinite(camera_normal.length()))) return false;
    const V3d inwards = -camera_normal.normalized();
    key = {V3f(inwards), static_cast<float>(inwards.dot(camera_point))};
    return true;
}

/// A plane that is squeezed flat on its way stays as it was before.
ClippingPlane ReadPlane::in_shutter(float open, float close) const {
    ClippingPlane plane;
    ClippingPlane::Key key;
    if (at(open, key)) plane.normal = key.normal, plane.distance = key.distance;
    if (!transform.moves_between(open, close)) return plane;
    key = {plane.normal, plane.distance};
    for (int i = 0; i < kMaxKeyCount; ++i) {  // they cost next to nothing
        at(key_time(open, close, i, kMaxKeyCount), key);
        plane.keys.push_back(key);
    }
    return plane;
}

}  // namespace trapeze::rib
