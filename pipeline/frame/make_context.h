/// From a scene and the settings to the context of its frame.
#pragma once

#include "core/scene/render_context.h"
#include "pipeline/frame/render_settings.h"

namespace trapeze {

/// The context of a scene's render: camera, with the tile as its crop, sample counts (rounded to at least 1),
/// whether anything moves, colour management. It refers to the scene and to diagnostics.
RenderContext make_context(const Scene& scene, const RenderSettings& settings, Diagnostics& diagnostics);

}  // namespace trapeze
