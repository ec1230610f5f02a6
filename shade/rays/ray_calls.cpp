#include "shade/rays/ray_calls.h"

#include <algorithm>
#include <cmath>

#include "core/portable_math.h"
#include "core/random.h"
#include "shade/rays/ray_directions.h"
#include "shade/vm/context_ops.h"

namespace trapeze {
namespace {

using rsl::Op;
using vm::Operand;
using vm::Run;
using vm::Step;

/// How far from a point its rays begin, in micropolygons' sides. A ray that leaves a micropolygon's vertex
/// may be said to hit it as deep as the micropolygon goes, where that is a needle (hit_micropolygon.h): some
/// have sides of nearly two. Two dicings of a displaced surface differ by more.
constexpr float kBiasOfSide = 2, kBiasOfDisplacedSide = 3;
/// Rays that are in memory at once, about.
constexpr size_t kRaysAtOnce = 4096;

bool is_finite(const V3f& v) {
    return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z);
}

/// Sets a lane's result, or that of all lanes where it is uniform.
void put(const Operand& out, size_t lane, const V3f& value) {
    for (int k = 0; k < (out.stride ? 3 : 1); ++k) {
        float* const plane = out.data + static_cast<size_t>(k) * out.stride;
        if (out.lane_mask)
            plane[lane] = value[k];
        else
            std::fill_n(plane, kLanes, value[k]);
    }
}

/// What the vertex at a hit has found holds for its whole grid.
void spread(const Run& run, const Operand& out) {
    if (!out.lane_mask) return;
    for (const vm::GridSpan& span : run.context().batch->spans)
        for (size_t k = 0; span.hit_vertex >= 0 && k < (out.stride ? 3u : 1u); ++k) {
            float* const plane = out.data + k * out.stride + span.first;
            std::fill_n(plane, span.shape.vertex_count(), plane[span.hit_vertex]);
        }
}

/// The result of a call that sees nothing.
float result_of_nothing(Op op, bool colors) {
    if (op == Op::Transmission || op == Op::Visibility) return 1;
    return op == Op::Trace && !colors ? kInfinity : 0;
}

/// How much a hit at a distance counts for occlusion().
float falloff_at(float distance, const RayArguments& arguments, size_t lane) {
    const float falloff = arguments.falloff.at(lane);
    if (!(falloff > 0) || distance >= kInfinity) return 1;
    if (arguments.falloff_mode.at(lane) == 0) return portable::exp(-falloff * distance);
    return portable::pow(std::max(0.0f, 1 - distance / arguments.max_distance_at(lane)), falloff);
}

/// What a ray adds to its call's result.
V3f share_of(Op op, bool colors, const WalkedRay& ray, const RayArguments& arguments, size_t lane) {
    switch (op) {
        case Op::Trace:
            return colors ? ray.seen : V3f(ray.distance);
        case Op::IndirectDiffuse:
            return ray.seen;
        case Op::Occlusion:
            return V3f((1 - (ray.through.x + ray.through.y + ray.through.z) / 3) *
                       falloff_at(ray.distance, arguments, lane));
        case Op::Shadow:
            return V3f(1) - ray.through;
        default:
            return ray.through;
    }
}

}  // namespace

uint64_t RayCalls::Lane::of_ray(int sample) const {
    const auto number = static_cast<uint32_t>(sample);
    return uint64_t{hash(seed, number, 3)} << 32 | hash(seed, number, 4);
}

/// The lanes of vertices that run, or the first where the result is uniform.
std::vector<RayCalls::Lane> RayCalls::lanes_of(Run& run, const Step& step, bool uniform) {
    std::vector<uint32_t>& calls = calls_[&step];
    calls.resize(std::max(calls.size(), run.lanes()));
    std::vector<Lane> lanes;
    const uint32_t* mask = run.masks().all() ? nullptr : run.masks().current();
    for (const vm::GridSpan& span : run.context().batch->spans) {
        const auto count = static_cast<size_t>(span.shape.vertex_count());
        const uint32_t grid =
            hash(static_cast<uint32_t>(span.seed), static_cast<uint32_t>(span.seed >> 32), service_.seed);
        for (size_t i = 0; i < count; ++i) {
            if (span.hit_vertex >= 0 && i != static_cast<size_t>(span.hit_vertex)) continue;
            const size_t lane = span.first + i;
            if (mask && !mask[lane]) continue;
            lanes.push_back({lane, hash(grid, static_cast<uint32_t>(i), step.first, calls[lane]++)});
            if (uniform) return lanes;
        }
    }
    return lanes;
}

float RayCalls::bias_at(const V3f& P, const RayArguments& arguments, size_t lane) const {
    if (const float asked = arguments.bias.at(lane); asked >= 0) return asked;
    if (attributes_.rays.bias > 0) return attributes_.rays.bias;
    const bool displaced = attributes_.displacement || attributes_.displacement_bound > 0;
    return service_.scene->spacing(P) * std::sqrt(std::max(attributes_.shading_rate, 1.0f)) *
           (displaced ? kBiasOfDisplacedSide : kBiasOfSide);
}

/// Whether hits are not shaded any more: they are black.
bool RayCalls::is_too_deep(RayKind kind) const {
    const RayAttributes& rays = attributes_.rays;
    const int most = kind == RayKind::Diffuse ? rays.max_diffuse : rays.max_specular;
    return service_.depth >= std::min(most, service_.max_depth);
}

void RayCalls::trace(Run& run, const Step& step, std::span<const Operand> operands) {
    const Operand& out = operands[0];
    const bool colors = out.stride != 0;
    const RayArguments arguments(run, step, operands);
    if (!run.context().batch) return put(out, 0, V3f(result_of_nothing(step.op, colors)));
    const std::vector<Lane> lanes = lanes_of(run, step, !out.lane_mask);
    for (size_t first = 0; first < lanes.size();) {
        size_t end = first, count = 0;
        for (; end < lanes.size() && count < kRaysAtOnce; ++end)
            count += static_cast<size_t>(arguments.samples_at(lanes[end].lane));
        LaneRays sent = rays_of(step.op, std::span(lanes).subspan(first, end - first), arguments);
        follow(step.op, colors, arguments, sent.rays);
        for (size_t i = first, ray = 0; i < end; ++i) {
            const size_t lane = lanes[i].lane, from = ray;
            V3f sum(0, 0, 0);
            for (; ray < sent.ends[i - first]; ++ray)
                sum += share_of(step.op, colors, sent.rays[ray], arguments, lane);
            put(out, lane,
                ray > from ? sum / static_cast<float>(ray - from) : V3f(result_of_nothing(step.op, colors)));
        }
        first = end;
    }
    spread(run, out);
}

RayCalls::LaneRays RayCalls::rays_of(Op op, std::span<const Lane> lanes,
                                     const RayArguments& arguments) const {
    LaneRays sent;
    for (const Lane& lane : lanes) {
        add_rays(op, lane, arguments, sent.rays);
        sent.ends.push_back(sent.rays.size());
    }
    return sent;
}

/// A lane's rays; none where it does not know where to.
void RayCalls::add_rays(Op op, const Lane& asking, const RayArguments& arguments,
                        std::vector<WalkedRay>& rays) const {
    const size_t lane = asking.lane;
    const bool between_points = op == Op::Transmission || op == Op::Visibility;
    const bool over_sky = op == Op::Occlusion || op == Op::IndirectDiffuse;
    const V3f P = arguments.from_at(lane), towards = arguments.towards_at(lane);
    const V3f way = between_points ? towards - P : towards;
    // Squares of very long ways are not finite.
    const float largest = std::max({std::abs(way.x), std::abs(way.y), std::abs(way.z)});
    if (!is_finite(P) || !is_finite(way) || !(largest > 0)) return;
    const V3f direction = (way / largest).normalized();
    const float length = largest * (way / largest).length();

    WalkedRay ray;
    ray.segment.origin = P;
    ray.segment.min = bias_at(P, arguments, lane);
    ray.segment.max = arguments.max_distance_at(lane);
    if (between_points || (op == Op::Shadow && !arguments.distant_light))
        ray.segment.max = std::min(ray.segment.max, length - ray.segment.min);
    const float angle = over_sky ? arguments.cone_angle_at(lane) : arguments.sample_cone_at(lane);
    const int samples = angle == 0 ? 1 : arguments.samples_at(lane);
    const Cone cone(direction, angle);
    const RaySequence sequence(asking.seed, samples);
    const bool by_cosine = over_sky && !arguments.uniform_distribution;
    for (int s = 0; s < samples; ++s) {
        ray.segment.direction = angle == 0  ? direction
                                : by_cosine ? cone.by_cosine(sequence[s])
                                            : cone.uniform(sequence[s]);
        ray.seed = asking.of_ray(s);
        rays.push_back(ray);
    }
}

/// Sends the rays of a call. Occlusion takes primitives' own opacities, as does what is too deep to be
/// shaded.
void RayCalls::follow(Op op, bool colors, const RayArguments& arguments, std::span<WalkedRay> rays) const {
    const bool shades = op != Op::Occlusion && service_.depth < service_.max_depth;
    RayWalk walk(*service_.scene, shades ? service_.shade : ShadeHits(), *service_.scratch, *service_.stats);
    switch (op) {
        case Op::Trace:
            if (!colors) return walk.distance(rays, RayKind::Specular);
            if (!is_too_deep(RayKind::Specular)) walk.radiance(rays, RayKind::Specular);
            return;
        case Op::IndirectDiffuse:
            if (!is_too_deep(RayKind::Diffuse)) walk.radiance(rays, RayKind::Diffuse);
            return;
        case Op::Occlusion:
            return walk.transmission(rays, RayKind::Diffuse, arguments.falloff.operand != nullptr);
        default:
            return walk.transmission(rays, RayKind::Transmission, false);
    }
}

}  // namespace trapeze
