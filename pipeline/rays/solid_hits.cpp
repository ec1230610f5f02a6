#include "pipeline/rays/solid_hits.h"

#include <cmath>
#include <map>
#include <vector>

namespace trapeze {
namespace {

/// Goes on behind a hit: other parts' surfaces may lie there, the same one counts no more. Distances become
/// depths and come back, and lose a last bit each time.
void pass(const RaySurfaceHit& hit, RaySegment& ray) {
    float from = hit.distance, until = hit.distance;
    for (int i = 0; i < 4; ++i) from = std::nextafter(from, 0.0f), until = std::nextafter(until, kInfinity);
    ray.min = ray.passed.add(hit.primitive, hit.distance, from, until, hit.place);
}

/// Whether a ray wants the hit: by the solid's own sides.
bool is_wanted(const RaySegment& ray, const RaySurfaceHit& hit, const Primitive& primitive) {
    using Sides = RayFilter::Sides;
    if (ray.only && !ray.only->admits(hit.attributes->groups)) return false;
    const Sides sides = ray.only ? ray.only->sides : Sides::OfAttributes;
    const bool enters = hit.from_outside != ray.backwards;
    if (sides == Sides::OfAttributes) return sees_border(primitive, enters);
    return sides == Sides::Both || enters == (sides == Sides::Front);
}

}  // namespace

std::optional<RaySurfaceHit> SolidHits::nearest(const RaySegment& ray, const Find& find) const {
    const auto solid_of = [&](const RaySurfaceHit& hit) { return scene_.primitives[hit.primitive].solid; };
    // All of them: whether a leaf is closed behind the segment's end tells whether it holds the beginning.
    std::vector<RaySurfaceHit> along;
    std::map<int, bool> odd;
    RaySegment rest = ray;
    rest.max = std::numeric_limits<float>::infinity();
    while (const std::optional<RaySurfaceHit> hit = find(rest)) {
        along.push_back(*hit);
        if (const int solid = solid_of(*hit); solid >= 0) odd[solid] = !odd[solid];
        pass(*hit, rest);
    }
    SolidState& state = states_.local();
    state.reset();
    for (const auto& [solid, is_odd] : odd)
        if (is_odd) state.cross(solid);
    for (RaySurfaceHit& hit : along) {
        if (hit.distance > ray.max) break;
        const int solid = solid_of(hit);
        if (solid >= 0) {
            if (!state.cross(solid)) continue;
            hit.from_outside = state.whole_holds(solid);
            if (!is_wanted(ray, hit, scene_.primitives[hit.primitive])) continue;
        }
        return hit;
    }
    return {};
}

}  // namespace trapeze
