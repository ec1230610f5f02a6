/// Which Displays ask for deep pictures, and how they merge samples.
#pragma once

#include <algorithm>
#include <optional>

#include "core/scene/scene.h"

namespace trapeze {

/// Depths of one primitive in a pixel become one sample where they differ by no more than this share of the
/// depth.
inline constexpr float kUsualDeepTolerance = 0.01f;

inline bool is_deep(const Display& display) {
    return display.has_driver("deepexr");
}

/// The tolerance of the picture's deep pixels: that of the first Display of driver "deepexr" ("float
/// deeptolerance"); nothing where there is no such Display.
inline std::optional<float> deep_tolerance(const Options& options) {
    const auto found = std::ranges::find_if(options.displays, is_deep);
    if (found == options.displays.end()) return {};
    const float asked = found->parameters.float_or("deeptolerance", kUsualDeepTolerance);
    return asked > 0 ? std::min(asked, 1.0f) : 0.0f;
}

}  // namespace trapeze
