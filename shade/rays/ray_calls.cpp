#include "shade/rays/ray_calls.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>
#include <utility>

#include "core/portable_math.h"
#include "core/random.h"
#include "shade/rays/asking_lanes.h"
#include "shade/rays/gather_call.h"
#include "shade/rays/lane_footprint.h"
#include "shade/rays/lane_motion.h"
#include "shade/rays/ray_aim.h"
#include "shade/rays/ray_directions.h"
#include "shade/rays/sample_base.h"
#include "shade/rays/sky_in.h"
#include "shade/vm/context_ops.h"

namespace trapeze {
namespace {

using rsl::Op;
using vm::Operand;
using vm::Run;
using vm::Step;

constexpr float kTurn = 2 * std::numbers::pi_v<float>;

/// Sets the result of the lanes that a lane speaks for.
void put(const Operand& out, const RayLane& lane, const V3f& value) {
    put_lanes(out, lane.first, lane.count, value);
}

/// A float that tells of light tells its mean; of a map or a scene it is the first channel.
bool is_mean(Op op) {
    return op == Op::Shadow || op == Op::Transmission || op == Op::Visibility;
}

/// The result of a call that sees nothing.
float result_of_nothing(Op op, bool colors) {
    if (op == Op::Transmission || op == Op::Visibility) return 1;
    return op == Op::Trace && !colors ? kInfinity : 0;
}

/// How much of the light along a ray is hidden.
float hidden_by(const WalkedRay& ray, const RayArguments& arguments, size_t lane) {
    return (1 - mean_of_channels(ray.through)) * arguments.falloff_at(ray.distance, lane);
}

}  // namespace

/// One call.
struct RayCalls::Call {
    Run& run;
    const Step& step;
    const RayArguments& arguments;
    bool colors;          ///< a colour is wanted, not a float
    bool motion_samples;  ///< rays meet the scene at times of their own

    bool between_points() const { return step.op == Op::Transmission || step.op == Op::Visibility; }
    /// Rays end at a point; others go on.
    bool ends_at_point() const {
        return between_points() || (step.op == Op::Shadow && !arguments.distant_light);
    }
    /// What is wanted is the distance from P, and no more.
    bool is_distance() const { return step.op == Op::Trace && !colors && !arguments.sets("transmission"); }
    /// Who asks what a direction leads to asks it of P.
    bool is_exact() const { return step.op == Op::Trace || step.op == Op::Environment; }
    bool over_sky() const { return step.op == Op::Occlusion || step.op == Op::IndirectDiffuse; }
    RayKind kind() const {
        return over_sky()                                           ? RayKind::Diffuse
               : step.op == Op::Trace || step.op == Op::Environment ? RayKind::Specular
                                                                    : RayKind::Transmission;
    }
    /// The half angle of the cone that a lane's rays fill.
    float angle_at(size_t lane) const {
        return over_sky() ? arguments.cone_angle_at(lane) : arguments.sample_cone_at(lane);
    }
    /// Rays that all go the same way differ in time at most.
    int samples_at(size_t lane) const {
        return angle_at(lane) == 0 && !motion_samples ? 1 : arguments.samples_at(lane);
    }
    V3f share_of(const WalkedRay& ray, size_t lane) const;
    RayAim aim_at(size_t lane, const LaneMotion& motion, float time) const;
    bool begins_here(size_t lane, const LaneMotion& motion) const;
};

/// Of two points: whether the first is nearer to the point that is shaded.
bool RayCalls::Call::begins_here(size_t lane, const LaneMotion& motion) const {
    return (arguments.from_at(lane) - motion.start()).length2() <=
           (arguments.towards_at(lane) - motion.start()).length2();
}

/// Where rays of a lane go at a time. Its point moves, and directions turn with its surface where they belong
/// to it; lights stay. Of two points that one moves which is nearer to the point that is shaded.
RayAim RayCalls::Call::aim_at(size_t lane, const LaneMotion& motion, float time) const {
    const V3f P = arguments.from_at(lane), towards = arguments.towards_at(lane), moved = motion.way(time);
    if (!ends_at_point())
        return RayAim(moved == V3f(0, 0, 0) ? P : P + moved, motion.turned(towards, time, over_sky()), time);
    if (moved == V3f(0, 0, 0)) return RayAim(P, between_points() ? towards - P : towards, time);
    if (!between_points()) return RayAim(P + moved, towards - moved, time);
    return begins_here(lane, motion) ? RayAim(P + moved, towards - (P + moved), time)
                                     : RayAim(P, towards + moved - P, time);
}

/// What a ray adds to the result.
V3f RayCalls::Call::share_of(const WalkedRay& ray, size_t lane) const {
    switch (step.op) {
        case Op::Trace:
            return colors ? ray.seen : V3f(ray.told_distance());
        case Op::Environment:
            return colors ? ray.seen : V3f(ray.seen[arguments.channel]);
        case Op::IndirectDiffuse:
            return ray.seen;
        case Op::Occlusion:
            return V3f(hidden_by(ray, arguments, lane));
        case Op::Shadow:
            return V3f(1) - ray.through;
        default:
            return ray.through;
    }
}

namespace {

/// Sums over a lane's rays, for what is set besides the result.
struct LaneSums {
    V3f sky{0, 0, 0}, open_way{0, 0, 0}, through{0, 0, 0};
    float hidden = 0, way = 0;
    size_t hits = 0;  ///< of the rays; `way` is how far they go

    void put(const RayArguments& arguments, const RayLane& lane, size_t rays) const {
        const float count = static_cast<float>(std::max<size_t>(rays, 1));
        for (const RayArguments::Output& output : arguments.outputs) {
            if (output.name == "environmentcolor") trapeze::put(*output.operand, lane, sky / count);
            if (output.name == "environmentdir") trapeze::put(*output.operand, lane, open_way.normalized());
            if (output.name == "occlusion") trapeze::put(*output.operand, lane, V3f(hidden / count));
            if (output.name == "hitdist")
                trapeze::put(*output.operand, lane,
                             V3f(hits > 0 ? way / static_cast<float>(hits) : kInfinity));
            if (output.name == "transmission") {
                const V3f part = rays > 0 ? through / count : V3f(1, 1, 1);
                const bool one = output.operand->stride == 0;
                trapeze::put(*output.operand, lane, one ? V3f(mean_of_channels(part)) : part);
            }
        }
    }
};

}  // namespace

/// The lanes of vertices that run, or the first where the result is uniform.
std::vector<RayLane> RayCalls::lanes_of(Run& run, const Step& step, bool uniform) {
    std::vector<uint32_t>& calls = calls_[&step];
    calls.resize(std::max(calls.size(), run.lanes()));
    std::vector<RayLane> lanes;
    for_each_asking_lane(
        run, uniform, [&](const vm::GridSpan& span, size_t vertex, const AskingLane& asking) {
            const uint32_t grid = span.word(asker_.service().seed);
            const size_t lane = asking.lane;
            lanes.push_back({lane, hash(grid, static_cast<uint32_t>(vertex), step.first, calls[lane]++),
                             asking.first, asking.count, span.grid, span.first, bend_of(span.grid)});
        });
    return lanes;
}

/// Of one of the grids, or none.
SurfaceBend RayCalls::bend_of(const ShadingGrid* grid) {
    if (!grid) return {};
    const auto [known, is_new] = bends_.try_emplace(grid);
    if (is_new) known->second = asker_.bend_of(*grid);
    return known->second;
}

Task<> RayCalls::trace(Run& run, const Step& step, std::span<const Operand> operands) {
    const Operand& out = operands[0];
    const RayArguments arguments(run, step, operands);
    const Call call{run, step, arguments, out.stride != 0, asker_.samples_motion()};
    const V3f nothing(result_of_nothing(step.op, call.colors));
    if (!run.context().batch) co_return put(out, {}, nothing);
    const std::vector<RayLane> lanes = lanes_of(run, step, !out.lane_mask);
    set_unwanted_lanes(run, operands.first(step.outputs));
    if (step.op == Op::IndirectDiffuse && !arguments.map().empty()) co_return look_at_sky(call, out, lanes);
    const size_t most = rays_at_once(*asker_.service().scene);
    for (size_t first = 0; first < lanes.size();) {
        size_t end = first, count = 0;
        for (; end < lanes.size() && count < most; ++end)
            count += static_cast<size_t>(call.samples_at(lanes[end].lane));
        LaneRays sent = co_await rays_of(call, std::span(lanes).subspan(first, end - first));
        tell(call, out, std::span(lanes).subspan(first, end - first), sent, nothing);
        asker_.service().scratch->give_back(std::move(sent.rays));
        first = end;
    }
}

/// Sets the results of lanes whose rays have been sent; those that sent none get `nothing`.
void RayCalls::tell(const Call& call, const Operand& out, std::span<const RayLane> lanes,
                    const LaneRays& sent, const V3f& nothing) {
    const RayArguments& arguments = call.arguments;
    for (size_t i = 0, ray = 0; i < lanes.size(); ++i) {
        const size_t lane = lanes[i].lane, from = ray;
        V3f sum(0, 0, 0);
        LaneSums sums;
        for (; ray < sent.ends[i]; ++ray) {
            const WalkedRay& one = sent.rays[ray];
            sum += call.share_of(one, lane);
            if (!sent.followed) continue;
            if (!sent.sky.empty()) sums.sky += sent.sky[ray];
            sums.open_way += one.segment.direction * mean_of_channels(one.through);
            sums.through += one.through;
            sums.hidden += hidden_by(one, arguments, lane);
            if (one.hits()) sums.way += one.told_distance(), ++sums.hits;
        }
        const V3f result = ray > from ? sum / static_cast<float>(ray - from) : nothing;
        const bool is_one = !call.colors && is_mean(call.step.op);
        put(out, lanes[i], is_one ? V3f(mean_of_channels(result)) : result);
        sums.put(arguments, lanes[i], ray - from);
    }
}

std::unique_ptr<vm::GatherTurns> RayCalls::gather(Run& run, const Step& step,
                                                  std::span<const Operand> operands) {
    std::vector<RayLane> lanes;
    if (run.context().batch) lanes = lanes_of(run, step, false);
    return std::make_unique<GatherCall>(asker_, grounds_, std::move(lanes), run, step, operands);
}

/// Sends the rays of some lanes. What is behind them counts as far as they are open.
Task<RayCalls::LaneRays> RayCalls::rays_of(const Call& call, std::span<const RayLane> lanes) {
    LaneRays sent;
    sent.rays = asker_.service().scratch->take();
    for (const RayLane& lane : lanes) {
        add_rays(call, lane, sent);
        sent.ends.push_back(sent.rays.size());
    }
    sent.starts.settle(*asker_.service().scene, call.kind(), grounds_, sent.rays);
    sent.arrival_starts.settle(*asker_.service().scene, call.kind(), grounds_, sent.arrivals);
    end_at_arrivals(sent);
    sent.followed = co_await follow(call, sent.rays);
    co_await dim_by_own_surface(call, sent);
    const RayArguments& arguments = call.arguments;
    const bool fades = call.step.op == Op::IndirectDiffuse && arguments.falloff.operand;
    for (size_t i = 0, ray = 0; fades && i < lanes.size(); ++i)
        for (; ray < sent.ends[i]; ++ray)
            sent.rays[ray].seen *= arguments.falloff_at(sent.rays[ray].distance, lanes[i].lane);
    if (!sent.followed || arguments.environment_map.empty() || lanes.empty()) co_return sent;
    std::vector<V3f> directions;
    std::vector<float> widths;
    for (const WalkedRay& ray : sent.rays)
        directions.push_back(ray.segment.direction), widths.push_back(ray.segment.spread);
    sent.sky = sky_in(call.run, call.step, arguments.environment_map, arguments.environment_space,
                      std::move(directions), widths);
    for (size_t i = 0; i < sent.rays.size(); ++i) {
        sent.sky[i] *= sent.rays[i].through;
        sent.rays[i].seen += sent.sky[i];
    }
    co_return sent;
}

/// What each of a lane's rays stands for: its part of the cone that they fill; or what goes to where its
/// neighbours' rays go, but wherever those end at a point nothing is asked of them.
RayFootprint RayCalls::footprint_of(const Call& call, const RayLane& asking, const RayAim& aim,
                                    const LaneMotion& motion) const {
    const float angle = call.angle_at(asking.lane);
    RayFootprint ray;
    if (call.over_sky()) {
        ray.width = asker_.width_at(aim.P, asking);
    } else if (!call.ends_at_point()) {
        const uint32_t* const mask = call.run.masks().all() ? nullptr : call.run.masks().current();
        ray = trapeze::footprint_of(asking, aim, call.run.context().footprints, [&](size_t lane) {
            return mask && !mask[lane] ? std::nullopt : std::optional(call.aim_at(lane, motion, aim.time));
        });
        if (!ray.is_known()) ray.width = asker_.width_at(aim.P, asking);
    }
    ray.spread = spread_of(angle, call.samples_at(asking.lane));
    return ray;
}

/// The last part of a ray that ends at the surface which asks, where hits may be that surface's own: a ray
/// from there begins outside of the surface's slab, as rays do that leave it.
void RayCalls::add_arrival(const Call& call, const RayLane& asking, const RayAim& aim,
                           const LaneMotion& motion, LaneRays& sent) const {
    const WalkedRay& whole = sent.rays.back();
    const float bias = call.arguments.bias.at(asking.lane);
    const V3f end = call.arguments.towards_at(asking.lane) + motion.way(aim.time);
    WalkedRay near;
    RaySegment& segment = near.segment;
    segment.only = whole.segment.only, segment.level = asking.level(), segment.time = aim.time;
    segment.backwards = true, segment.number = whole.segment.number;
    segment.direction = -aim.direction;
    segment.left = asker_.left_at(end, asking, motion, aim.time, bias);
    segment.min = segment.left.distance(segment.direction);
    segment.max = std::min(asker_.margin_at(end, asking, bias), aim.length);
    const std::optional<LeavingPoint> leaving = asker_.leaving_at(
        call.arguments.towards_at(asking.lane), segment.direction, asking, bias, segment.left, call.kind());
    if (!leaving && !(segment.min < segment.max)) return;
    if (leaving) {
        const V3f back = motion.turned_back(segment.direction, aim.time, true);
        sent.arrival_starts.add(
            *leaving,
            {.ray = sent.arrivals.size(), .way = back, .axis = back, .towards = whole.segment.origin});
    }
    near.moved = motion.turned(RayAsker::inwards(asking, segment.left), aim.time, true);
    segment.origin = end + near.moved;
    near.seed = asking.of_ray(-1);
    sent.arriving.push_back(sent.rays.size() - 1);
    sent.arrivals.push_back(near);
}

/// The last ray, which begins beside its point, begins on what rays meet of the surface where no slab is
/// known.
void RayCalls::begin_on_ground(const Call& call, const RayLane& asking, const RayAim& aim,
                               const LaneMotion& motion, const V3f& beside, LaneRays& sent) const {
    const WalkedRay& ray = sent.rays.back();
    const float bias = call.arguments.bias.at(asking.lane), angle = call.angle_at(asking.lane);
    std::optional<LeavingPoint> leaving =
        asker_.leaving_at(call.arguments.from_at(asking.lane), ray.segment.direction, asking, bias,
                          ray.segment.left, call.kind(), call.is_distance());
    if (!leaving) return;
    leaving->P += beside, leaving->is_vertex = beside == V3f(0, 0, 0);
    LeavingRay start{.ray = sent.rays.size() - 1};
    start.way = motion.turned_back(ray.segment.direction, aim.time, true);
    start.axis = angle <= kTurn / 4 ? motion.turned_back(aim.direction, aim.time, true) : start.way;
    if (call.ends_at_point() && angle == 0) start.towards = aim.P + aim.direction * aim.length;
    start.ends = ray.end >= aim.length;
    start.turn = motion.turn_of_space_alone(aim.time, call.over_sky());
    sent.starts.add(*leaving, start);
}

/// Rays end where the way from their surface back to them begins: in one line with it, no gap is between
/// both.
void RayCalls::end_at_arrivals(LaneRays& sent) {
    for (size_t i = 0; i < sent.arrivals.size(); ++i) {
        WalkedRay& whole = sent.rays[sent.arriving[i]];
        RaySegment& near = sent.arrivals[i].segment;
        if (sent.arrivals[i].moved == V3f(0, 0, 0)) continue;
        const RayAim aim(whole.segment.origin, near.origin - whole.segment.origin, whole.segment.time);
        if (!aim.leads()) continue;
        whole.segment.direction = aim.direction;
        near.max = std::max(near.max, near.min);
        whole.end = aim.length, whole.segment.max = aim.length - near.max;
    }
}

/// Takes away what does not arrive though nothing far from the surface is in its way.
Task<> RayCalls::dim_by_own_surface(const Call& call, LaneRays& sent) const {
    for (const auto& [ray, left] : sent.turned_away) sent.rays[ray].through *= left;
    if (sent.arrivals.empty() || !co_await follow(call, sent.arrivals)) co_return;
    for (size_t i = 0; i < sent.arrivals.size(); ++i)
        sent.rays[sent.arriving[i]].through *= sent.arrivals[i].through;
}

/// A lane's rays; none where it does not know where to.
void RayCalls::add_rays(const Call& call, const RayLane& asking, LaneRays& sent) const {
    const RayArguments& arguments = call.arguments;
    const size_t lane = asking.lane;
    const std::span<const float> times = call.run.context().ray_times;
    const LaneMotion motion(asker_, asking, times.empty() ? std::nullopt : std::optional(times[lane]));
    const float angle = call.angle_at(lane), bias = arguments.bias.at(lane);
    WalkedRay ray;
    ray.segment.only = arguments.only();
    ray.segment.level = asking.level();
    RayAim aim = call.aim_at(lane, motion, 0);
    if (!aim.leads()) return;
    Cone cone(aim.direction, angle);
    const bool ends_here = call.between_points() && !call.begins_here(lane, motion);
    const auto look_along = [&] {
        ray.segment.left = asker_.left_at(aim.P, asking, motion, aim.time, bias);
        const V3f inwards = call.is_exact() ? RayAsker::inwards_of_face(asking, ray.segment.left)
                                            : RayAsker::inwards(asking, ray.segment.left);
        (call.is_distance() ? ray.witness : ray.moved) = motion.turned(inwards, aim.time, true);
        ray.end = ray.segment.max = arguments.max_distance_at(lane);
        if (call.ends_at_point()) {
            const V3f end = aim.P + aim.direction * aim.length;
            const bool ends_loose = !ends_here && !asker_.has_bias(bias);
            const float margin = ends_loose ? 0 : asker_.margin_at(end, asking, bias);
            ray.end = std::min(ray.end, aim.length);
            ray.segment.max = std::min(ray.segment.max, aim.length - margin);
            if (ends_loose)
                ray.segment.reached = asker_.reached_at(aim, asking, call.run.context().light_roughness);
        }
        ray.segment.time = aim.time;
    };
    look_along();
    const int samples = call.samples_at(lane);
    ray.footprint = footprint_of(call, asking, aim, motion);
    ray.segment.spread = ray.footprint.fastest();
    const RaySequence sequence(asking.seed, samples);
    const SampleBase base(call.run);
    const bool arrives = ends_here && asker_.knows_media(asking);
    const V3f at_surface = ends_here ? arguments.towards_at(lane) : arguments.from_at(lane);
    // Samples of area lights are chosen for how the surface lies then.
    const bool may_turn_away = (call.ends_at_point() || call.step.op == Op::Shadow) && times.empty();
    const V3f outside = may_turn_away ? asker_.normal_at(at_surface, asking) : V3f(0, 0, 0);
    const float above = outside.dot(aim.direction);
    const bool knows_surface =
        outside != V3f(0, 0, 0) && asker_.knows_where_to_begin(at_surface, asking, motion, bias, call.kind());
    const bool by_cosine = call.over_sky() && !arguments.uniform_distribution;
    for (int s = 0; s < samples; ++s) {
        if (const float time = motion.time(s); time != aim.time) {
            aim = call.aim_at(lane, motion, time);
            if (!aim.leads()) aim = call.aim_at(lane, motion, 0);
            cone = Cone(aim.direction, angle);
            look_along();
        }
        ray.segment.direction = angle == 0  ? aim.direction
                                : by_cosine ? cone.by_cosine(sequence[s])
                                            : cone.uniform(sequence[s]);
        ray.segment.min = ray.segment.left.distance(ray.segment.direction);
        const V3f origin = base.origin(aim.P, arguments, asking, s);
        ray.segment.origin = origin + ray.moved;
        const V3f way = motion.turned_back(ray.segment.direction, ray.segment.time, call.over_sky());
        (arrives ? ray.end_medium : ray.medium) = asker_.medium(asking, arrives ? -way : way);
        ray.seed = asking.of_ray(s), ray.segment.number = asker_.number(asking, s);
        sent.rays.push_back(ray);
        if (!ends_here) begin_on_ground(call, asking, aim, motion, origin - aim.P, sent);
        // A surface that has turned since the shutter opened, so that light comes to its other side.
        const V3f seen = motion.turned_back(aim.direction, aim.time, true);
        if (aim.time > 0 && above * outside.dot(seen) < 0)
            sent.turned_away.emplace_back(
                sent.rays.size() - 1, asker_.left_of_light_behind(asking, knows_surface, ray.segment.only));
        if (ends_here && angle == 0 && ray.end >= aim.length) add_arrival(call, asking, aim, motion, sent);
    }
}

/// Sends the rays of a call; false where they are too deep to see anything.
Task<bool> RayCalls::follow(const Call& call, std::span<WalkedRay> rays) const {
    const RayService& service = asker_.service();
    const RayArguments& arguments = call.arguments;
    RayWalk walk(*service.scene, service.shade, *service.volumes, *service.scratch, *service.stats);
    RayAsk ask;
    const Op op = call.step.op;
    ask.kind = call.kind();
    ask.depths = asker_.depths_behind(ask.kind);
    ask.label = arguments.label;
    ask.hit_mode = arguments.hit_mode;
    ask.opaque = arguments.opaque;
    const bool too_deep = asker_.is_too_deep(ask.kind);
    ask.shades = !too_deep && !(ask.kind == RayKind::Transmission && asker_.dims_alone());
    if (call.is_distance()) {
        walk.distance(rays, ask);
        co_return true;
    }
    if (op == Op::Trace && !call.colors) {
        co_await walk.transmission(rays, ask, true);
        co_return true;
    }
    if (op == Op::Trace || op == Op::Environment || op == Op::IndirectDiffuse) {
        const bool asks = op == Op::Trace && !arguments.outputs.empty();
        if (!too_deep || asks) co_await walk.radiance(rays, ask);
        if (too_deep)
            for (WalkedRay& ray : rays) ray.seen = V3f(0, 0, 0);
        co_return !too_deep || asks;
    }
    const bool by_distance = op == Op::Occlusion && (arguments.falloff.operand || arguments.sets("hitdist"));
    co_await walk.transmission(rays, ask, by_distance);
    co_return true;
}

/// indirectdiffuse(map, direction): the mean of a map about the direction, by the cosine.
void RayCalls::look_at_sky(const Call& call, const Operand& out, std::span<const RayLane> lanes) const {
    constexpr int kDirections = 64;
    std::vector<V3f> directions;
    for (const RayLane& lane : lanes) {
        const RayAim aim(V3f(0, 0, 0), call.arguments.towards_at(lane.lane), 0);
        const bool leads = aim.leads();
        const Cone cone(leads ? aim.direction : V3f(0, 0, 1), kTurn / 4);
        const RaySequence sequence(lane.seed, kDirections);
        for (int s = 0; s < kDirections; ++s)
            directions.push_back(leads ? cone.by_cosine(sequence[s]) : V3f(0, 0, 0));
    }
    const std::vector<V3f> colors =
        sky_in(call.run, call.step, call.arguments.map(), "", std::move(directions),
               std::array{std::sqrt(kTurn / 2 / kDirections)});
    for (size_t i = 0; i < lanes.size(); ++i) {
        V3f sum(0, 0, 0);
        for (size_t s = 0; s < kDirections; ++s) sum += colors[i * kDirections + s];
        put(out, lanes[i], sum / static_cast<float>(kDirections));
    }
}

vm::RayFacts RayCalls::facts() const {
    const RayService& service = asker_.service();
    const RayDepths& depths = service.visit.depths;
    vm::RayFacts facts;
    facts.depth = service.depth;
    facts.diffuse_depth = depths.of(RayKind::Diffuse);
    facts.specular_depth = depths.of(RayKind::Specular);
    facts.shadow_depth = depths.of(RayKind::Transmission);
    facts.label = service.visit.label;
    if (const std::optional<RayKind> kind = service.visit.kind)
        facts.type = *kind == RayKind::Diffuse    ? "diffuse"
                     : *kind == RayKind::Specular ? "specular"
                                                  : "transmission";
    return facts;
}

}  // namespace trapeze
