/// Which Displays ask for deep pictures, and how they merge samples.
#pragma once

#include <algorithm>
#include <cctype>
#include <optional>
#include <string_view>

#include "core/scene/scene.h"

namespace trapeze {

/// Depths of one primitive in a pixel become one sample where they differ by no more than this share of the
/// depth.
inline constexpr float kUsualDeepTolerance = 0.01f;

/// Whether a Display's driver is "deepexr", whose case does not count, as no driver's does.
inline bool is_deep(const Display& display) {
    constexpr std::string_view kDriver = "deepexr";
    return std::ranges::equal(display.type, kDriver, {}, [](unsigned char c) { return std::tolower(c); });
}

/// The tolerance of the picture's deep pixels: that of the first Display of driver "deepexr" ("float
/// deeptolerance"); nothing where there is no such Display.
inline std::optional<float> deep_tolerance(const Options& options) {
    const auto found = std::ranges::find_if(options.displays, is_deep);
    if (found == options.displays.end()) return {};
    return std::clamp(found->parameters.float_or("deeptolerance", kUsualDeepTolerance), 0.0f, 1.0f);
}

}  // namespace trapeze
