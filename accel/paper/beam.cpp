#include "accel/paper/beam.h"

#include <algorithm>
#include <cmath>

namespace trapeze {
namespace {

/// A range of floats; empty when min > max.
struct Interval {
    float min, max;
};

/// Cuts `depths`, none of them negative, to those at which origin + depth * slope may lie in [low, high] for
/// some origin and slope of their intervals. What no depth allows leaves depths.max at -1 or below
/// depths.min.
void cut(Interval& depths, const Interval& origin, const Interval& slope, float low, float high) {
    // The lowest place of the bundle is below `high`, the highest one above `low`.
    const float below = high - origin.min, above = origin.max - low;
    // origin.min + depth * slope.min <= high
    if (slope.min > 0)
        depths.max = std::min(depths.max, below / slope.min);
    else if (slope.min < 0)
        depths.min = std::max(depths.min, below / slope.min);
    else if (below < 0)
        depths.max = -1;
    // origin.max + depth * slope.max >= low
    if (slope.max < 0)
        depths.max = std::min(depths.max, -above / slope.max);
    else if (slope.max > 0)
        depths.min = std::max(depths.min, -above / slope.max);
    else if (above < 0)
        depths.max = -1;
}

/// The interval of factor * [min, max]; a negative factor turns it over.
Interval product(float factor, float min, float max) {
    return factor < 0 ? Interval{factor * max, factor * min} : Interval{factor * min, factor * max};
}

}  // namespace

Beam::Beam(std::span<const AxisRay> rays, std::span<const uint32_t> indices, DepthRange depths)
    : range(depths) {
    const AxisRay& first = rays[indices[0]];
    origin_min = origin_max = {first.ox, first.oy};
    slope_min = slope_max = {first.ux, first.uy};
    time_min = time_max = first.time;
    for (const uint32_t index : indices) {
        const AxisRay& ray = rays[index];
        origin_min = {std::min(origin_min.x, ray.ox), std::min(origin_min.y, ray.oy)};
        origin_max = {std::max(origin_max.x, ray.ox), std::max(origin_max.y, ray.oy)};
        slope_min = {std::min(slope_min.x, ray.ux), std::min(slope_min.y, ray.uy)};
        slope_max = {std::max(slope_max.x, ray.ux), std::max(slope_max.y, ray.uy)};
        time_min = std::min(time_min, ray.time), time_max = std::max(time_max, ray.time);
    }
}

bool Beam::meets(const AxesColumns& axes, const KeyBox& box, float absolute_max, float slack) const {
    // As TraceRay::rounding(), for the steepest ray that starts farthest out: it holds for all of them.
    const float steepest = std::max(std::abs(slope_min.x), std::abs(slope_max.x)) +
                           std::max(std::abs(slope_min.y), std::abs(slope_max.y));
    const float farthest = std::max(std::abs(origin_min.x), std::abs(origin_max.x)) +
                           std::max(std::abs(origin_min.y), std::abs(origin_max.y));
    const float rounding = kTraceRounding * (1 + steepest) * (absolute_max + 2 * farthest) + 0x1p-80f;
    const float nearest_depth = range.min - slack - rounding, farthest_depth = range.max + slack + rounding;
    // Ahead of the lens plane and, mirrored, behind it: the default near plane is so near that the slack
    // reaches there.
    Interval ahead{std::max(nearest_depth, 0.0f), farthest_depth};
    Interval behind{std::max(-farthest_depth, 0.0f), -nearest_depth};
    for (int k = 0; k < 3; ++k) {
        const auto& c = axes.column;
        const Interval ox = product(c[0][k], origin_min.x, origin_max.x);
        const Interval oy = product(c[1][k], origin_min.y, origin_max.y);
        const Interval ux = product(c[0][k], slope_min.x, slope_max.x);
        const Interval uy = product(c[1][k], slope_min.y, slope_max.y);
        // Origins are at z = 0, and directions have z = 1: only slopes get the axes' third column.
        const Interval origin{ox.min + oy.min, ox.max + oy.max};
        const Interval slope{ux.min + uy.min + c[2][k], ux.max + uy.max + c[2][k]};
        const float low = box.low[k] - rounding, high = box.high[k] + rounding;
        cut(ahead, origin, slope, low, high);
        cut(behind, origin, {-slope.max, -slope.min}, low, high);
    }
    return !(ahead.min > ahead.max) || !(behind.min > behind.max);
}

}  // namespace trapeze
