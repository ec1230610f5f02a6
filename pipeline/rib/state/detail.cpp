/// Levels of detail (RISpec 4.2.7): how large a bound is on the picture, and what of a primitive that leaves.
#include <algorithm>
#include <cmath>

#include "core/scene/camera.h"
#include "pipeline/rib/state/graphics_state_stack.h"

namespace trapeze::rib {

/// RISpec shows a primitive wholly within the inner range and mixes neighbouring levels across transitions:
/// what grows has the samples from 0 on, what fades those up to 1, divided at the same number to the bit.
SeenNumbers Detail::seen() const {
    const auto passed = [this](float begin, float end) { return (size - begin) / (end - begin); };
    if (size < least || size > most) return {0, 0};
    if (size < full_from) return {0, passed(least, full_from)};
    if (size > full_to && !std::isinf(most)) return {passed(full_to, most), 1};
    return {0, 1};
}

/// The eight corners are projected, those behind the eye from just before it: what reaches round the eye is
/// as large as can be. Taken as the shutter opens, and not clipped at the edges of the picture: what is half
/// out of sight keeps its level of detail as it comes in.
float GraphicsStateStack::raster_area(const std::vector<float>& bound) const {
    constexpr float kInfinite = std::numeric_limits<float>::infinity();
    if (in_object()) return kInfinite;
    const Camera camera = make_camera(scope_.options);
    const M44f to_camera = camera_from_current();
    const float nearest = std::max(camera.near_clip, kEpsilon);
    V2f low(kInfinity), high(-kInfinity);
    for (int corner = 0; corner < 8; ++corner) {
        V3f p;
        to_camera.multVecMatrix(
            V3f(bound[corner & 1], bound[2 + (corner >> 1 & 1)], bound[4 + (corner >> 2 & 1)]), p);
        if (camera.perspective) p.z = std::max(p.z, nearest);  // what reaches behind the eye is large
        const V2f raster = camera.raster_from_camera(p);
        low = {std::min(low.x, raster.x), std::min(low.y, raster.y)};
        high = {std::max(high.x, raster.x), std::max(high.y, raster.y)};
    }
    const float area = (high.x - low.x) * (high.y - low.y) * scope_.relative_detail;
    return std::isnan(area) ? kInfinite : area;
}

}  // namespace trapeze::rib
