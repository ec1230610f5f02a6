// The built-in functions that ask for rays. The scene is not known here: shade/rays answers, and shade/clouds
// where discs stand for it.
#include <array>
#include <cctype>
#include <string>

#include "shade/vm/context_ops.h"

namespace trapeze::vm {
namespace {

using rsl::Op;

/// Directions of unit length: what is open about N is so about N alone.
void fill_with_unit(const Run& run, const Operand& out, const Operand& N) {
    for (size_t lane = 0; lane < plane_size(run, out); ++lane) {
        const V3f unit = Run::triple_at(N, lane).normalized();
        for (size_t k = 0; k < 3; ++k) out.data[k * out.stride + lane] = unit[static_cast<int>(k)];
    }
}

/// What all rays find where there is nothing: black, no distance, nothing in the way. As a float, trace() is
/// the distance to what is hit, and 1e30 says that nothing is; transmission() and visibility() are how much
/// gets through, and so 1.
void miss(Run& run, const Step& step, std::span<const Operand> operands) {
    warn_of_no_rays(run, step);
    const bool open = step.op == Op::Transmission || step.op == Op::Visibility;
    const int width = operands[0].stride ? 3 : 1;
    const float value = step.op == Op::Trace && width == 1 ? 1e30f : open ? 1.0f : 0.0f;
    const std::array<float, 3> values{value, value, value};
    fill_operand(run, operands[0], std::span(values).first(static_cast<size_t>(width)));
    // Their names come behind P and R, or P, N and the number of rays.
    const bool is_of_sky = step.op == Op::Occlusion || step.op == Op::IndirectDiffuse;
    for (size_t k = 1; (is_of_sky || step.op == Op::Trace) && k < step.outputs; ++k) {
        const std::string& name = run.registers().text_input(step, k + (is_of_sky ? 2 : 1));
        if (name == "environmentdir") {
            fill_with_unit(run, operands[k], operands[step.outputs + 1u]);
            continue;
        }
        const float told = name == "hitdist" ? 1e30f : is_of_sky ? 0.0f : 1.0f;
        fill_operand(run, operands[k], std::array{told, told, told});
    }
}

/// Trace, Transmission, Visibility, and what look_over_sky() leaves over; shade/rays tells them apart by
/// step.op.
Task<> trace(Run& run, const Step& step, std::span<const Operand> operands) {
    if (run.context().rays)
        co_await run.context().rays->trace(run, step, operands);
    else
        miss(run, step, operands);
}

/// By discs of a point cloud, or by rays.
Task<> look_over_sky(Run& run, const Step& step, std::span<const Operand> operands) {
    Clouds* const clouds = run.context().clouds;
    if (!clouds || !clouds->over_discs(run, step, operands)) co_await trace(run, step, operands);
}

/// Without a scene all points are those that the camera sees: depth 0, type "camera".
RayFacts facts_of(const Run& run) {
    return run.context().rays ? run.context().rays->facts() : RayFacts();
}

/// rayinfo("origin", p), rayinfo("direction", v) and rayinfo("length", f): of the ray that has hit the point,
/// lane by lane. False: another question, or a variable of another type.
bool tell_way(Run& run, const Step& step, std::span<const Operand> operands) {
    const Registers& registers = run.registers();
    const std::string& what = registers.text_input(step, 0);
    const bool is_length = what == "length";
    if (!is_length && what != "origin" && what != "direction") return false;
    const int width = rsl::width_of(registers.reg(registers.register_of(step, 1)).type.base);
    const Operand &to = operands[1], &origin = operands[3], &way = operands[4];
    if (width != (is_length ? 1 : 3)) return false;
    for (size_t lane = 0; lane < plane_size(run, to); ++lane) {
        const V3f along = Run::triple_at(way, lane);
        if (is_length)
            to.data[lane] = along.length();
        else
            for (size_t k = 0; k < 3; ++k)
                to.data[k * to.stride + lane] =
                    what == "origin" ? Run::at(origin, static_cast<int>(k), lane) : along.normalized()[k];
    }
    return true;
}

/// rayinfo("depth", d) and its like; unknown questions find nothing.
void ray_info(Run& run, const Step& step, std::span<const Operand> operands) {
    if (step.op == Op::RayWay && tell_way(run, step, operands))
        return fill_operand(run, operands[0], std::array{1.0f});
    const RayFacts facts = facts_of(run);
    Registers& registers = run.registers();
    const std::string& what = registers.text_input(step, 0);
    const rsl::RegisterId to = registers.register_of(step, 1);
    const bool wants_text = registers.reg(to).type.base == rsl::Base::String;
    const std::pair<std::string_view, int> numbers[] = {{"depth", facts.depth},
                                                        {"diffusedepth", facts.diffuse_depth},
                                                        {"speculardepth", facts.specular_depth},
                                                        {"shadowdepth", facts.shadow_depth}};
    const std::pair<std::string_view, std::string_view> texts[] = {{"type", facts.type},
                                                                   {"label", facts.label}};
    bool known = false;
    for (const auto& [name, number] : numbers)
        if (name == what && !wants_text && operands[1].data) {
            fill_operand(run, operands[1], std::array{static_cast<float>(number)});
            known = true;
        }
    for (const auto& [name, text] : texts)
        if (name == what && wants_text) {
            registers.text(to) = text;
            known = true;
        }
    fill_operand(run, operands[0], std::array{known ? 1.0f : 0.0f});
}

/// Both raylevel() and raydepth(): the bounces from the camera.
void ray_level(Run& run, const Step&, std::span<const Operand> operands) {
    fill_operand(run, operands[0], std::array{static_cast<float>(facts_of(run).depth)});
}

/// isindirectray() and isshadowray(): at what diffuse rays, or those of shadows, have hit.
void is_of_kind(Run& run, const Step& step, std::span<const Operand> operands) {
    const std::string_view wanted = step.op == Op::IsIndirectRay ? "diffuse" : "transmission";
    fill_operand(run, operands[0], std::array{facts_of(run).type == wanted ? 1.0f : 0.0f});
}

void ray_label(Run& run, const Step& step, std::span<const Operand>) {
    run.registers().text(run.registers().register_of(step, 0)) = facts_of(run).label;
}

constexpr ContextRow kRayRows[] = {
    {Op::RayInfo, ray_info},   {Op::RayWay, ray_info},          {Op::RayLevel, ray_level},
    {Op::RayLabel, ray_label}, {Op::IsIndirectRay, is_of_kind}, {Op::IsShadowRay, is_of_kind},
};
constexpr WaitingRow kWaitingRayRows[] = {
    {Op::Trace, trace},
    {Op::Transmission, trace},
    {Op::Visibility, trace},
    {Op::Occlusion, look_over_sky},
    {Op::IndirectDiffuse, look_over_sky},
};

}  // namespace

void warn_of_no_rays(Run& run, const Step& step) {
    if (run.registers().program().kind == rsl::ShaderKind::Imager)
        run.warn(step, "imagers send no rays: nothing is there to be seen or to hide anything",
                 "rsl-imager-rays");
}

ContextOp find_ray_op(Op op) {
    return context_op_in(kRayRows, op);
}

WaitingOp find_waiting_ray_op(Op op) {
    return waiting_op_in(kWaitingRayRows, op);
}

}  // namespace trapeze::vm
