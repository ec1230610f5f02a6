#include "core/scene/aperture.h"

#include <algorithm>
#include <cmath>

#include "core/scene/scene.h"

namespace trapeze {

Aperture aperture_of(const Options& options) {
    const Parameter* given = options.hider_parameters.find("aperture");
    if (!given || given->floats.size() < 4) return {};
    const float blades = std::clamp(given->floats[0], 0.0f, Aperture::kMostBlades + 1.0f);
    return {static_cast<int>(blades), std::fmod(given->floats[1], 360.0f),
            std::clamp(given->floats[2], -1.0f, 1.0f), std::clamp(given->floats[3], -1.0f, 1.0f)};
}

}  // namespace trapeze
