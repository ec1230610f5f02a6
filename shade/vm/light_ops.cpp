// The built-in functions that gather light (RISpec 3.2, section 15.6).
#include "shade/vm/context_ops.h"
#include "shade/vm/kernels/light_kernels.h"

namespace trapeze::vm {
namespace {

using rsl::Op;

/// Three planes of a light's. Lights hand out const planes and kernels take operands, which are not: those of
/// inputs are only read.
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

/// Adds what a light sends to operand 0.
using AddLight = void (*)(const Run& run, Op op, std::span<const Operand> operands,
                          const Lights::Arriving& light);

/// Sums over the lights that are ambient, or over those that are not. A light's own shader runs when it is
/// first asked for at P; the suspended sum goes on with the next light when that is done. The order of the
/// lights is the order of the sum, so that its rounding does not depend on threads.
Task<> sum_lights(Run& run, const Step& step, std::span<const Operand> operands, bool ambient, AddLight add) {
    clear(run, operands[0]);
    Lights* lights = run.context().lights;
    if (!lights) co_return;
    const Operand& P = run.registers().input(step, 0);
    const LightRequest request{.P = P, .lasting = run.is_lasting_P(P)};
    for (size_t i = 0; i < lights->count(); ++i) {
        const Lights::Arriving* const light = co_await lights->arriving(i, request);
        if (light->ambient == ambient) add(run, step.op, operands, *light);
    }
}

/// ambient(): what ambient lights, which have no direction, send.
Task<> ambient(Run& run, const Step& step, std::span<const Operand> operands) {
    return sum_lights(run, step, operands, true,
                      [](const Run& r, Op, std::span<const Operand> out, const Lights::Arriving& light) {
                          vm::add_light(r.lanes(), planes_of(r, light.Cl), 1, out[0]);
                      });
}

/// diffuse(N): a light may say with __nondiffuse that it counts less here, or not at all.
Task<> diffuse(Run& run, const Step& step, std::span<const Operand> operands) {
    return sum_lights(run, step, operands, false,
                      [](const Run& r, Op, std::span<const Operand> all, const Lights::Arriving& light) {
                          if (light.diffuse > 0)
                              add_diffuse(r.lanes(), all[2], planes_of(r, light.direction),
                                          planes_of(r, light.Cl), light.diffuse, all[0]);
                      });
}

/// specular() and phong(): P, N, V and roughness or size. A light says with __nonspecular how much less it
/// counts here.
Task<> highlights(Run& run, const Step& step, std::span<const Operand> operands) {
    return sum_lights(run, step, operands, false,
                      [](const Run& r, Op op, std::span<const Operand> all, const Lights::Arriving& light) {
                          const auto add = op == Op::Specular ? add_specular : add_phong;
                          if (light.specular > 0)
                              add(r.lanes(), all[2], all[3], all[4], planes_of(r, light.direction),
                                  planes_of(r, light.Cl), light.specular, all[0]);
                      });
}

constexpr WaitingRow kLightRows[] = {
    {Op::Ambient, ambient},
    {Op::Diffuse, diffuse},
    {Op::Specular, highlights},
    {Op::Phong, highlights},
};

}  // namespace

WaitingOp find_light_op(Op op) {
    return waiting_op_in(kLightRows, op);
}

}  // namespace trapeze::vm
