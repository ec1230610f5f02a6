/// Problems of a scene's shaders and maps that can be found without rendering it, for `trapeze` runs that
/// only check.
#pragma once

#include <functional>
#include <string_view>

#include "core/files/access.h"
#include "core/scene/render_context.h"

namespace trapeze {

/// Whether the map of a name will have been made by the time that it is looked up, and so may be missing now.
using MapIsMade = std::function<bool(std::string_view name)>;

/// Makes every shader of the scene and opens the maps that they name; reports to the context's diagnostics
/// what Shading would: shaders and maps that are not there, that have errors, values that do not fit. Of
/// primitives only the attributes and the declarations of their variables count.
void check_looks(const RenderContext& context, const MapIsMade& is_made, const Access& access = kEverything);

}  // namespace trapeze
