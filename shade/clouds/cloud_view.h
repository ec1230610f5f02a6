/// The camera of the frame that baked a point cloud, as its file records it.
#pragma once

#include "core/math.h"

namespace trapeze {

/// Matrices for row vectors.
struct CloudView {
    M44f camera_from_world, screen_from_camera;
    float width = 640, height = 480;  ///< pixels
};

}  // namespace trapeze
