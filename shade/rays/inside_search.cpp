#include "shade/rays/inside_search.h"

#include <algorithm>
#include <limits>

namespace trapeze {
namespace {

/// The most surfaces of things with a shader of their inside that are looked at: a bound on work.
constexpr int kMostSurfaces = 64;

}  // namespace

void go_behind(const RayScene& scene, const RaySurfaceHit& hit, RaySegment& ray) {
    // What is as near in another space may round to be nearer.
    constexpr float kRounding = 0x1p-21f;
    const float spacing = scene.spacing(ray.origin + ray.direction * hit.distance);
    const float until = hit.distance + std::max(hit.distance * 1e-6f, spacing * 1e-4f);
    // Of a solid the other surfaces there have been counted into its border.
    const float from = hit.of_solid ? until : hit.distance * (1 - kRounding);
    ray.min = ray.passed.add(hit.primitive, hit.distance, from, until, hit.place);
    ray.level = hit.level;  // else finer geometry of the same surface might be met once more
}

void InsideSearch::add(const RaySegment& ray, float from, RayMedium& found) {
    const auto [filter, is_new] = filters_.try_emplace(ray.only);
    if (is_new && ray.only) filter->second = *ray.only;
    filter->second.sides = RayFilter::Sides::OfAttributes, filter->second.with_inside = true;
    Looking& one = looking_.emplace_back(Looking{ray, &found});
    one.ray.only = &filter->second, one.ray.left = {}, one.ray.reached = {};
    one.ray.min = std::max(from, 0.0f), one.ray.max = std::numeric_limits<float>::infinity();
}

void InsideSearch::add_before(const RaySegment& ray, const RaySurfaceHit& hit, RayMedium& found) {
    add(ray, 0, found);
    if (!goes_on(looking_.back(), hit)) looking_.pop_back();
}

/// Whether a surface does not tell; then what is behind it is next.
bool InsideSearch::goes_on(Looking& one, const RaySurfaceHit& hit) const {
    const RayMedium inside{hit.primitive, true};
    if (volumes_.has(inside)) {
        if (!hit.from_outside && one.within == 0) {
            *one.found = inside;
            return false;
        }
        one.within += hit.from_outside ? 1 : -1;
    }
    go_behind(scene_, hit, one.ray);
    return true;
}

void InsideSearch::run() {
    std::vector<const RaySegment*> rays;
    std::vector<std::optional<RaySurfaceHit>> hits;
    for (int surface = 0; surface < kMostSurfaces && !looking_.empty(); ++surface) {
        rays.clear();
        for (const Looking& one : looking_) rays.push_back(&one.ray);
        hits.assign(rays.size(), std::nullopt);
        scene_.closest(rays, kind_, hits);
        std::vector<Looking> farther;
        for (size_t i = 0; i < rays.size(); ++i)
            if (hits[i] && goes_on(looking_[i], *hits[i])) farther.push_back(looking_[i]);
        looking_ = std::move(farther);
    }
}

}  // namespace trapeze
