#include "pipeline/study/aff/aff_shapes.h"

#include <cmath>

namespace trapeze {
namespace {

constexpr double kAffTurn = 2 * 3.14159265358979323846;
constexpr int kSphereSides = 8, kSphereBands = 4;
constexpr int kConeSides = 12;
static_assert(kAffSphereTriangles == 2 * kSphereSides * (kSphereBands - 1));
static_assert(kAffConeTriangles == 2 * kConeSides);

V3d place_on_sphere(int side, int band) {
    const double around = kAffTurn * (side % kSphereSides) / kSphereSides,
                 down = kAffTurn / 2 * band / kSphereBands;
    if (band == 0 || band == kSphereBands) return {0, band == 0 ? 1.0 : -1.0, 0};
    return {std::sin(down) * std::cos(around), std::cos(down), std::sin(down) * std::sin(around)};
}

/// About 0 0 0, of radius 1.
std::vector<std::array<V3d, 3>> unit_sphere() {
    std::vector<std::array<V3d, 3>> triangles;
    for (int band = 0; band < kSphereBands; ++band)
        for (int side = 0; side < kSphereSides; ++side) {
            const V3d high = place_on_sphere(side, band), low = place_on_sphere(side, band + 1);
            const V3d next_high = place_on_sphere(side + 1, band),
                      next_low = place_on_sphere(side + 1, band + 1);
            if (band + 1 < kSphereBands) triangles.push_back({high, next_low, low});
            if (band > 0) triangles.push_back({high, next_high, next_low});
        }
    return triangles;
}

}  // namespace

std::vector<AffTriangle> sphere_triangles(const V3d& center, double radius) {
    static const std::vector<std::array<V3d, 3>> kUnit = unit_sphere();
    std::vector<AffTriangle> triangles;
    for (const std::array<V3d, 3>& t : kUnit)
        triangles.push_back(
            {V3f(center + radius * t[0]), V3f(center + radius * t[1]), V3f(center + radius * t[2])});
    return triangles;
}

std::vector<AffTriangle> cone_triangles(const V3d& base, double base_radius, const V3d& apex,
                                        double apex_radius) {
    const V3d axis = (apex - base).normalized();
    const V3d across = axis.cross(std::abs(axis.x) < .7 ? V3d(1, 0, 0) : V3d(0, 1, 0)).normalized();
    const V3d aside = axis.cross(across);
    const auto corner = [&](int side, const V3d& center, double radius) {
        const double angle = kAffTurn * (side % kConeSides) / kConeSides;
        return V3f(center + radius * (std::cos(angle) * across + std::sin(angle) * aside));
    };
    std::vector<AffTriangle> triangles;
    for (int side = 0; side < kConeSides; ++side) {
        const V3f low = corner(side, base, base_radius), high = corner(side, apex, apex_radius);
        const V3f next_low = corner(side + 1, base, base_radius),
                  next_high = corner(side + 1, apex, apex_radius);
        triangles.push_back({low, next_low, next_high});
        triangles.push_back({low, next_high, high});
    }
    return triangles;
}

}  // namespace trapeze
