#include "shade/rays/ray_grounds.h"

#include <bit>
#include <cmath>
#include <utility>

#include "core/random.h"

namespace trapeze {
namespace {

/// So that a ray of a point that lies on what rays meet comes by it for sure; in roundings.
constexpr float kBefore = 2;
/// Where one look down finds the surface: as far outside of the point, of its reach, and as far inside.
constexpr float kNear = 1.0f / 6;

using Hits = std::vector<std::optional<RaySurfaceHit>>;
/// Filters of one primitive each.
using Filters = std::unordered_map<uint32_t, RayFilter>;

/// Along the normal, or against it, from a height above the point to another one.
RaySegment look_along(const LeavingPoint& point, float from, float to, Filters& filters) {
    RayFilter& only = filters[point.primitive];
    only.sides = RayFilter::Sides::Both, only.primitive = point.primitive,
    only.facets = RayFilter::Facets::AllTimes;
    RaySegment ray;
    ray.origin = point.P + point.normal * from;
    ray.direction = from < to ? point.normal : -point.normal;
    ray.max = std::abs(to - from);
    ray.level = point.level, ray.number = point.number;
    ray.only = &only;
    return ray;
}

/// Whether a hit is of the side of the surface that the point is on.
bool is_of(const std::optional<RaySurfaceHit>& hit, const LeavingPoint& point) {
    constexpr float kEdgeOn = 0.1f;
    return hit && hit->facet->at(0).hit.normal.dot(point.normal) > kEdgeOn;
}

/// The nearest one of each, on either side.
Hits look_around(const RayScene& scene, RayKind kind, std::span<const LeavingPoint> points) {
    Filters filters;
    std::vector<RaySegment> rays;
    for (const LeavingPoint& point : points) {
        const float before = kBefore * point.rounding;
        rays.push_back(look_along(point, -before, point.reach, filters));
        rays.push_back(look_along(point, before, -point.reach, filters));
    }
    Hits hits = closest_hits(scene, kind, rays);
    Hits nearest;
    for (size_t i = 0; i < points.size(); ++i) {
        const auto way = [&](const std::optional<RaySurfaceHit>& hit) {
            return is_of(hit, points[i]) ? std::abs(hit->distance - kBefore * points[i].rounding) : kInfinity;
        };
        std::optional<RaySurfaceHit>&outside = hits[2 * i], &inside = hits[2 * i + 1];
        nearest.push_back(std::move(way(inside) < way(outside) ? inside : outside));
    }
    return nearest;
}

/// As look_around(), at half the price where surfaces are no rougher than the micropolygons that rays meet.
std::vector<RayGrounds::Ground> look(const RayScene& scene, RayKind kind,
                                     std::span<const LeavingPoint> points) {
    Filters filters;
    std::vector<RaySegment> rays;
    for (const LeavingPoint& point : points)
        rays.push_back(look_along(point, kNear * point.reach, -kNear * point.reach, filters));
    Hits hits = closest_hits(scene, kind, rays);
    std::vector<LeavingPoint> rest;
    for (size_t i = 0; i < points.size(); ++i)
        if (!is_of(hits[i], points[i])) rest.push_back(points[i]);
    Hits farther = look_around(scene, kind, rest);
    std::vector<RayGrounds::Ground> grounds(points.size());
    for (size_t i = 0, next = 0; i < points.size(); ++i) {
        if (!is_of(hits[i], points[i])) hits[i] = std::move(farther[next++]);
        if (is_of(hits[i], points[i])) grounds[i] = std::make_shared<RayFacet>(std::move(*hits[i]->facet));
    }
    return grounds;
}

}  // namespace

std::vector<std::optional<RaySurfaceHit>> closest_hits(const RayScene& scene, RayKind kind,
                                                       std::span<const RaySegment> rays) {
    std::vector<std::optional<RaySurfaceHit>> hits(rays.size());
    if (rays.empty()) return hits;
    std::vector<const RaySegment*> all;
    for (const RaySegment& ray : rays) all.push_back(&ray);
    scene.closest(all, kind, hits);
    return hits;
}

size_t RayGrounds::Hash::operator()(const Asked& asked) const {
    const V3f& P = asked.point.P;
    return hash(std::bit_cast<uint32_t>(P.x), std::bit_cast<uint32_t>(P.y), std::bit_cast<uint32_t>(P.z),
                asked.point.primitive);
}

std::vector<RayGrounds::Ground> RayGrounds::of(const RayScene& scene, RayKind kind,
                                               std::span<const LeavingPoint> points) {
    std::vector<Ground> grounds(points.size());
    std::vector<LeavingPoint> unknown;
    std::vector<size_t> numbers;
    for (size_t i = 0; i < points.size(); ++i) {
        if (const auto known = known_.find({points[i], kind}); known != known_.end())
            grounds[i] = known->second;
        else
            unknown.push_back(points[i]), numbers.push_back(i);
    }
    std::vector<Ground> found = look(scene, kind, unknown);
    for (size_t k = 0; k < unknown.size(); ++k) {
        if (unknown[k].is_vertex) known_.emplace(Asked{unknown[k], kind}, found[k]);
        grounds[numbers[k]] = std::move(found[k]);
    }
    return grounds;
}

}  // namespace trapeze
