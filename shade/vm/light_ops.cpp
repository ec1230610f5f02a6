// The built-in functions that gather light (RISpec 3.2, section 15.6), and those that would ask for rays.
#include <cctype>
#include <string>

#include "shade/operations/op_table.h"
#include "shade/vm/context_ops.h"
#include "shade/vm/kernels/light_kernels.h"

namespace trapeze::vm {
namespace {

using rsl::Op;

/// Three planes of a light's.
Operand planes_of(const Run& run, const float* first) {
    Operand operand;
    operand.data = const_cast<float*>(first);  // an input
    operand.lane_mask = ~size_t{0};
    operand.stride = run.lanes();
    return operand;
}

/// Sums begin at black: the output's three planes, which vary.
void clear(const Run& run, const Operand& out) {
    for (size_t k = 0; k < 3; ++k) std::fill_n(out.data + k * out.stride, run.lanes(), 0.0f);
}

/// Calls `add(light)` for each light that is ambient, or for each that is not.
template <class Add>
void for_lights(Run& run, const Step& step, bool ambient, const Add& add) {
    Lights* lights = run.context().lights;
    if (!lights) return;
    const Operand& P = run.registers().input(step, 0);
    for (size_t i = 0; i < lights->count(); ++i) {
        const Lights::Arriving& light = lights->arriving(i, P, run.is_lasting_P(P));
        if (light.ambient == ambient) add(light);
    }
}

/// ambient(): what ambient lights, which have no direction, send.
void ambient(Run& run, const Step& step, std::span<const Operand> operands) {
    clear(run, operands[0]);
    for_lights(run, step, true, [&](const Lights::Arriving& light) {
        add_light(run.lanes(), planes_of(run, light.Cl), 1, operands[0]);
    });
}

/// diffuse(N): a light may say with __nondiffuse that it counts less here, or not at all.
void diffuse(Run& run, const Step& step, std::span<const Operand> operands) {
    clear(run, operands[0]);
    for_lights(run, step, false, [&](const Lights::Arriving& light) {
        if (light.diffuse > 0)
            add_diffuse(run.lanes(), operands[2], planes_of(run, light.direction), planes_of(run, light.Cl),
                        light.diffuse, operands[0]);
    });
}

/// specular() and phong(): P, N, V and roughness or size.
void highlights(Run& run, const Step& step, std::span<const Operand> operands) {
    clear(run, operands[0]);
    const auto add = step.op == Op::Specular ? add_specular : add_phong;
    for_lights(run, step, false, [&](const Lights::Arriving& light) {
        if (light.specular > 0)
            add(run.lanes(), operands[2], operands[3], operands[4], planes_of(run, light.direction),
                planes_of(run, light.Cl), light.specular, operands[0]);
    });
}

/// Rays that nothing answers yet: black, no distance, nothing in the way.
void no_ray(Run& run, const Step& step, std::span<const Operand> operands) {
    std::string function(rsl::row_of(step.op).name);  // as in RSL but for capitals
    for (char& c : function) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
    run.warn(step, function + "() sees nothing yet: its rays miss everything", "rsl-no-rays " + function);
    // transmission() and visibility() return 1: nothing is in the way.
    const bool open = step.op == Op::Transmission || step.op == Op::Visibility;
    const int width = operands[0].stride ? 3 : 1;
    const float miss = step.op == Op::Trace && width == 1 ? 1e30f : open ? 1.0f : 0.0f;
    const std::array<float, 3> values{miss, miss, miss};
    fill_operand(run, operands[0], std::span(values).first(static_cast<size_t>(width)));
}

/// rayinfo() finds nothing, and raylevel() is 0: shaders only run for what the camera sees.
void ray_info(Run& run, const Step&, std::span<const Operand> operands) {
    fill_operand(run, operands[0], std::array{0.0f});
}

constexpr ContextRow kLightRows[] = {
    {Op::Ambient, ambient},   {Op::Diffuse, diffuse},   {Op::Specular, highlights},
    {Op::Phong, highlights},  {Op::Trace, no_ray},      {Op::Transmission, no_ray},
    {Op::Visibility, no_ray}, {Op::Occlusion, no_ray},  {Op::IndirectDiffuse, no_ray},
    {Op::RayInfo, ray_info},  {Op::RayLevel, ray_info},
};

}  // namespace

ContextOp find_light_op(Op op) {
    return context_op_in(kLightRows, op);
}

}  // namespace trapeze::vm
