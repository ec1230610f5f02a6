#include "shade/rays/ray_arguments.h"

#include <algorithm>
#include <limits>
#include <numbers>
#include <string_view>

#include "core/portable_math.h"
#include "shade/operations/ray_parameters.h"

namespace trapeze {
namespace {

using rsl::Op;

/// The most rays of a call: a bound on absurd input.
constexpr float kMostSamples = 65536;
/// Of "maxsolidangle", steradians.
constexpr float kMaxSolidAngle = 0.1f;
constexpr float kStraightAngle = std::numbers::pi_v<float>;  ///< radians

bool is_text(const vm::Registers& registers, const vm::Step& step, size_t operand) {
    return operand < step.count &&
           registers.reg(registers.register_of(step, operand)).type.base == rsl::Base::String;
}

/// How many arguments stand before the names of outputs, and the names and values that may follow.
size_t plain_arguments(const vm::Registers& registers, const vm::Step& step) {
    const bool map_first = is_text(registers, step, step.outputs);
    if (step.op == Op::Gather) return 5;  // category, P, direction, angle, samples
    if (step.op == Op::Shadow || step.op == Op::Environment)
        return 2 + static_cast<size_t>(step.immediate);            // a map, a channel, P or R
    if (step.op == Op::Occlusion) return map_first ? 4 : 3;        // a map that is not used, P, N, samples
    if (step.op == Op::IndirectDiffuse) return map_first ? 2 : 3;  // a map and a direction; P, N, samples
    return 2;
}

std::string_view name_of(Op op) {
    switch (op) {
        case Op::Trace:
            return "trace";
        case Op::Occlusion:
            return "occlusion";
        case Op::IndirectDiffuse:
            return "indirectdiffuse";
        case Op::Environment:
            return "environment";
        case Op::Shadow:
            return "shadow";
        case Op::Gather:
            return "gather";
        default:
            return "transmission";
    }
}

/// Says what is wrong with the argument whose name is an operand, if the analysis has not: it has seen what
/// is constant, where it knew that rays are sent.
void warn_of(vm::Run& run, const vm::Step& step, size_t operand, bool of_map) {
    using Is = rsl::RayArgumentValue::Is;
    const vm::Registers& registers = run.registers();
    const std::string& name = registers.text(registers.register_of(step, operand));
    const rsl::RegisterId value = registers.register_of(step, operand + 1);
    const auto is_constant = [&](size_t k) {
        return registers.reg(registers.register_of(step, k)).kind == rsl::Register::Kind::Constant;
    };
    const bool numbers = registers.reg(value).type.base != rsl::Base::String;
    if (is_constant(operand) && (numbers || is_constant(operand + 1)) &&
        (!of_map || is_constant(step.outputs)))
        return;
    const rsl::Type& type = registers.reg(value).type;
    const Is is = type.is_array()                  ? Is::Other
                  : type.base == rsl::Base::Float  ? Is::Number
                  : type.base == rsl::Base::String ? Is::Text
                  : type.is_triple()               ? Is::Triple
                                                   : Is::Other;
    rsl::RayArgumentValue given{is, is == Is::Text ? &registers.text(value) : nullptr};
    const vm::Operand& number = registers.operand(value);
    if (is == Is::Number && number.lane_mask == 0) given.number = vm::Run::at(number, 0, 0);
    const std::string problem = rsl::ray_argument_problem(name_of(step.op), name, given, of_map);
    if (!problem.empty())
        run.warn(step, problem,
                 rsl::ray_argument_warning(step.at.source, step.at.line, step.at.column, name));
}

/// Where the point that is shaded is; lights have it elsewhere. Null where there is none.
const vm::Operand* shaded_point(const vm::Registers& registers) {
    const rsl::Program& program = registers.program();
    const bool light = program.kind == rsl::ShaderKind::Light;
    const rsl::RegisterId* const P = program.find_global(light ? "Ps" : "P");
    return P ? &registers.operand(*P) : nullptr;
}

}  // namespace

RayArguments::RayArguments(vm::Run& run, const vm::Step& step, std::span<const vm::Operand> operands) {
    const vm::Registers& registers = run.registers();
    const size_t plain = plain_arguments(registers, step), end = step.outputs + plain;
    const bool of_light = step.op == Op::Shadow, of_map = of_light || step.op == Op::Environment;
    const bool map_first = is_text(registers, step, step.outputs);
    const size_t first = step.outputs + (of_map ? 2 : map_first ? 1 : 0);
    if (map_first) map_ = registers.text_input(step, 0);
    bias.otherwise = -1, samples_.otherwise = 1;
    max_solid_angle.otherwise = kMaxSolidAngle, clamp.otherwise = 1;
    cone_angle_.otherwise = kStraightAngle / 2, max_distance_.otherwise = kInfinity;
    from_ = &operands[first], towards_ = &operands[first + 1 < end ? first + 1 : first];
    if (const vm::LightOutput* const light = run.context().light_output; of_light && light) {
        from_light_ = light->L, lanes_ = run.lanes();
        distant_light = light->distant;
    } else if (of_light) {  // in an illuminance block, L leads to the light
        towards_ = &registers.operand(*registers.program().find_global("L"));
        distant_light = run.light_of_turn()->distant;
    }
    if (step.op == Op::Environment) {
        towards_ = &operands[first], from_ = shaded_point(registers);
        const float wanted = vm::Run::at(operands[step.outputs + 1u], 0, 0);
        channel = wanted >= 2 ? 2 : wanted >= 1 ? 1 : 0;
    }
    if (step.op == Op::Gather) {
        cone_angle_.operand = &operands[first + 2], samples_.operand = &operands[first + 3];
        uniform_distribution = true, least_samples_ = 0;
    } else if (!of_map && first + 2 < end) {
        samples_.operand = &operands[first + 2];
    }
    // A block's results are all named; a call's first has no name.
    const size_t unnamed = step.op == Op::Gather ? 0 : 1, named = step.outputs - unnamed;
    for (size_t k = 0; k < named; ++k)
        outputs.push_back({registers.text_input(step, plain + k), &operands[unnamed + k]});
    const std::pair<std::string_view, LaneValue*> known[] = {{"samples", &samples_},
                                                             {"minsamples", &min_samples_},
                                                             {"bias", &bias},
                                                             {"maxdist", &max_distance_},
                                                             {"coneangle", &cone_angle_},
                                                             {"falloff", &falloff},
                                                             {"samplecone", &sample_cone_},
                                                             {"falloffmode", &falloff_mode},
                                                             {"samplebase", &sample_base},
                                                             {"pointbased", &point_based},
                                                             {"maxsolidangle", &max_solid_angle},
                                                             {"clamp", &clamp},
                                                             {"blur", &blur_}};
    V3f threshold;
    for (size_t i = end + named; i + 1 < step.count; i += 2) {
        const std::string& name = registers.text(registers.register_of(step, i));
        const bool text = is_text(registers, step, i + 1);
        warn_of(run, step, i, of_map);
        if (step.op == Op::Gather && sent.add(run, step, i, operands)) continue;
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

void RayArguments::take_text(std::string_view name, const std::string& text) {
    using Sides = RayFilter::Sides;
    using HitMode = RayAttributes::HitMode;
    if (name == "filename") cloud = text;
    if (name == "coordsystem" && !text.empty()) cloud_space = text;
    if (name == "distribution") uniform_distribution = text == "uniform";
    if (name == "label") label = text;
    if (name == "environmentmap") environment_map = text;
    if (name == "environmentspace" && !text.empty()) environment_space = text;
    if (name == "hitmode" && text == "primitive") hit_mode = HitMode::Primitive;
    if (name == "hitmode" && text == "shader") hit_mode = HitMode::Shader;
    if (name == "hitsides") {
        filter_.sides = text == "front"  ? Sides::Front
                        : text == "back" ? Sides::Back
                        : text == "both" ? Sides::Both
                                         : Sides::OfAttributes;
        filters_ = filters_ || filter_.sides != Sides::OfAttributes;
    }
    if (name == "subset") {
        filter_.subset = RaySubset(text);
        filters_ = filters_ || !text.empty();
    }
    if (name == "excludesubset") {
        filter_.excluded = RaySubset(text);
        filters_ = filters_ || !text.empty();
    }
}

V3f RayArguments::from_at(size_t lane) const {
    if (!from_) return V3f(std::numeric_limits<float>::quiet_NaN());  // nowhere
    return vm::Run::triple_at(*from_, lane);
}
V3f RayArguments::towards_at(size_t lane) const {
    if (from_light_)
        return -V3f(from_light_[lane], from_light_[lanes_ + lane], from_light_[2 * lanes_ + lane]);
    return vm::Run::triple_at(*towards_, lane);
}

int RayArguments::samples_at(size_t lane) const {
    const float asked = samples_.at(lane), least = min_samples_.at(lane);
    const float count = least > asked ? least : asked;  // also where "minsamples" is NaN
    return count >= 1 ? static_cast<int>(std::min(count, kMostSamples)) : least_samples_;  // also NaN
}

bool RayArguments::sets(std::string_view name) const {
    return std::ranges::find(outputs, name, &Output::name) != outputs.end();
}

float RayArguments::sample_cone_at(size_t lane) const {
    const bool blurs = !sample_cone_.operand;
    const float angle = blurs ? blur_.at(lane) : sample_cone_.at(lane);
    return angle > 0 ? std::min(angle, blurs ? kStraightAngle / 2 : kStraightAngle) : 0;
}
float RayArguments::cone_angle_at(size_t lane) const {
    const float angle = cone_angle_.at(lane);
    return angle > 0 ? std::min(angle, kStraightAngle) : 0;
}

float RayArguments::max_distance_at(size_t lane) const {
    const float most = max_distance_.at(lane);
    return most > 0 && most < kInfinity ? most : std::numeric_limits<float>::infinity();
}

float RayArguments::falloff_at(float distance, size_t lane) const {
    const float by = falloff.at(lane);
    if (!(by > 0) || distance >= kInfinity) return 1;
    if (falloff_mode.at(lane) == 0) return portable::exp(-by * distance);
    return portable::pow(std::max(0.0f, 1 - distance / max_distance_at(lane)), by);
}

}  // namespace trapeze
