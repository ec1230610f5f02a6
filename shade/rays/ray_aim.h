/// Where a point's rays begin and lead.
#pragma once

#include <algorithm>
#include <cmath>

#include "core/math.h"

namespace trapeze {

struct RayAim {
    V3f P, direction{0, 0, 0};  ///< the direction has unit length where it leads anywhere
    float length = 0;           ///< of the way
    float time = 0;             ///< in the shutter

    RayAim(const V3f& from, const V3f& way, float at_time) : P(from), time(at_time) {
        // Squares of very long ways are not finite.
        const float largest = std::max({std::abs(way.x), std::abs(way.y), std::abs(way.z)});
        const auto is_finite = [](const V3f& v) {
            return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z);
        };
        if (!is_finite(P) || !is_finite(way) || !(largest > 0)) return;
        direction = (way / largest).normalized();
        length = largest * (way / largest).length();
    }
    /// Else no ray can be sent.
    bool leads() const { return length > 0; }
};

}  // namespace trapeze
