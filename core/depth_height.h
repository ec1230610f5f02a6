/// Heights over what a depth map saw: how a stage that must not read picture files asks the one that does.
#pragma once

#include <functional>
#include <string>

#include "core/diagnostics.h"
#include "core/math.h"

namespace trapeze {

/// How far a camera-space point lies before what a depth map saw in its direction, along the view of the
/// map's camera: positive on the camera's side. kInfinity where the map saw nothing, and outside it.
/// Thread-safe.
using DepthHeight = std::function<float(const V3f& camera_point)>;

/// Finds the heights over a depth map by the name of its file; empty when that cannot be read, which is
/// reported once, where it is first named. Thread-safe.
using FindDepthHeight = std::function<DepthHeight(const std::string& name, SourceLocation location)>;

}  // namespace trapeze
