#include "shade/rays/ray_arguments.h"

#include <algorithm>
#include <limits>
#include <numbers>
#include <string_view>

namespace trapeze {
namespace {

using rsl::Op;

/// The most rays of a call: a bound on absurd input.
constexpr float kMostSamples = 65536;
constexpr float kPi = std::numbers::pi_v<float>;

V3f triple_at(const vm::Operand& operand, size_t lane) {
    return {vm::Run::at(operand, 0, lane), vm::Run::at(operand, 1, lane), vm::Run::at(operand, 2, lane)};
}

bool is_text(const vm::Registers& registers, const vm::Step& step, size_t operand) {
    return operand < step.count &&
           registers.reg(registers.register_of(step, operand)).type.base == rsl::Base::String;
}

/// How many arguments stand before the names and values that may follow.
size_t plain_arguments(const vm::Registers& registers, const vm::Step& step) {
    const bool map_first = is_text(registers, step, step.outputs);
    if (step.op == Op::Gather)
        return 5 + step.outputs;  // category, P, direction, angle, samples, outputs' names
    if (step.op == Op::Shadow) return 2 + static_cast<size_t>(step.immediate);  // a map, a channel, P
    if (step.op == Op::Occlusion) return map_first ? 4 : 3;        // a map that is not used, P, N, samples
    if (step.op == Op::IndirectDiffuse) return map_first ? 2 : 3;  // a map and a direction; P, N, samples
    return 2;
}

}  // namespace

RayArguments::RayArguments(vm::Run& run, const vm::Step& step, std::span<const vm::Operand> operands) {
    const vm::Registers& registers = run.registers();
    const size_t plain = plain_arguments(registers, step), end = step.outputs + plain;
    const bool of_light = step.op == Op::Shadow;
    const size_t first = step.outputs + (of_light ? 2 : is_text(registers, step, step.outputs) ? 1 : 0);
    bias.otherwise = -1, samples_.otherwise = 1;
    cone_angle_.otherwise = kPi / 2, max_distance_.otherwise = kInfinity;
    from_ = &operands[first], towards_ = &operands[first + 1 < end ? first + 1 : first];
    if (of_light) {
        const vm::LightOutput& light = *run.context().light_output;
        from_light_ = light.L, lanes_ = run.lanes();
        distant_light = light.distant;
    }
    if (step.op == Op::Gather) {
        cone_angle_.operand = &operands[first + 2], samples_.operand = &operands[first + 3];
        uniform_distribution = true, least_samples_ = 0;
    } else if (!of_light && first + 2 < end) {
        samples_.operand = &operands[first + 2];
    }
    const std::pair<std::string_view, LaneValue*> known[] = {
        {"samples", &samples_},        {"bias", &bias},       {"maxdist", &max_distance_},
        {"coneangle", &cone_angle_},   {"falloff", &falloff}, {"samplecone", &sample_cone_},
        {"falloffmode", &falloff_mode}};
    V3f threshold;
    for (size_t i = end; i + 1 < step.count; i += 2) {
        const std::string& name = registers.text(registers.register_of(step, i));
        const bool text = is_text(registers, step, i + 1);
        if (text) take_text(name, registers.text(registers.register_of(step, i + 1)));
        if (!text && name == "othreshold") {
            const vm::Operand& given = operands[i + 1];
            for (int k = 0; k < 3; ++k) threshold[k] = vm::Run::at(given, given.stride ? k : 0, 0);
            opaque = threshold;
        }
        for (const auto& [known_name, value] : known)
            if (!text && name == known_name) value->operand = &operands[i + 1];
    }
}

void RayArguments::take_text(std::string_view name, std::string_view text) {
    if (name == "distribution") uniform_distribution = text == "uniform";
    if (name == "label") label = text;
}

V3f RayArguments::from_at(size_t lane) const {
    return triple_at(*from_, lane);
}
V3f RayArguments::towards_at(size_t lane) const {
    if (from_light_)
        return -V3f(from_light_[lane], from_light_[lanes_ + lane], from_light_[2 * lanes_ + lane]);
    return triple_at(*towards_, lane);
}

int RayArguments::samples_at(size_t lane) const {
    const float count = samples_.at(lane);
    return count >= 1 ? static_cast<int>(std::min(count, kMostSamples)) : least_samples_;  // also NaN
}

float RayArguments::sample_cone_at(size_t lane) const {
    const float angle = sample_cone_.at(lane);
    return angle > 0 ? std::min(angle, kPi) : 0;
}
float RayArguments::cone_angle_at(size_t lane) const {
    const float angle = cone_angle_.at(lane);
    return angle > 0 ? std::min(angle, kPi) : 0;
}

float RayArguments::max_distance_at(size_t lane) const {
    const float most = max_distance_.at(lane);
    return most > 0 && most < kInfinity ? most : std::numeric_limits<float>::infinity();
}

}  // namespace trapeze
