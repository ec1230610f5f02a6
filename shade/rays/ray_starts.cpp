#include "shade/rays/ray_starts.h"

namespace trapeze {
namespace {

/// Begins a ray somewhere else; where it is said to begin stays.
void move_to(const V3f& origin, WalkedRay& ray) {
    const V3f moved = origin - ray.segment.origin;
    const float along = moved.dot(ray.segment.direction);
    ray.moved += moved, ray.segment.origin = origin;
    ray.segment.max -= along, ray.end -= along;
    ray.segment.min = 0;
}

}  // namespace

void RayStarts::add(size_t ray, const LeavingPoint& point, const V3f& meant) {
    if (points_.empty() || !(points_.back() == point)) points_.push_back(point);
    starts_.push_back({ray, points_.size() - 1, meant.dot(point.normal) >= 0});
}

/// Begins a ray on the micropolygon below it, in front of it or behind.
RayStarts::Way RayStarts::begin(const Start& start, WalkedRay& ray) const {
    const LeavingPoint& point = points_[start.point];
    const FacetPose facet = grounds_[start.point]->at(ray.segment.time);
    const float side = start.outside ? 1 : -1;
    const V3f direction = ray.segment.direction;
    const bool above = side * direction.dot(facet.hit.normal) > 0;
    const bool above_other = side * direction.dot(facet.other.normal) > 0;
    const bool meets_other = above != above_other && facet.other.is_ahead(facet.inner, direction);
    // Both triangles in a row are none to the ray [core/hit_micropolygon.h].
    const bool in_front = above || meets_other;
    move_to(facet.inner + facet.hit.normal * (in_front ? side * point.rounding : -side * point.rounding),
            ray);
    // The own micropolygon does not count, whatever rounds.
    ray.segment.left = {.most = point.reach, .half = point.rounding / 2, .normal = facet.hit.normal};
    return !in_front ? Way::FromBehind : meets_other && above ? Way::Into : Way::Away;
}

/// Of rays that begin behind their micropolygons: those that come out in time begin there. The others are
/// added to `into`.
void RayStarts::come_out(const RayScene& scene, RayKind kind, std::span<const Start> behind,
                         std::span<WalkedRay> rays, std::vector<Start>& into) const {
    RayFilter all;
    all.sides = RayFilter::Sides::Both, all.facets = RayFilter::Facets::ThisTime;
    std::vector<RaySegment> segments;
    for (const Start& start : behind) {
        RaySegment& segment = segments.emplace_back(rays[start.ray].segment);
        segment.max = points_[start.point].reach, segment.only = &all, segment.left = {};
    }
    const std::vector<std::optional<RaySurfaceHit>> hits = closest_hits(scene, kind, segments);
    for (size_t i = 0; i < behind.size(); ++i) {
        RaySegment& ray = rays[behind[i].ray].segment;
        const bool comes_out =
            hits[i] && (hits[i]->facet->at(ray.time).hit.normal.dot(ray.direction) > 0) == behind[i].outside;
        if (!comes_out) {
            into.push_back(behind[i]);
            continue;
        }
        ray.min = hits[i]->distance;
        ray.left.half = -kInfinity;  // all that it meets behind counts
        ray.passed.begin_behind(hits[i]->place);
    }
}

/// Rays that meet the micropolygon on which they begin, where that counts.
void RayStarts::meet_grounds(const RayScene& scene, RayKind kind, std::span<const Start> into,
                             std::span<WalkedRay> rays) {
    std::vector<RaySegment> segments;
    for (const Start& start : into) {
        const FacetPose facet = grounds_[start.point]->at(rays[start.ray].segment.time);
        const float rounding = points_[start.point].rounding;
        const V3f out = start.outside ? facet.hit.normal : -facet.hit.normal;
        move_to(facet.inner + out * rounding, rays[start.ray]);
        RaySegment& segment = segments.emplace_back(rays[start.ray].segment);
        segment.direction = -out;
        segment.max = 3 * rounding, segment.left = {};
    }
    met_ = closest_hits(scene, kind, segments);
    for (size_t i = 0; i < into.size(); ++i) {
        if (!met_[i]) continue;
        met_[i]->distance = 0;
        rays[into[i].ray].first = &*met_[i];
    }
}

void RayStarts::settle(const RayScene& scene, RayKind kind, RayGrounds& grounds, std::span<WalkedRay> rays) {
    if (starts_.empty()) return;
    grounds_ = grounds.of(scene, kind, points_);
    std::vector<Start> behind, into;
    for (const Start& start : starts_) {
        if (!grounds_[start.point]) continue;
        const Way way = begin(start, rays[start.ray]);
        if (way == Way::FromBehind) behind.push_back(start);
        if (way == Way::Into) into.push_back(start);
    }
    come_out(scene, kind, behind, rays, into);
    meet_grounds(scene, kind, into, rays);
    points_.clear(), starts_.clear(), grounds_.clear();
}

}  // namespace trapeze
