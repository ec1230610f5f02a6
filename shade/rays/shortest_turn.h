/// The shortest turn from one direction to another.
#pragma once

#include "core/math.h"

namespace trapeze {

/// A direction turned as what leads from one unit vector to another by the shortest way; where none does, as
/// it is.
inline V3f turned_from(const V3f& from, const V3f& to, const V3f& direction) {
    const V3f axis = from.cross(to);
    const float cosine = from.dot(to);
    constexpr float kNearlyOpposite = -0.999f;
    const bool are_unit = from != V3f(0, 0, 0) && to != V3f(0, 0, 0);
    if (!are_unit || !(cosine > kNearlyOpposite)) return direction;
    return direction * cosine + axis.cross(direction) + axis * (axis.dot(direction) / (1 + cosine));
}

}  // namespace trapeze
