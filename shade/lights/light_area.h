/// The area of lights of simple shapes, which normalized ones are as dark by as they are large.
#pragma once

#include <cmath>

#include "core/portable_math.h"
#include "core/scene/light_shape.h"
#include "shade/lights/sphere_space.h"

namespace trapeze {

/// Of what a matrix with these rows makes of a sphere of this radius: its elements of area grow as its
/// adjugate makes their normals longer. Even steps along an axis are even shares of a sphere; to some 1e-5.
inline double area_of_ellipsoid(const V3d& x, const V3d& y, const V3d& z, double radius) {
    constexpr int kRings = 64, kSteps = 64;
    const V3d of_x = y.cross(z), of_y = z.cross(x), of_z = x.cross(y);
    double sum = 0;
    for (int i = 0; i < kSteps; ++i) {
        const double angle = 2 * kPi64 * i / kSteps;
        const V3d outwards = of_x * portable::cos(angle) + of_y * portable::sin(angle);
        for (int ring = 0; ring < kRings; ++ring) {
            const double height = (2 * ring + 1 - kRings) / static_cast<double>(kRings);
            sum += (outwards * std::sqrt(1 - height * height) + of_z * height).length();
        }
    }
    return 4 * kPi64 * radius * radius * sum / (kRings * kSteps);
}

/// Camera space, of a light at shutter open whose space the matrix takes there. 0 of lights of other kinds,
/// which have none or are meshes.
inline double area_of(LightShape::Kind kind, const M44f& camera_from_light) {
    constexpr double kRadius = 0.5;
    const auto axis = [&](int k) {
        return wide(V3f(camera_from_light[k][0], camera_from_light[k][1], camera_from_light[k][2]));
    };
    const V3d x = axis(0), y = axis(1), z = axis(2);
    switch (kind) {
        case LightShape::Kind::Rect:
            return x.cross(y).length();
        case LightShape::Kind::Disk:
            return kPi64 * kRadius * kRadius * x.cross(y).length();
        case LightShape::Kind::Sphere:
            return area_of_ellipsoid(x, y, z, kRadius);
        case LightShape::Kind::Cylinder: {
            // Round about x, along which it is open. Periodic and smooth: even steps give all digits.
            constexpr int kSteps = 256;
            double sum = 0;
            for (int i = 0; i < kSteps; ++i) {
                const double angle = 2 * kPi64 * i / kSteps;
                sum += x.cross(z * portable::cos(angle) - y * portable::sin(angle)).length();
            }
            return 2 * kPi64 * kRadius / kSteps * sum;
        }
        default:
            return 0;
    }
}

}  // namespace trapeze
