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

float RayAsker::bias_at(const V3f& P, float asked) const {
    if (asked >= 0) return asked;
    if (attributes_.rays.bias > 0) return attributes_.rays.bias;
    const bool displaced = attributes_.displacement || attributes_.displacement_bound > 0;
    return service_.scene->spacing(P) * std::sqrt(std::max(attributes_.shading_rate, 1.0f)) *
           (displaced ? kBiasOfDisplacedSide : kBiasOfSide);
}

bool RayAsker::is_too_deep(RayKind kind) const {
    const RayAttributes& rays = attributes_.rays;
    const int most = kind == RayKind::Diffuse ? rays.max_diffuse : rays.max_specular;
    return service_.depth >= std::min(most, service_.max_depth);
}

}  // namespace trapeze
