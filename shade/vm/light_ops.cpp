// The built-in functions that gather light (RISpec 3.2, section 15.6).
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

constexpr ContextRow kLightRows[] = {
    {Op::Ambient, ambient},
    {Op::Diffuse, diffuse},
    {Op::Specular, highlights},
    {Op::Phong, highlights},
};

}  // namespace

ContextOp find_light_op(Op op) {
    return context_op_in(kLightRows, op);
}

}  // namespace trapeze::vm
