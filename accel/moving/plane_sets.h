/// Pairs of parallel planes of a few fixed directions, between which things that move are: bounds that fit
/// more closely than boxes, for more numbers [Kay86]. As moving bounds the planes have a place at each motion
/// key and are between them in between [Christensen06]; or they are planes of space-time, which lean so that
/// a point that moves at their speed stays on them, and have one place [Glassner88].
#pragma once

#include <algorithm>
#include <array>
#include <limits>

#include "core/math.h"
#include "core/motion_keys.h"

namespace trapeze {

/// All planes on which normal . p + by_time * t is some number; p in space, t the time of the shutter, 0
/// to 1.
struct PlaneSet {
    V3f normal;  ///< of unit length
    float by_time = 0;

    float at(const V3f& p, float time01) const {
        return (normal.x * p.x + normal.y * p.y) + (normal.z * p.z + by_time * time01);
    }
};

/// The sets that a tree's bounds have, at most as many as there are lanes for.
struct PlaneSets {
    static constexpr size_t kLanes = 8;

    std::array<PlaneSet, kLanes> set{};
    size_t count = 0;

    void add(const V3f& normal, float by_time = 0) { set[count++] = {normal, by_time}; }

    /// The axes and the diagonals of a cube: fourteen faces, which move [Kay86 sec. 4].
    static PlaneSets of_cube() {
        PlaneSets sets;
        for (const V3f& axis : {V3f(1, 0, 0), V3f(0, 1, 0), V3f(0, 0, 1)}) sets.add(axis);
        for (const V3f& way : {V3f(1, 1, 1), V3f(-1, 1, 1), V3f(1, -1, 1), V3f(1, 1, -1)})
            sets.add(way.normalized());
        return sets;
    }
    /// For each axis two that lean to either side: twelve faces of space-time. `speed`: that of what stays on
    /// one of them, along each axis, in a shutter.
    static PlaneSets of_space_time(const V3f& speed) {
        PlaneSets sets;
        for (int axis = 0; axis < 3; ++axis)
            for (const float side : {-1.0f, 1.0f}) {
                V3f normal(0);
                normal[axis] = 1;
                sets.add(normal, side * speed[axis]);
            }
        return sets;
    }
};

/// Between which planes of each set something is. Lanes without a set are [-1, 1] about an origin of 0, which
/// every ray passes.
struct alignas(32) PlaneExtents {
    float low[PlaneSets::kLanes], high[PlaneSets::kLanes];

    /// Of nothing.
    static PlaneExtents empty(const PlaneSets& sets) {
        PlaneExtents e;
        for (size_t k = 0; k < PlaneSets::kLanes; ++k) {
            const bool is_set = k < sets.count;
            e.low[k] = is_set ? std::numeric_limits<float>::infinity() : -1;
            e.high[k] = is_set ? -std::numeric_limits<float>::infinity() : 1;
        }
        return e;
    }
    void extend(const PlaneSets& sets, const V3f& p, float time01) {
        for (size_t k = 0; k < sets.count; ++k) {
            const float at = sets.set[k].at(p, time01);
            low[k] = std::min(low[k], at), high[k] = std::max(high[k], at);
        }
    }
    void extend(const PlaneExtents& other) {
        for (size_t k = 0; k < PlaneSets::kLanes; ++k)
            low[k] = std::min(low[k], other.low[k]), high[k] = std::max(high[k], other.high[k]);
    }
};

}  // namespace trapeze
