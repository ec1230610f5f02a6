/// Hider "depthfilter": what the depths of a pixel's samples make.
#pragma once

#include <algorithm>
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

/// Which of a sample's layers its depth is of: as PRMan has it, not of those that let more light through than
/// Option "limits" "zthreshold" says.
struct DepthRule {
    bool midpoint = false;       ///< half-way between the first two; else of the first
    V3f least_opacity{0, 0, 0};  ///< of a layer that counts, in every channel; 0: all count

    bool is_plain() const { return !midpoint && least_opacity == V3f(0, 0, 0); }
};

inline DepthRule depth_rule(const Options& options) {
    DepthRule rule{depth_filter(options) == DepthFilter::Midpoint};
    const Parameter* const least = options.user.find("limits", "zthreshold");
    for (size_t k = 0; least && !least->floats.empty() && k < 3; ++k)
        rule.least_opacity[static_cast<int>(k)] = least->floats[std::min(k, least->floats.size() - 1)];
    return rule;
}

}  // namespace trapeze
