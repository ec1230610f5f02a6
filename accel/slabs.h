/// Rays in the axes of oriented boxes, and slab tests there: the interval of depths in which a ray is
/// between each pair of planes, cut with each other. Loops run over four lanes, the three axes and one that
/// is never decisive, so that compilers make a vector operation of each.
#pragma once

#include <cmath>

#include "accel/trace_ray.h"
#include "core/hit_micropolygon.h"
#include "core/hyper_trapezoid.h"

namespace trapeze {

/// Axes by columns, as four lanes want it: coordinate k of a point is sum over i of column[i][k] *
/// point[i]. Lane 3 is 0.
struct alignas(16) AxesColumns {
    float column[3][4] = {};

    AxesColumns() = default;
    explicit AxesColumns(const Axes& axes) {
        for (int k = 0; k < 3; ++k)
            for (int i = 0; i < 3; ++i) column[i][k] = axes.axis[k][i];
    }
};

/// A box in some axes at one motion key. Lane 3 is [-1, 1] about an origin of 0, which every ray passes.
struct alignas(16) KeyBox {
    float low[4] = {0, 0, 0, -1}, high[4] = {0, 0, 0, 1};
};

/// The least component of a direction across a slab: nearer ones are taken as this. Products stay finite
/// where 1 / 0 would make a NaN of 0 * infinity, and what it moves a ray is far below its rounding.
inline constexpr float kLeastDirection = 1e-18f;

/// A ray as slab tests read it: origin and one over its direction along some axes. The direction is scaled
/// so that slab depths are depths of the TraceRay.
struct alignas(16) RayInAxes {
    float origin[4], inverse_direction[4];

    RayInAxes() = default;

    /// For boxes along the axes of space, of which no rotation is needed.
    explicit RayInAxes(const TraceRay& ray) {
        for (int k = 0; k < 3; ++k)
            origin[k] = ray.origin[k], inverse_direction[k] = inverse(ray.direction[k]);
        origin[3] = 0, inverse_direction[3] = inverse(0);
    }
    /// For oriented boxes. Rounds by less than TraceRay::rounding() allows for.
    RayInAxes(const AxesColumns& axes, const TraceRay& ray) {
        const auto& c = axes.column;
        for (int k = 0; k < 4; ++k)
            origin[k] = (c[0][k] * ray.origin.x + c[1][k] * ray.origin.y) + c[2][k] * ray.origin.z;
        float direction[4];
        for (int k = 0; k < 4; ++k)
            direction[k] =
                (c[0][k] * ray.direction.x + c[1][k] * ray.direction.y) + c[2][k] * ray.direction.z;
        for (int k = 0; k < 4; ++k) inverse_direction[k] = inverse(direction[k]);
    }

  private:
    static float inverse(float d) { return 1.0f / (std::abs(d) < kLeastDirection ? kLeastDirection : d); }
};

/// Depths between which a ray is inside a box; empty when near > far. A NaN makes no bound: such a box is
/// met.
struct DepthInterval {
    float near, far;

    /// Whether hits within the ray's range may be inside; *depth becomes a lower bound of theirs. Hits may
    /// be `slack` outside of the interval: the predicate's depth lies within the micropolygon's own range of
    /// depths, but not always within an oriented box about it [decision 0004].
    bool meets(const TraceRay& ray, float slack, float& depth) const {
        // Negated comparisons let NaN in; & instead of && leaves no branch that would be predicted wrongly.
        depth = near - slack;
        return !(near > far) & !(far + slack < ray.t_min) & !(depth > ray.t_max);
    }
};

/// Depths in a moving box: `from` and `to` are its boxes at two keys, in the ray's axes, local_time in [0,
/// 1] the way between them. The box is grown by `rounding` on all sides, by moving near and far instead of
/// its planes.
inline DepthInterval clip(const RayInAxes& ray, const KeyBox& from, const KeyBox& to, float local_time,
                          float rounding) {
    float near[4], far[4];
    for (int k = 0; k < 4; ++k) {
        const float low = position_at(from.low[k], to.low[k] - from.low[k], local_time);
        const float high = position_at(from.high[k], to.high[k] - from.high[k], local_time);
        const float a = (low - ray.origin[k]) * ray.inverse_direction[k];
        const float b = (high - ray.origin[k]) * ray.inverse_direction[k];
        const float pad = rounding * std::abs(ray.inverse_direction[k]);
        near[k] = (a < b ? a : b) - pad;
        far[k] = (a < b ? b : a) + pad;
    }
    const float near_xy = near[0] > near[1] ? near[0] : near[1];
    const float far_xy = far[0] < far[1] ? far[0] : far[1];
    return {near_xy > near[2] ? near_xy : near[2], far_xy < far[2] ? far_xy : far[2]};
}

}  // namespace trapeze
