#include "shade/rays/gather_call.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <optional>
#include <utility>

#include "shade/rays/asking_lanes.h"
#include "shade/rays/lane_motion.h"
#include "shade/rays/ray_aim.h"
#include "shade/rays/ray_directions.h"

namespace trapeze {
namespace {

using vm::Operand;
using vm::Run;
using vm::Step;

/// The category that asks for directions alone.
constexpr std::string_view kSamplePattern = "samplepattern";
constexpr float kQuarterTurn = 1.57079632679f;

std::optional<HitOutput> hit_output(std::string_view name, int width) {
    using Of = HitOutput::Of;
    static constexpr std::pair<std::string_view, Of> kPrefixes[] = {
        {"surface:", Of::Surface},   {"displacement:", Of::Displacement}, {"volume:", Of::Volume},
        {"atmosphere:", Of::Volume}, {"primitive:", Of::Primitive},       {"attribute:", Of::Attribute}};
    for (const auto& [prefix, of] : kPrefixes)
        if (name.starts_with(prefix)) return HitOutput{of, std::string(name.substr(prefix.size())), width};
    return {};
}

/// A lane of a Bool.
float lane_of(bool set) {
    const uint32_t bits = set ? ~0u : 0u;
    float lane;
    std::memcpy(&lane, &bits, sizeof lane);
    return lane;
}

/// Sets the lanes that a lane speaks for.
void put(const Operand& out, const RayLane& lane, int component, float value) {
    put_lanes(out, lane.first, lane.count, component, value);
}

void put(const Operand& out, const RayLane& lane, int width, const V3f& value) {
    for (int k = 0; k < std::min(width, 3); ++k) put(out, lane, k, value[k]);
}

}  // namespace

GatherCall::GatherCall(const RayAsker& asker, RayGrounds& grounds, std::vector<RayLane> lanes, Run& run,
                       const Step& step, std::span<const Operand> operands)
    : asker_(asker),
      grounds_(grounds),
      lanes_(std::move(lanes)),
      arguments_(run, step, operands),
      base_(run),
      hits_(run.lanes()),
      misses_(run.lanes()) {
    const vm::Registers& registers = run.registers();
    traces_ = arguments_.map() != kSamplePattern;
    for (size_t k = 0; k < step.outputs; ++k)
        add_output(arguments_.outputs[k].name,
                   rsl::width_of(registers.reg(registers.register_of(step, k)).type.base), operands[k], run,
                   step);
    colors_ = std::ranges::any_of(outputs_, [](const Output& output) {
        return output.from == From::Color || output.from == From::Opacity;
    });
    kind_ = arguments_.uniform_distribution ? RayKind::Specular : RayKind::Diffuse;
    for (const RayLane& lane : lanes_) most_ = std::max(most_, arguments_.samples_at(lane.lane));
    for (const RayLane& lane : lanes_) arguments_.sent.append(lane.lane, sent_numbers_);
    first_rays_.resize(lanes_.size(), kNone);
}

void GatherCall::add_output(std::string_view name, int width, const Operand& operand, Run& run,
                            const Step& step) {
    static constexpr std::pair<std::string_view, From> kOfRays[] = {
        {"surface:Ci", From::Color},  {"surface:Oi", From::Opacity},      {"volume:Ci", From::Color},
        {"volume:Oi", From::Opacity}, {"atmosphere:Ci", From::Color},     {"atmosphere:Oi", From::Opacity},
        {"ray:origin", From::Origin}, {"ray:direction", From::Direction}, {"ray:length", From::Length}};
    const auto* const of_ray = std::ranges::find(kOfRays, name, &std::pair<std::string_view, From>::first);
    std::optional<HitOutput> wanted;
    if (of_ray == std::end(kOfRays))
        wanted = hit_output(name, width);
    else if (width == (of_ray->second == From::Length ? 1 : 3))
        return outputs_.push_back({of_ray->second, width, operand});
    if (!wanted || (width != 1 && width != 3))
        return run.warn(step, fmt::format("gather() knows no \"{}\" of this type: it stays as it is", name),
                        fmt::format("rsl-gather-output {}", name));
    wanted->at = asked_.size;
    asked_.size += 1 + static_cast<size_t>(width);
    outputs_.push_back({From::Answer, width, operand, asked_.all.size()});
    asked_.all.push_back(std::move(*wanted));
}

Task<bool> GatherCall::next(Run&, const uint32_t* live) {
    if (turn_ >= most_) co_return false;
    if (turn_ >= sent_) co_await send(live);
    std::fill(hits_.begin(), hits_.end(), lane_of(false));
    std::fill(misses_.begin(), misses_.end(), lane_of(false));
    for (size_t i = 0; i < lanes_.size(); ++i) {
        const RayLane& lane = lanes_[i];
        if (first_rays_[i] == kNone || !live[lane.lane] || turn_ >= arguments_.samples_at(lane.lane))
            continue;
        const WalkedRay& ray = rays_[first_rays_[i] + static_cast<size_t>(turn_ - first_sent_)];
        std::vector<float>& mask = ray.hits() ? hits_ : misses_;
        std::fill_n(mask.begin() + static_cast<std::ptrdiff_t>(lane.first), lane.count, lane_of(true));
        tell(lane, ray);
    }
    ++turn_;
    co_return true;
}

/// Traces as many turns of all live lanes as fit.
Task<> GatherCall::send(const uint32_t* live) {
    size_t count = 0;
    for (const RayLane& lane : lanes_) count += live[lane.lane] ? 1 : 0;
    const int turns = static_cast<int>(
        std::max<size_t>(rays_at_once(*asker_.service().scene) / std::max<size_t>(count, 1), 1));
    first_sent_ = turn_, sent_ = std::min(turn_ + turns, most_);
    rays_.clear();
    for (size_t i = 0; i < lanes_.size(); ++i) {
        const int end = std::min(sent_, arguments_.samples_at(lanes_[i].lane));
        first_rays_[i] = kNone;
        if (!live[lanes_[i].lane] || end <= first_sent_) continue;
        first_rays_[i] = rays_.size();
        add_rays(i, first_sent_, end - first_sent_);
    }
    if (traces_) co_await follow();
}

/// Rays of some turns of one of lanes_. Those that lead nowhere are empty: they miss.
void GatherCall::add_rays(size_t number, int first, int count) {
    const RayLane& asking = lanes_[number];
    const size_t lane = asking.lane;
    const RayAim aim(arguments_.from_at(lane), arguments_.towards_at(lane), 0);
    const V3f axis = aim.leads() ? aim.direction : V3f(0, 0, 1);
    const float angle = arguments_.cone_angle_at(lane);
    const Cone cone(axis, angle);
    const RaySequence sequence(asking.seed, arguments_.samples_at(lane));
    const LaneMotion motion(asker_, asking);
    WalkedRay ray;
    ray.sent = sent_numbers_.data() + number * arguments_.sent.size();
    ray.segment.only = arguments_.only();
    ray.segment.level = asking.level();
    ray.footprint.width = asker_.width_at(aim.P, asking);
    ray.footprint.spread = ray.segment.spread = spread_of(angle, arguments_.samples_at(lane));
    const auto begins = [&](const RaySegment& segment) {
        return traces_ && aim.leads()
                   ? asker_.leaving_at(aim.P, segment.direction, asking, arguments_.bias.at(lane),
                                       segment.left, kind_, asks_distance())
                   : std::nullopt;
    };
    for (int s = first; s < first + count; ++s) {
        ray.segment.time = motion.time(s);
        const V3f P = aim.P + motion.way(ray.segment.time);
        ray.segment.left = asker_.left_at(P, asking, motion, ray.segment.time, arguments_.bias.at(lane));
        const V3f inwards = RayAsker::inwards_of_face(asking, ray.segment.left);
        (asks_distance() ? ray.witness : ray.moved) = motion.turned(inwards, ray.segment.time, true);
        ray.segment.max = aim.leads() ? arguments_.max_distance_at(lane) : 0;
        if (aim.leads()) ray.end = ray.segment.max;
        const V3f direction = angle == 0                        ? axis
                              : arguments_.uniform_distribution ? cone.uniform(sequence[s])
                                                                : cone.by_cosine(sequence[s]);
        const auto turned = [&](const V3f& way) {
            return motion.turned(way, ray.segment.time, kind_ == RayKind::Diffuse);
        };
        ray.segment.direction = turned(direction);
        ray.segment.min = aim.leads() ? ray.segment.left.distance(ray.segment.direction) : kInfinity;
        const V3f origin = base_.origin(P, arguments_, asking, s);
        ray.segment.origin = origin + ray.moved;
        ray.medium = asker_.medium(asking, direction);
        ray.seed = asking.of_ray(s), ray.segment.number = asker_.number(asking, s);
        if (std::optional<LeavingPoint> leaving = begins(ray.segment)) {
            leaving->P += origin - P, leaving->is_vertex = origin == P;
            LeavingRay start{.ray = rays_.size()};
            start.way = motion.turned_back(ray.segment.direction, ray.segment.time, true);
            start.axis =
                angle <= kQuarterTurn ? motion.turned_back(turned(axis), ray.segment.time, true) : start.way;
            start.turn = motion.turn_of_space_alone(ray.segment.time, kind_ == RayKind::Diffuse);
            starts_.add(*leaving, start);
        }
        rays_.push_back(ray);
    }
}

/// Sends the rays into the scene, for no more than what is asked. What is too deep to be shaded is black.
Task<> GatherCall::follow() {
    const RayService& service = asker_.service();
    RayWalk walk(*service.scene, service.shade, *service.volumes, *service.scratch, *service.stats);
    RayAsk ask;
    ask.kind = kind_, ask.depths = asker_.depths_behind(kind_), ask.label = arguments_.label;
    ask.hit_mode = arguments_.hit_mode, ask.opaque = arguments_.opaque, ask.outputs = &asked_;
    ask.sent = arguments_.sent.variables();
    const bool too_deep = asker_.is_too_deep(kind_);
    ask.shades = !too_deep && (colors_ || asked_.ask_shaders());
    ask.first_alone = !colors_;
    starts_.settle(*service.scene, kind_, grounds_, rays_);
    answers_.assign(rays_.size() * asked_.size, 0.0f);
    for (size_t i = 0; i < rays_.size(); ++i) rays_[i].answers = answers_.data() + i * asked_.size;
    if (asks_distance()) co_return walk.distance(rays_, ask);
    co_await walk.radiance(rays_, ask);
    if (too_deep)
        for (WalkedRay& ray : rays_) ray.seen = V3f(0, 0, 0);
}

/// Sets the outputs of a lane. Where a ray misses only its own are told; what a hit does not have stays.
void GatherCall::tell(const RayLane& lane, const WalkedRay& ray) const {
    for (const Output& output : outputs_) {
        const Operand& out = output.operand;
        switch (output.from) {
            case From::Origin:
                put(out, lane, output.width, ray.segment.origin - ray.moved);
                continue;
            case From::Direction:
                put(out, lane, output.width, ray.segment.direction);
                continue;
            case From::Length:
                put(out, lane, 0, ray.told_distance());
                continue;
            default:
                break;
        }
        if (!ray.hits()) continue;
        if (output.from == From::Color) put(out, lane, output.width, ray.seen);
        if (output.from == From::Opacity) put(out, lane, output.width, V3f(1) - ray.through);
        if (output.from != From::Answer) continue;
        const float* const answer = ray.answers + asked_.all[output.answer].at;
        for (int k = 0; answer[0] != 0 && k < output.width; ++k) put(out, lane, k, answer[1 + k]);
    }
}

}  // namespace trapeze
