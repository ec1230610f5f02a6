/// A scene as it is for rays that the camera does not see: its own motion, without the camera's.
#pragma once

#include <memory>

#include "core/scene/render_context.h"
#include "core/scene/scene.h"

namespace trapeze {

/// A copy in which primitives have their places in camera space at shutter open at all times; null where the
/// camera does not move. Those that stand still in the world stand still in it. Geometry is shared.
std::unique_ptr<Scene> held_scene(const Scene& scene);

/// Whether rays leave at any other time than shutter open.
bool rays_sample_motion(const RenderContext& context);

}  // namespace trapeze
