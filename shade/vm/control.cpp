// The machine's control flow. A block whose condition is the same in all lanes jumps, like any other
// program's. A block where lanes may part (Step::varying) runs for all of them, one way after the other, and
// MaskStack says which of them count; it is jumped over where no lane is left. Every function here takes the
// index of the step that is done and returns that of the next.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstring>

#include "shade/rsl/syntax/ast.h"
#include "shade/vm/kernels/light_kernels.h"
#include "shade/vm/machine.h"

namespace trapeze::vm {
namespace {

using rsl::Op;

/// Whether a lane of a Bool, which is all bits or none, is set: as a float it is NaN or 0.
bool lane_is_set(float lane) {
    uint32_t bits;
    std::memcpy(&bits, &lane, sizeof bits);
    return bits != 0;
}

/// The reverse: the word that masks of kernels hold for true and false.
float lane_of(bool set) {
    const uint32_t bits = set ? ~0u : 0u;
    float lane;
    std::memcpy(&lane, &bits, sizeof lane);
    return lane;
}

/// A plane, or several of so many lanes, as an operand. Kernels take operands and not planes; this dresses
/// one up, with the component stride of a varying register.
Operand varying(float* data, size_t lanes) {
    Operand operand;
    operand.data = data;
    operand.lane_mask = ~size_t{0};
    operand.stride = lanes;
    return operand;
}

}  // namespace

/// Steps that never run another shader. Blocks that are not varying leave no trace on the masks, so that
/// their closing instruction has nothing to undo.
size_t Run::control(const std::vector<Step>& steps, size_t at) {
    const Step& step = steps[at];
    scratch_used_ = 0;
    switch (step.op) {
        case Op::If:
        case Op::Else:
        case Op::EndIf:
            return if_step(step, at);
        case Op::Loop:
        case Op::LoopTest:
        case Op::LoopStep:
        case Op::EndLoop:
            return loop_step(steps, at);
        case Op::Break:
        case Op::Continue:
        case Op::Leave:
            return jump_step(step);
        case Op::Scope:
            if (step.varying) masks_.enter_scope();
            return at + 1;
        case Op::EndScope:
            if (step.varying) masks_.leave_block();
            return at + 1;
        case Op::Illuminate:
        case Op::Solar:
            return enter_illuminate(step, at);
        case Op::EndIlluminate:
        case Op::EndSolar:
            masks_.leave_block();
            return at + 1;
        case Op::GatherElse:
            return turn_to_misses(step, at);
        default:
            return at + 1;
    }
}

/// Of steps that wait (may_wait() in executable.cpp).
Task<size_t> Run::waiting_control(const std::vector<Step>& steps, size_t at) {
    const Step& step = steps[at];
    scratch_used_ = 0;
    switch (step.op) {
        case Op::Illuminance:
            if (!enter_lights(step)) co_return step.target + 1;
            co_return co_await next_light(steps, at);
        case Op::EndIlluminance:
            co_return co_await next_light(steps, step.target);
        default:
            co_return co_await gather_step(steps, at);
    }
}

/// The condition of a step whose lanes go together: its first lane speaks for all.
bool Run::uniform_condition(const Step& step) const {
    return lane_is_set(registers_.input(step, 0).data[0]);
}

/// The condition's plane, for lanes that may go separate ways though it is the same for all.
const float* Run::condition(const Step& step) {
    const Operand& operand = registers_.input(step, 0);
    if (operand.lane_mask) return operand.data;
    float* plane = scratch(1);
    std::fill_n(plane, lanes(), operand.data[0]);
    return plane;
}

/// If, Else and EndIf. Where lanes part, Else runs the lanes that were on at the If and failed its condition;
/// it is given the condition again, a temporary that nothing in between sets.
size_t Run::if_step(const Step& step, size_t at) {
    if (step.op == Op::EndIf) {
        if (step.varying) masks_.leave_block();
        return masks_.none() ? step.target : at + 1;
    }
    if (!step.varying) {
        if (step.op == Op::Else) return step.target;
        // Past an Else, which would take the way to the end.
        return uniform_condition(step) ? at + 1 : step.target + (step.immediate ? 1 : 0);
    }
    if (step.op == Op::If)
        masks_.enter_if(condition(step));
    else
        masks_.turn_to_else(condition(step));
    return masks_.none() ? step.target : at + 1;
}

/// Loop, LoopTest, LoopStep and EndLoop. Lanes that fail the test leave for good, lanes that met a Continue
/// come back at LoopStep. EndLoop goes back to the step after Loop unless no lane is left or the loop has had
/// its share of turns and steps (LoopLimits).
size_t Run::loop_step(const std::vector<Step>& steps, size_t at) {
    const Step& step = steps[at];
    switch (step.op) {
        case Op::Loop:
            turns_[&step] = 0;
            if (step.varying) masks_.enter_loop();
            return at + 1;
        case Op::LoopTest:
            if (!step.varying) return uniform_condition(step) ? at + 1 : step.target + 1;
            masks_.test_loop(condition(step));
            return masks_.none() ? step.target : at + 1;
        case Op::LoopStep:
            if (step.varying) masks_.next_turn();
            return at + 1;
        default: {
            if (step.varying && masks_.loop_is_over()) {
                masks_.leave_block();
                return at + 1;
            }
            const Step& opening = steps[step.target];
            if (!steps_are_spent(opening, at - step.target) && !turns_are_spent(opening))
                return step.target + 1;
            if (step.varying) masks_.leave_block();
            return at + 1;
        }
    }
}

/// Counts the steps of a loop's turn; true when all loops together have had their share. A bound besides that
/// of turns: loops within loops multiply, each with few turns of its own.
bool Run::steps_are_spent(const Step& opening, size_t steps) {
    loop_steps_ += static_cast<int64_t>(steps);
    if (loop_steps_ <= registers_.executable().max_loop_steps()) return false;
    registers_.executable().found_endless();
    const std::string& name = registers_.program().name;
    if (context_.diagnostics)
        context_.diagnostics->error(
            opening.at, fmt::format("the loops of shader \"{}\" have taken too long; they are left", name),
            fmt::format("rsl-long-loops {}", name));
    return true;
}

/// Counts a turn of a loop; true when it was the last that it may have. Turns count anew at each entry of the
/// loop; a shader that loops for ever must not hold up the frame.
bool Run::turns_are_spent(const Step& opening) {
    const int most = registers_.executable().max_turns();
    if (++turns_[&opening] < most) return false;
    registers_.executable().found_endless();
    if (context_.diagnostics)
        context_.diagnostics->error(
            opening.at,
            fmt::format("this loop of shader \"{}\" has not ended after {} turns; it is left",
                        registers_.program().name, most),
            fmt::format("rsl-endless-loop {}:{}", opening.at.source, opening.at.line));
    return true;
}

/// Break, Continue and Leave. A jump that all lanes make together is one; else the lanes that make it are
/// taken off the masks of the blocks that they leave, and the others go on.
size_t Run::jump_step(const Step& step) {
    if (!step.varying) return step.target;
    if (step.op == Op::Break)
        masks_.break_loops(step.immediate);
    else if (step.op == Op::Continue)
        masks_.continue_loop(step.immediate);
    else
        masks_.leave_scope();
    return step.target;
}

/// False when there is nothing to loop over. Illuminance is a loop for the masks, whose turns are lights:
/// break and continue in it mean what they mean in other loops.
bool Run::enter_lights(const Step& step) {
    if (!context_.lights || context_.lights->count() == 0) return false;
    LightLoop loop;
    for (size_t i = static_cast<size_t>(step.immediate); step.outputs + i + 1 < step.count; i += 2) {
        const std::string_view name = registers_.text_input(step, i);
        const rsl::RegisterId value = registers_.register_of(step, step.outputs + i + 1);
        const rsl::Type type = registers_.reg(value).type;
        if (!name.starts_with(rsl::kSendToLight)) {  // "lightcache"
            loop.refresh = registers_.text(value) == "refresh";
            continue;
        }
        SentValue& sent = loop.sent.emplace_back();
        sent.name = name.substr(rsl::kSendToLight.size());
        sent.type = type;
        if (type.base == rsl::Base::String)
            sent.texts = {&registers_.text(value), static_cast<size_t>(std::max(type.length, 1))};
        else
            sent.value = registers_.operand(value);
    }
    if (!loop.sent.empty()) loop.lanes.assign(masks_.current(), masks_.current() + lanes());
    masks_.enter_loop();
    light_loops_.push_back(std::move(loop));
    return true;
}

/// Goes on with the first light, from the next one on, that reaches any lane; past the block when there is
/// none.
Task<size_t> Run::next_light(const std::vector<Step>& steps, size_t opening) {
    const Step& step = steps[opening];
    const Operand& P = registers_.input(step, 1);
    const bool with_cone = step.immediate == 4;
    Lights& lights = *context_.lights;
    LightLoop& loop = light_loops_.back();
    const LightRequest request{.P = P,
                               .lasting = is_lasting_P(P),
                               .refresh = loop.refresh,
                               .sent = loop.sent,
                               .lanes = loop.lanes.data(),
                               .depth = light_loops_.size() - 1,
                               .at = step.at};
    while (loop.next < lights.count() && !masks_.loop_is_over()) {
        if (loop.next > 0 && steps_are_spent(step, step.target - opening)) break;
        const size_t number = loop.next++;
        // The light's own shader runs here, if what it sends to P is not known yet.
        const Lights::Arriving& light = *co_await lights.arriving(number, request);
        if (!lights.in_loop(light, registers_.text_input(step, 0))) continue;
        // Lanes that the light does not reach, or outside the cone asked for, sit this turn out.
        const float* reached = light.lit;
        scratch_used_ = 0;
        if (with_cone && !light.ambient) {
            const Operand &axis = registers_.input(step, 2), &angle = registers_.input(step, 3);
            float* cone = scratch(1);
            const Operand inside = varying(cone, lanes());
            cone_mask(lanes(), varying(const_cast<float*>(light.L), lanes()), axis, angle, inside);
            static constexpr int kBools[] = {1, 1, 1};
            find_kernel(Op::And, kBools)(
                lanes(), std::array{inside, inside, varying(const_cast<float*>(light.lit), lanes())});
            reached = cone;
        }
        masks_.start_turn(reached);
        if (masks_.none()) continue;
        const Operand &L = registers_.operands_of(step)[0], &Cl = registers_.operands_of(step)[1];
        std::memcpy(L.data, light.L, 3 * lanes() * sizeof(float));
        std::memcpy(Cl.data, light.Cl, 3 * lanes() * sizeof(float));
        loop.light = &light;
        last_light_ = light.registers;
        co_return opening + 1;
    }
    light_loops_.pop_back();
    masks_.leave_block();
    co_return step.target + 1;
}

/// Null where the program does not name P at all.
const float* Run::P_data() const {
    const rsl::RegisterId* P = registers_.program().find_global("P");
    return P ? registers_.operand(*P).data : nullptr;
}

/// Sets L in a light shader, from the light to the point, and lets the lanes run that its cone holds.
size_t Run::enter_illuminate(const Step& step, size_t at_step) {
    const bool solar = step.op == Op::Solar;
    const size_t inputs = step.count - step.outputs;
    const Operand& L = registers_.operands_of(step)[0];
    leave_light(step, L);
    float* lit = scratch(1);
    if (!solar && inputs > 2)
        cone_mask(lanes(), L, registers_.input(step, 2), registers_.input(step, 3), varying(lit, lanes()));
    else
        std::fill_n(lit, lanes(), lane_of(true));
    masks_.enter_if(lit);
    // Whoever asked this light wants to know where it is and which lanes it lights, besides Cl.
    if (LightOutput* out = context_.light_output) {
        out->distant = solar, out->is_known = true;
        copy_running(!masks_.all(), lit, 1, varying(reinterpret_cast<float*>(out->lit), lanes()));
        copy_running(!masks_.all(), L.data, 3, varying(out->L, lanes()));
    }
    return masks_.none() ? step.target : at_step + 1;
}

/// The way from the light to each point: from its place, or along its axis, or against Ns when it shines
/// from all sides (RISpec 3.2, solar).
void Run::leave_light(const Step& step, const Operand& L) {
    static constexpr int kTriples[] = {3, 3, 3};
    const std::span<const int> widths(kTriples);
    const Operand& first = registers_.input(step, 0);
    if (step.op != Op::Solar)
        find_kernel(Op::Subtract, widths)(lanes(), std::array{L, first, registers_.input(step, 1)});
    else if (step.count - step.outputs == 1)
        find_kernel(Op::Negate, widths.first(2))(lanes(), std::array{L, first});
    else
        find_kernel(Op::Move, widths.first(2))(lanes(), std::array{L, first});
}

}  // namespace trapeze::vm
