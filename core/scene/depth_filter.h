/// Hider "depthfilter": what the depths of a pixel's samples make.
#pragma once

#include <string>

#include "core/scene/scene.h"

namespace trapeze {

/// Which depth a pixel gets from those of its samples. Midpoint: the nearest of the depths half-way between
/// the first two layers that each sample sees, for which a sample's hits beyond the first opaque one are
/// needed.
enum class DepthFilter { Min, Max, Average, Midpoint };

inline std::string depth_filter_name(const Options& options) {
    return options.hider_parameters.string_or("depthfilter", "min");
}

/// The scene's filter; Min for a name that is not known.
inline DepthFilter depth_filter(const Options& options) {
    const std::string name = depth_filter_name(options);
    if (name == "max") return DepthFilter::Max;
    if (name == "average") return DepthFilter::Average;
    return name == "midpoint" ? DepthFilter::Midpoint : DepthFilter::Min;
}

}  // namespace trapeze
