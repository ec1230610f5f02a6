#include "shade/rays/ray_calls.h"

#include <algorithm>
#include <cmath>

#include "core/portable_math.h"
#include "core/random.h"
#include "shade/rays/gather_call.h"
#include "shade/rays/ray_directions.h"
#include "shade/vm/context_ops.h"

namespace trapeze {
namespace {

using rsl::Op;
using vm::Operand;
using vm::Run;
using vm::Step;

/// Rays that are in memory at once, about.
constexpr size_t kRaysAtOnce = 4096;

bool is_finite(const V3f& v) {
    return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z);
}

/// Sets the result of the lanes that a lane speaks for, or that of all lanes where it is uniform.
void put(const Operand& out, const RayLane& lane, const V3f& value) {
    for (int k = 0; k < (out.stride ? 3 : 1); ++k) {
        float* const plane = out.data + static_cast<size_t>(k) * out.stride;
        if (out.lane_mask)
            std::fill_n(plane + lane.first, lane.count, value[k]);
        else
            std::fill_n(plane, kLanes, value[k]);
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

/// The lanes of vertices that run, or the first where the result is uniform.
std::vector<RayLane> RayCalls::lanes_of(Run& run, const Step& step, bool uniform) {
    std::vector<uint32_t>& calls = calls_[&step];
    calls.resize(std::max(calls.size(), run.lanes()));
    std::vector<RayLane> lanes;
    const uint32_t* mask = run.masks().all() ? nullptr : run.masks().current();
    for (const vm::GridSpan& span : run.context().batch->spans) {
        const auto count = static_cast<size_t>(span.shape.vertex_count());
        const uint32_t grid = hash(static_cast<uint32_t>(span.seed), static_cast<uint32_t>(span.seed >> 32),
                                   asker_.service().seed);
        for (size_t i = 0; i < count; ++i) {
            if (span.hit_vertex >= 0 && i != static_cast<size_t>(span.hit_vertex)) continue;
            const size_t lane = span.first + i;
            if (mask && !mask[lane]) continue;
            RayLane asks{lane, hash(grid, static_cast<uint32_t>(i), step.first, calls[lane]++), lane};
            // What the vertex at a hit finds holds for its whole grid.
            if (span.hit_vertex >= 0) asks.first = span.first, asks.count = count;
            lanes.push_back(asks);
            if (uniform) return lanes;
        }
    }
    return lanes;
}

void RayCalls::trace(Run& run, const Step& step, std::span<const Operand> operands) {
    const Operand& out = operands[0];
    const bool colors = out.stride != 0;
    const RayArguments arguments(run, step, operands);
    if (!run.context().batch) return put(out, {}, V3f(result_of_nothing(step.op, colors)));
    const std::vector<RayLane> lanes = lanes_of(run, step, !out.lane_mask);
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
            put(out, lanes[i],
                ray > from ? sum / static_cast<float>(ray - from) : V3f(result_of_nothing(step.op, colors)));
        }
        first = end;
    }
}

std::unique_ptr<vm::GatherTurns> RayCalls::gather(Run& run, const Step& step,
                                                  std::span<const Operand> operands) {
    std::vector<RayLane> lanes;
    if (run.context().batch) lanes = lanes_of(run, step, false);
    return std::make_unique<GatherCall>(asker_, std::move(lanes), run, step, operands);
}

RayCalls::LaneRays RayCalls::rays_of(Op op, std::span<const RayLane> lanes,
                                     const RayArguments& arguments) const {
    LaneRays sent;
    for (const RayLane& lane : lanes) {
        add_rays(op, lane, arguments, sent.rays);
        sent.ends.push_back(sent.rays.size());
    }
    return sent;
}

/// A lane's rays; none where it does not know where to.
void RayCalls::add_rays(Op op, const RayLane& asking, const RayArguments& arguments,
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
    ray.segment.min = asker_.bias_at(P, arguments.bias.at(lane));
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
    const RayService& service = asker_.service();
    RayWalk walk(*service.scene, service.shade, *service.scratch, *service.stats);
    RayAsk ask;
    ask.label = arguments.label;
    ask.shades = op != Op::Occlusion && service.depth < service.max_depth;
    switch (op) {
        case Op::Trace:
            ask.kind = RayKind::Specular;
            if (!colors) return walk.distance(rays, ask);
            if (!asker_.is_too_deep(ask.kind)) walk.radiance(rays, ask);
            return;
        case Op::IndirectDiffuse:
            ask.kind = RayKind::Diffuse;
            if (!asker_.is_too_deep(ask.kind)) walk.radiance(rays, ask);
            return;
        case Op::Occlusion:
            ask.kind = RayKind::Diffuse;
            return walk.transmission(rays, ask, arguments.falloff.operand != nullptr);
        default:
            ask.kind = RayKind::Transmission;
            return walk.transmission(rays, ask, false);
    }
}

}  // namespace trapeze
