/// What a moving camera's motion has to be taken out of positions by, for rays that the camera does not see.
#pragma once

#include <vector>

#include "pipeline/rib/state/moving_transform.h"

namespace trapeze::rib {

/// Scene::held_from_camera. Empty also where the camera cannot be held: where it is squeezed flat.
std::vector<M44f> held_camera(const MovingTransform& camera_from_world, float open, float close);

}  // namespace trapeze::rib
