/// Places on round pieces of lights, by two numbers of 0 to 1: all of a piece's area alike. They begin at the
/// side that a point sees, so that numbers which are well apart are so on what it sees.
#pragma once

#include <algorithm>
#include <cmath>

#include "core/scene/light_shape.h"
#include "shade/lights/sphere_space.h"

namespace trapeze {

/// A place and its normal, of unit length, outwards.
struct SurfacePlace {
    V3d P{0, 0, 0}, N{0, 0, 1};
};

inline double area_of(const LightMesh::Ball& ball) {
    const double radius = static_cast<double>(ball.radius);
    return 4 * kPi64 * radius * radius;
}

/// Without its ends.
inline double area_of(const LightMesh::Tube& tube) {
    const double from = static_cast<double>(tube.from_radius), to = static_cast<double>(tube.to_radius);
    const double length2 = (wide(tube.to) - wide(tube.from)).length2();
    return length2 > 0 ? kPi64 * (from + to) * std::sqrt(length2 + (to - from) * (to - from)) : 0;
}

inline SurfacePlace place_on(const LightMesh::Ball& ball, const V3d& seen_from, double x, double y) {
    const V3d middle = wide(ball.middle), away = seen_from - middle;
    const double length = away.length(), height = 1 - 2 * x;
    const double sine = std::sqrt(std::max(0.0, 1 - height * height));
    const V3d N = AxesAround(length > 0 ? away / length : V3d(0, 0, 1)).around(sine, height, y);
    return {middle + N * static_cast<double>(ball.radius), N};
}

/// x is along the tube, y around it.
inline SurfacePlace place_on(const LightMesh::Tube& tube, const V3d& seen_from, double x, double y) {
    const V3d begin = wide(tube.from), whole = wide(tube.to) - begin, axis = whole.normalized();
    const double from = static_cast<double>(tube.from_radius), to = static_cast<double>(tube.to_radius);
    // The area up to a part of the way grows with the square where the tube widens.
    const double at = x * (from + to) / (from + std::sqrt(from * from + (to * to - from * from) * x));
    const V3d away = seen_from - begin, across = away - axis * away.dot(axis);
    const AxesAround<double> axes(axis);
    const V3d side = across.length2() > 0 ? across.normalized() : axes.across;
    const double angle = 2 * kPi64 * y, rise = to - from, length = whole.length();
    const V3d out = side * portable::cos(angle) + axis.cross(side) * portable::sin(angle);
    return {begin + whole * at + out * (from + rise * at), (out * length - axis * rise).normalized()};
}

}  // namespace trapeze
