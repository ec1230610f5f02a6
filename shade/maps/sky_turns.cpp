#include "shade/maps/sky_turns.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstring>
#include <string_view>
#include <utility>

#include "core/random.h"

namespace trapeze {
namespace {

using vm::Operand;
using vm::Run;
using vm::Step;

/// Category, P, direction, angle, samples.
constexpr size_t kPlain = 5, kP = 1, kSamples = 4;
/// A bound on absurd input.
constexpr float kMostSamples = 65536;
/// What stands for no end where rays tell how far they go.
constexpr float kEndless = 1e30f;

void put(const Operand& out, size_t lane, const V3f& value) {
    for (int k = 0; k < (out.stride ? 3 : 1); ++k)
        out.data[static_cast<size_t>(k) * out.stride + (lane & out.lane_mask)] = value[k];
}

}  // namespace

SkyTurns::SkyTurns(std::shared_ptr<const SkyParts> parts, Run& run, const Step& step,
                   std::span<const Operand> operands, uint32_t seed)
    : parts_(std::move(parts)), P_(operands[step.outputs + kP]), hits_(run.lanes()), misses_(run.lanes()) {
    static constexpr std::pair<std::string_view, From> kNames[] = {
        {"environment:color", From::Color},
        {"environment:direction", From::Direction},
        {"environment:solidangle", From::SolidAngle},
        {"ray:direction", From::RayDirection},
        {"ray:origin", From::RayOrigin},
        {"ray:length", From::RayLength}};
    const vm::Registers& registers = run.registers();
    for (size_t k = 0; k < step.outputs; ++k) {
        const std::string& name = registers.text_input(step, kPlain + k);
        const int width = rsl::width_of(registers.reg(registers.register_of(step, k)).type.base);
        const auto* const known = std::ranges::find(kNames, name, &std::pair<std::string_view, From>::first);
        const bool is_number = known != std::end(kNames) &&
                               (known->second == From::SolidAngle || known->second == From::RayLength);
        if (known != std::end(kNames) && width == (is_number ? 1 : 3))
            outputs_.push_back({known->second, operands[k]});
        else
            run.warn(step,
                     fmt::format("gather() of an environment knows no \"{}\" of this type: it stays as it is",
                                 name),
                     fmt::format("rsl-gather-output {}", name));
    }
    const Operand& samples = operands[step.outputs + kSamples];
    if (!run.context().batch)
        for (size_t lane = 0; lane < run.lanes(); ++lane)
            add_lane(lane, static_cast<uint32_t>(lane), samples);
    else
        for (const vm::GridSpan& span : run.context().batch->spans) {
            const uint32_t grid = span.word(hash(seed, step.first));
            // All of what a ray has hit is told the same.
            for (size_t i = 0; i < static_cast<size_t>(span.shape.vertex_count()); ++i)
                add_lane(span.first + i,
                         hash(grid, static_cast<uint32_t>(span.hit_vertex >= 0 ? span.hit_vertex
                                                                               : static_cast<int>(i))),
                         samples);
        }
}

void SkyTurns::add_lane(size_t lane, uint32_t seed, const Operand& samples) {
    const float asked = Run::at(samples, 0, lane);
    const int count = asked >= 1 ? static_cast<int>(std::min(asked, kMostSamples)) : 0;  // also NaN
    lanes_.push_back({lane, count, seed});
}

/// Lanes that ask for as many parts as others are told of the same ones.
Task<bool> SkyTurns::next(Run&, const uint32_t* live) {
    if (turn_ == 0)
        for (const Lane& lane : lanes_)
            if (live[lane.lane]) most_ = std::max(most_, lane.samples);
    if (turn_ >= most_) co_return false;
    std::map<int, SkyParts::Part> parts;
    std::fill(hits_.begin(), hits_.end(), 0.0f);
    for (const Lane& lane : lanes_) {
        if (!live[lane.lane] || turn_ >= lane.samples) continue;
        const auto [part, is_new] = parts.try_emplace(lane.samples);
        if (is_new) part->second = parts_->part(turn_, lane.samples);
        std::memset(&hits_[lane.lane], 0xff, sizeof(float));
        tell(lane, part->second);
    }
    ++turn_;
    co_return true;
}

void SkyTurns::tell(const Lane& lane, const SkyParts::Part& part) const {
    const auto random = [&](uint32_t axis) {
        return unit_float(hash(lane.seed, static_cast<uint32_t>(turn_), axis));
    };
    for (const Output& output : outputs_) {
        const Operand& out = output.operand;
        // As shaders written for 3Delight have it, which add up colours as they come.
        if (output.from == From::Color) put(out, lane.lane, part.color * part.solid_angle);
        if (output.from == From::Direction) put(out, lane.lane, part.direction);
        if (output.from == From::SolidAngle) put(out, lane.lane, V3f(part.solid_angle));
        if (output.from == From::RayDirection)
            put(out, lane.lane, parts_->direction_in(part, V2f(random(0), random(1))));
        if (output.from == From::RayOrigin) put(out, lane.lane, Run::triple_at(P_, lane.lane));
        if (output.from == From::RayLength) put(out, lane.lane, V3f(kEndless));
    }
}

}  // namespace trapeze
