/// What a ray of a shader stands for [Igehy99]: all rays between it and those beside it.
#pragma once

#include <algorithm>
#include <array>

#include "core/math.h"

namespace trapeze {

/// Camera space, like the ray. Where the rays beside it are not known it is a cone.
struct RayFootprint {
    /// From the ray to the one beside it, on either axis of what sends them: how far origins are apart, and
    /// unit directions.
    std::array<V3f, 2> origin{V3f(0, 0, 0), V3f(0, 0, 0)}, direction{V3f(0, 0, 0), V3f(0, 0, 0)};
    /// It is nowhere narrower than this at its beginning, and grows by `spread` on each unit of its way.
    float width = 0, spread = 0;

    /// Whether the rays beside it are known on both axes.
    bool is_known() const {
        return std::ranges::all_of(std::array{0, 1}, [&](int k) {
            return origin[k] != V3f(0, 0, 0) || direction[k] != V3f(0, 0, 0);
        });
    }
    /// The rest of the ray, from a distance on.
    RayFootprint behind(float distance) const {
        RayFootprint rest = *this;
        for (int k = 0; k < 2; ++k) rest.origin[k] += direction[k] * distance;
        rest.width += spread * distance;
        return rest;
    }
    /// How much wider it grows on each unit of its way, where it does so most.
    float fastest() const { return std::max({spread, direction[0].length(), direction[1].length()}); }
    /// How wide it is at its beginning, where it is widest.
    float widest() const { return std::max({width, origin[0].length(), origin[1].length()}); }
};

}  // namespace trapeze
