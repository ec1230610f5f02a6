/// Hider "maxvpdepth": how many layers of surfaces a sample may see.
#pragma once

#include <cstdint>

#include "core/scene/scene.h"

namespace trapeze {

/// A sample sees all layers.
inline constexpr uint32_t kAllLayers = ~uint32_t{0};
/// The most that may be asked for by number.
inline constexpr float kMostLayers = 1e6f;

/// The scene's limit: of each sample's layers the nearest so many; at least 1.
inline uint32_t layer_limit(const Options& options) {
    const float given = options.hider_parameters.float_or("maxvpdepth", -1);
    return given >= 1 && given <= kMostLayers ? static_cast<uint32_t>(given) : kAllLayers;
}

}  // namespace trapeze
