#include "shade/rays/ray_starts.h"

#include <cmath>
#include <unordered_map>

#include "core/scene/motion_turn.h"

namespace trapeze {
namespace {

/// Begins a ray somewhere else; where it is said to begin stays.
void move_to(const V3f& origin, WalkedRay& ray) {
    const V3f moved = origin - ray.segment.origin;
    const float along = moved.dot(ray.segment.direction);
    ray.moved += moved, ray.segment.origin = origin;
    ray.segment.max -= along, ray.end -= along, ray.segment.reached.distance -= along;
    ray.segment.min = 0;
}

/// Aims a ray from where it begins at where it goes to.
void aim(const V3f& from, const LeavingRay& leaving, WalkedRay& ray) {
    const V3f way = *leaving.towards - from;
    const float length = way.length();
    if (!(length > 0)) return;
    ray.segment.direction = way / length;
    if (!leaving.ends) return;
    const float before = ray.end - ray.segment.max;
    ray.end = length, ray.segment.max = length - before;
    if (ray.segment.reached.distance < kInfinity) ray.segment.reached.distance = length;
}

/// Turns a direction as a micropolygon has turned since the shutter opened, of which `turn` is a part.
void turn_along(const RayFacet& facet, const FacetPose& now, const M33f& turn, RaySegment& ray) {
    const V3f before = (facet.at(0).hit.normal * turn).normalized();
    ray.direction = turned_from(before, now.hit.normal, ray.direction);
}

/// Whether a ray ends so near to where it begins that it may be on the same micropolygon.
bool ends_on(const FacetPose& facet, const RaySegment& ray) {
    const ReachedPlace& reached = ray.reached;
    if (!(reached.sure() <= 0)) return false;
    const V3f end = ray.origin + ray.direction * reached.distance;
    return std::abs((end - facet.inner).dot(facet.hit.normal)) <= reached.end.half;
}

/// Of some rays, by the filters that they have: what may be in their way near to where they begin, from both
/// sides.
class NearFilters {
  public:
    const RayFilter& of(const RayFilter* only) {
        const auto [filter, is_new] = filters_.try_emplace(only);
        if (is_new && only) filter->second = *only;
        filter->second.sides = RayFilter::Sides::Both, filter->second.with_inside = false;
        filter->second.facets = RayFilter::Facets::ThisTime;
        return filter->second;
    }

  private:
    std::unordered_map<const RayFilter*, RayFilter> filters_;
};

}  // namespace

void RayStarts::add(const LeavingPoint& point, const LeavingRay& ray) {
    if (points_.empty() || !(points_.back() == point)) points_.push_back(point);
    constexpr float kAlong = 1e-3f;
    const bool outside = ray.axis.dot(point.normal) >= 0;
    const bool crosses = ray.way.dot(point.normal) * (outside ? 1 : -1) < -kAlong;
    starts_.push_back({ray, points_.size() - 1, outside, crosses});
}

/// Begins a ray on the micropolygon below it, in front of it or behind.
RayStarts::Way RayStarts::begin(const Start& start, const FacetPose& facet, WalkedRay& ray) const {
    const float rounding = points_[start.point].rounding, side = start.outside ? 1 : -1;
    if (start.leaving.towards) aim(facet.inner, start.leaving, ray);
    if (start.leaving.turn) turn_along(*grounds_[start.point], facet, *start.leaving.turn, ray.segment);
    const V3f direction = ray.segment.direction;
    const bool above = side * direction.dot(facet.hit.normal) > 0;
    const bool above_other = side * direction.dot(facet.other.normal) > 0;
    const bool meets_other = above != above_other && facet.other.is_ahead(facet.inner, direction);
    // Both triangles in a row are none to the ray [core/hit_micropolygon.h].
    const bool in_front = above || meets_other;
    const V3f origin = facet.inner + facet.hit.normal * (in_front ? side * rounding : -side * rounding);
    if (start.leaving.towards)
        ray.moved += origin - ray.segment.origin, ray.segment.origin = origin, ray.segment.min = 0;
    else
        move_to(origin, ray);
    ray.witness = V3f(0, 0, 0);
    // The own micropolygon does not count, whatever rounds.
    ray.segment.left = {.most = points_[start.point].reach, .half = rounding / 2, .normal = facet.hit.normal};
    return !in_front ? Way::FromBehind : meets_other && above ? Way::Into : Way::Away;
}

/// Of rays that begin behind their micropolygons: those that come out in time begin there. Of the others
/// those that lead away from the surface as it is are added to `into`.
void RayStarts::come_out(const RayScene& scene, RayKind kind, std::span<const Start> behind,
                         std::span<WalkedRay> rays, std::vector<Start>& into) const {
    NearFilters filters;
    std::vector<RaySegment> segments;
    for (const Start& start : behind) {
        RaySegment& segment = segments.emplace_back(rays[start.leaving.ray].segment);
        segment.max = points_[start.point].reach, segment.left = {}, segment.reached = {};
        segment.only = &filters.of(segment.only);
    }
    const std::vector<std::optional<RaySurfaceHit>> hits = closest_hits(scene, kind, segments);
    for (size_t i = 0; i < behind.size(); ++i) {
        RaySegment& ray = rays[behind[i].leaving.ray].segment;
        const bool comes_out =
            hits[i] && (hits[i]->facet->at(ray.time).hit.normal.dot(ray.direction) > 0) == behind[i].outside;
        if (!comes_out) {
            if (!behind[i].crosses) into.push_back(behind[i]);
            continue;
        }
        ray.min = hits[i]->distance;
        ray.left.half = -kInfinity;  // all that it meets behind counts
        ray.passed.begin_behind(hits[i]->place);
    }
}

/// Rays that meet the micropolygon on which they begin, where that counts: they are asked from in front of
/// it.
void RayStarts::meet_grounds(const RayScene& scene, RayKind kind, std::span<const Start> into,
                             std::span<WalkedRay> rays) {
    std::vector<RaySegment> segments;
    for (const Start& start : into) {
        RaySegment& segment = segments.emplace_back(rays[start.leaving.ray].segment);
        const FacetPose facet = grounds_[start.point]->at(segment.time);
        const float rounding = points_[start.point].rounding;
        const V3f out = start.outside ? facet.hit.normal : -facet.hit.normal;
        segment.origin = facet.inner + out * rounding, segment.direction = -out;
        // Where the ray ends before what lies at its end, or on the micropolygon, nothing is in its way.
        const RaySegment& ray = rays[start.leaving.ray].segment;
        segment.max = ray.max > 0 && !ends_on(facet, ray) ? 3 * rounding : 0, segment.left = {},
        segment.reached = {};
    }
    met_ = closest_hits(scene, kind, segments);
    for (size_t i = 0; i < into.size(); ++i) {
        if (!met_[i] || !(segments[i].max > 0)) continue;
        met_[i]->distance = 0;
        rays[into[i].leaving.ray].first = &*met_[i];
    }
}

void RayStarts::settle(const RayScene& scene, RayKind kind, RayGrounds& grounds, std::span<WalkedRay> rays) {
    if (starts_.empty()) return;
    grounds_ = grounds.of(scene, kind, points_);
    std::vector<Start> behind, into;
    for (const Start& start : starts_) {
        WalkedRay& ray = rays[start.leaving.ray];
        if (!grounds_[start.point]) continue;
        const FacetPose facet = grounds_[start.point]->at(ray.segment.time);
        if (facet.hit.normal == V3f(0, 0, 0)) continue;
        const Way way = begin(start, facet, ray);
        if (way == Way::FromBehind) behind.push_back(start);
        if (way == Way::Into) into.push_back(start);
    }
    come_out(scene, kind, behind, rays, into);
    meet_grounds(scene, kind, into, rays);
    points_.clear(), starts_.clear(), grounds_.clear();
}

}  // namespace trapeze
