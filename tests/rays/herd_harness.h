/// Herds: instances of one object here and there, and where rays meet them.
#pragma once

#include <sstream>

#include "tests/rays/ray_world_harness.h"

namespace trapeze::testing {

inline const std::string kPerspectiveView = "Projection \"perspective\" \"fov\" 40 Format 256 256 1 ";
inline const std::string kOrthographicView = "Format 256 256 1 ";
inline const std::string kBallObject = "ObjectBegin 1 Sphere 1 -1 1 360 ObjectEnd ";
/// A box of six primitives, whose edges are shared by nothing but their places.
inline const std::string kBoxObject =
    "ObjectBegin 1 Polygon \"P\" [-1 -1 -1 1 -1 -1 1 1 -1 -1 1 -1] Polygon \"P\" [-1 -1 1 -1 1 1 1 1 1 1 -1 1] "
    "Polygon \"P\" [-1 -1 -1 -1 -1 1 1 -1 1 1 -1 -1] Polygon \"P\" [-1 1 -1 1 1 -1 1 1 1 -1 1 1] "
    "Polygon \"P\" [-1 -1 -1 -1 1 -1 -1 1 1 -1 -1 1] Polygon \"P\" [1 -1 -1 1 -1 1 1 1 1 1 1 -1] ObjectEnd ";

inline std::string text(const V3f& v) {
    return std::to_string(v.x) + ' ' + std::to_string(v.y) + ' ' + std::to_string(v.z) + ' ';
}

inline std::string in_scientific(double value) {
    std::ostringstream out;
    out << std::scientific << value;
    return out.str();
}

/// Where things are.
struct Herd {
    std::vector<V3f> places;
    float radius;

    /// Far enough away that each may share, at distances of 1 to 3.
    explicit Herd(int count, float size = .5f) : radius(size) {
        RayNumbers number;
        for (int i = 0; i < count; ++i) places.emplace_back(number(-6, 6), number(-6, 6), number(10, 30));
    }

    /// Each with `before` before it.
    std::string with(const std::string& thing, const std::function<std::string(size_t)>& before = {}) const {
        std::string all;
        for (size_t i = 0; i < places.size(); ++i)
            all += "AttributeBegin " + (before ? before(i) : "") + "Translate " + text(places[i]) + "Scale " +
                   text(V3f(radius)) + thing + " AttributeEnd ";
        return all;
    }
    /// The nearest ball along a ray, and how far away it is; -1: none.
    std::pair<int, float> nearest(const RaySegment& ray, float& silhouette) const {
        std::pair<int, float> best{-1, kInfinity};
        silhouette = kInfinity;
        for (size_t i = 0; i < places.size(); ++i) {
            const V3f to = places[i] - ray.origin;
            const float along = to.dot(ray.direction), aside = (to - ray.direction * along).length();
            silhouette = std::min(silhouette, std::abs(aside - radius));
            const float half = std::sqrt(std::max(radius * radius - aside * aside, 0.0f));
            const float distance = along - half > 0 ? along - half : along + half;
            if (aside < radius && distance > 0 && distance < best.second)
                best = {static_cast<int>(i), distance};
        }
        return best;
    }
};

inline RaySegment some_ray(RayNumbers& number, const Herd& herd, float spread = 0) {
    const V3f from{number(-8, 8), number(-8, 8), number(8, 32)};
    const auto target = static_cast<size_t>(number(0, static_cast<float>(herd.places.size()) - .01f));
    return ray_to(from, herd.places[target] + number.in_cube(herd.radius) - from, spread);
}

}  // namespace trapeze::testing
