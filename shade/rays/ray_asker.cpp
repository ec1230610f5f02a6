#include "shade/rays/ray_asker.h"

#include <algorithm>
#include <cmath>

#include "core/random.h"

namespace trapeze {
namespace {

/// How far from a point its rays begin, in micropolygons' sides. A ray that leaves a micropolygon's vertex
/// may be said to hit it as deep as the micropolygon goes, where that is a needle (hit_micropolygon.h): some
/// have sides of nearly two. Two dicings of a displaced surface differ by more.
constexpr float kBiasOfSide = 2, kBiasOfDisplacedSide = 3;

}  // namespace

uint64_t RayLane::of_ray(int sample) const {
    const auto number = static_cast<uint32_t>(sample);
    return uint64_t{hash(seed, number, 3)} << 32 | hash(seed, number, 4);
}

float RayAsker::bias_at(const V3f& P, int level, float asked) const {
    if (asked >= 0) return asked;
    if (attributes_.rays.bias > 0) return attributes_.rays.bias;
    const bool displaced = attributes_.displacement || attributes_.displacement_bound > 0;
    const float side = std::max(std::sqrt(std::max(attributes_.shading_rate, 1.0f)), level_side(level));
    return service_.scene->spacing(P) * side * (displaced ? kBiasOfDisplacedSide : kBiasOfSide);
}

RayMedium RayAsker::medium(const RayLane& lane, const V3f& direction) const {
    if (service_.volumes->empty() || !lane.grid) return {};
    const V3f outside = lane.grid->Ng.at(lane.lane - lane.first_of_grid);
    return {lane.grid->primitive_index, direction.dot(outside) < 0};
}

/// The bounds of all surfaces on the way hold, each counted from the surface's own depth.
RayDepths RayAsker::depths_behind(RayKind kind) const {
    RayDepths depths = service_.visit.depths;
    const RayAttributes& rays = attributes_.rays;
    const auto bound = [&](RayKind of, int most) {
        int& known = depths.most[static_cast<size_t>(of)];
        known = std::min(known, depths.of(of) + most);
    };
    bound(RayKind::Diffuse, rays.max_diffuse);
    bound(RayKind::Specular, rays.max_specular);
    ++depths.bounces[static_cast<size_t>(kind)];
    return depths;
}

bool RayAsker::is_too_deep(RayKind kind) const {
    const RayDepths depths = depths_behind(kind);
    return depths.of(kind) > depths.most[static_cast<size_t>(kind)] || service_.depth >= service_.max_depth;
}

}  // namespace trapeze
