/// Lanes of lookups, as map_lookups.h has them.
#pragma once

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>

#include "core/math.h"
#include "shade/maps/map_lookups.h"

namespace trapeze::map_lanes {

/// A lane of an input, which may be uniform (its first value holds) or empty (zero). What is not finite
/// counts as zero.
inline float value(ConstPlane plane, size_t i) {
    if (plane.empty()) return 0;
    const float v = plane[i < plane.size() ? i : 0];
    return std::isfinite(v) ? v : 0;
}

inline V3f value(const ConstPlane3& planes, size_t i) {
    return {value(planes.x, i), value(planes.y, i), value(planes.z, i)};
}

/// Whether the mask wants a lane.
inline bool is_on(const Lanes& lanes, size_t i) {
    return lanes.mask.empty() || std::bit_cast<uint32_t>(lanes.mask[i < lanes.mask.size() ? i : 0]) != 0;
}

/// Gives the lanes past the last one that one's value, as all planes have it.
inline void pad(const Lanes& lanes, Plane out) {
    if (lanes.count > 0 && lanes.count < out.size())
        std::fill(out.begin() + static_cast<std::ptrdiff_t>(lanes.count), out.end(), out[lanes.count - 1]);
}

/// Sets the wanted lanes to one value.
inline void set_all(const Lanes& lanes, Plane out, float value) {
    for (size_t i = 0; i < lanes.count; ++i)
        if (is_on(lanes, i)) out[i] = value;
    pad(lanes, out);
}

}  // namespace trapeze::map_lanes
