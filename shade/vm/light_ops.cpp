// The built-in functions that gather light (RISpec 3.2, section 15.6), and those that would ask for rays.
#include <fmt/format.h>

#include "shade/kernels.h"
#include "shade/vm/context_ops.h"

namespace trapeze::vm {
namespace {

using rsl::Op;

/// An input's planes, written out for each lane if it is uniform.
ConstPlane3 triple_planes(Run& run, const Operand& operand) {
    const size_t lanes = run.lanes();
    if (operand.lane_mask)
        return {{operand.data, lanes},
                {operand.data + operand.stride, lanes},
                {operand.data + 2 * operand.stride, lanes}};
    float* planes = run.scratch(3);
    for (size_t k = 0; k < 3; ++k) std::fill_n(planes + k * lanes, lanes, operand.data[k * operand.stride]);
    return {{planes, lanes}, {planes + lanes, lanes}, {planes + 2 * lanes, lanes}};
}

ConstPlane float_plane(Run& run, const Operand& operand) {
    if (operand.lane_mask) return {operand.data, run.lanes()};
    float* plane = run.scratch(1);
    std::fill_n(plane, run.lanes(), operand.data[0]);
    return {plane, run.lanes()};
}

Plane3 output_planes(Run& run, const Operand& out) {
    const size_t lanes = run.lanes();
    return {{out.data, lanes}, {out.data + out.stride, lanes}, {out.data + 2 * out.stride, lanes}};
}

ConstPlane3 planes_at(const Run& run, const float* first) {
    const size_t lanes = run.lanes();
    return {{first, lanes}, {first + lanes, lanes}, {first + 2 * lanes, lanes}};
}

/// A light's colour, or its share for one of the built-in functions.
ConstPlane3 shared(Run& run, const Lights::Arriving& light, float share) {
    if (share == 1) return planes_at(run, light.Cl);
    float* scaled = run.scratch(3);
    for (size_t i = 0; i < 3 * run.lanes(); ++i) scaled[i] = light.Cl[i] * share;
    return planes_at(run, scaled);
}

void clear(const Run& run, const Operand& out) {
    for (size_t k = 0; k < 3; ++k) std::fill_n(out.data + k * out.stride, run.lanes(), 0.0f);
}

/// Calls `add(light)` for each light that is ambient, or for each that is not.
template <class Add>
void for_lights(Run& run, const Step& step, bool ambient, const Add& add) {
    Lights* lights = run.context().lights;
    if (!lights) return;
    const Operand& P = run.frame().input(step, 0);
    for (size_t i = 0; i < lights->count(); ++i) {
        const Lights::Arriving& light = lights->arriving(i, P, run.is_lasting_P(P));
        if (light.ambient == ambient) add(light);
    }
}

void ambient(Run& run, const Step& step, std::span<const Operand> operands) {
    clear(run, operands[0]);
    const Plane3 out = output_planes(run, operands[0]);
    for_lights(run, step, true,
               [&](const Lights::Arriving& light) { kernels::add(planes_at(run, light.Cl), out); });
}

void diffuse(Run& run, const Step& step, std::span<const Operand> operands) {
    clear(run, operands[0]);
    const Plane3 out = output_planes(run, operands[0]);
    const ConstPlane3 N = triple_planes(run, operands[2]);
    for_lights(run, step, false, [&](const Lights::Arriving& light) {
        if (light.diffuse > 0)
            kernels::add_diffuse(N, planes_at(run, light.direction), shared(run, light, light.diffuse), out);
    });
}

void specular(Run& run, const Step& step, std::span<const Operand> operands) {
    clear(run, operands[0]);
    const Plane3 out = output_planes(run, operands[0]);
    const ConstPlane3 N = triple_planes(run, operands[2]), V = triple_planes(run, operands[3]);
    const ConstPlane roughness = float_plane(run, operands[4]);
    for_lights(run, step, false, [&](const Lights::Arriving& light) {
        if (light.specular > 0)
            kernels::add_specular(N, V, planes_at(run, light.direction), shared(run, light, light.specular),
                                  roughness, out);
    });
}

/// Rays that nothing answers yet: black, no distance, nothing in the way.
void no_ray(Run& run, const Step& step, std::span<const Operand> operands) {
    run.warn(step, fmt::format("{}() sees nothing yet: its rays miss everything", rsl::op_name(step.op)),
             fmt::format("rsl-no-rays {}", rsl::op_name(step.op)));
    const bool open = step.op == Op::Transmission || step.op == Op::Visibility;
    const int width = operands[0].stride ? 3 : 1;
    const float miss = step.op == Op::Trace && width == 1 ? 1e30f : open ? 1.0f : 0.0f;
    const std::array<float, 3> values{miss, miss, miss};
    fill_operand(run, operands[0], std::span(values).first(static_cast<size_t>(width)));
}

void ray_info(Run& run, const Step&, std::span<const Operand> operands) {
    fill_operand(run, operands[0], std::array{0.0f});
}

}  // namespace

ContextOp find_light_op(Op op) {
    switch (op) {
        case Op::Ambient:
            return ambient;
        case Op::Diffuse:
            return diffuse;
        case Op::Specular:
            return specular;
        case Op::Trace:
        case Op::Transmission:
        case Op::Visibility:
        case Op::Occlusion:
        case Op::IndirectDiffuse:
            return no_ray;
        case Op::RayInfo:
        case Op::RayLevel:
            return ray_info;
        default:
            return nullptr;
    }
}

}  // namespace trapeze::vm
