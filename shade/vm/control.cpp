// The machine's control flow.
#include <fmt/format.h>

#include <cmath>
#include <cstring>

#include "shade/vm/machine.h"

namespace trapeze::vm {
namespace {

using rsl::Op;

bool lane_is_set(float lane) {
    uint32_t bits;
    std::memcpy(&bits, &lane, sizeof bits);
    return bits != 0;
}

float lane_of(bool set) {
    const uint32_t bits = set ? ~0u : 0u;
    float lane;
    std::memcpy(&lane, &bits, sizeof lane);
    return lane;
}

V3f triple_at(const Operand& operand, size_t lane) {
    return {Run::at(operand, 0, lane), Run::at(operand, 1, lane), Run::at(operand, 2, lane)};
}

/// Whether v lies within an angle of the axis; everything does from a half-turn on.
bool in_cone(const V3f& v, const V3f& axis, float angle) {
    if (angle >= 3.14159265f) return true;
    const float lengths = v.length() * axis.length();
    return lengths > 0 && v.dot(axis) >= lengths * std::cos(angle);
}

}  // namespace

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
        case Op::Illuminance:
            return enter_lights() ? next_light(steps, at) : step.target + 1;
        case Op::EndIlluminance:
            return next_light(steps, step.target);
        case Op::Illuminate:
        case Op::Solar:
            return enter_illuminate(step, at);
        case Op::EndIlluminate:
        case Op::EndSolar:
            masks_.leave_block();
            return at + 1;
        case Op::Gather:
            return enter_gather(steps, at);
        case Op::EndGather:
            return next_gather(steps, at);
        default:
            return at + 1;
    }
}

bool Run::uniform_condition(const Step& step) const {
    return lane_is_set(frame_.input(step, 0).data[0]);
}

/// The condition's plane, for lanes that may go separate ways though it is the same for all.
const float* Run::condition(const Step& step) {
    const Operand& operand = frame_.input(step, 0);
    if (operand.lane_mask) return operand.data;
    float* plane = scratch(1);
    std::fill_n(plane, lanes(), operand.data[0]);
    return plane;
}

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

/// Counts the steps of a loop's turn; true when all loops together have had their share.
bool Run::steps_are_spent(const Step& opening, size_t steps) {
    loop_steps_ += static_cast<int64_t>(steps);
    if (loop_steps_ <= frame_.executable().max_loop_steps()) return false;
    frame_.executable().found_endless();
    const std::string& name = frame_.program().name;
    if (context_.diagnostics)
        context_.diagnostics->error(
            opening.at, fmt::format("the loops of shader \"{}\" have taken too long; they are left", name),
            fmt::format("rsl-long-loops {}", name));
    return true;
}

/// Counts a turn of a loop; true when it was the last that it may have.
bool Run::turns_are_spent(const Step& opening) {
    const int most = frame_.executable().max_turns();
    if (++turns_[&opening] < most) return false;
    frame_.executable().found_endless();
    if (context_.diagnostics)
        context_.diagnostics->error(
            opening.at,
            fmt::format("this loop of shader \"{}\" has not ended after {} turns; it is left",
                        frame_.program().name, most),
            fmt::format("rsl-endless-loop {}:{}", opening.at.source, opening.at.line));
    return true;
}

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

/// False when there is nothing to loop over.
bool Run::enter_lights() {
    if (!context_.lights || context_.lights->count() == 0) return false;
    masks_.enter_loop();
    next_lights_.push_back(0);
    return true;
}

/// On with the first light, from the one that is next, that reaches a lane; past the block when there is
/// none.
size_t Run::next_light(const std::vector<Step>& steps, size_t opening) {
    const Step& step = steps[opening];
    const Operand& P = frame_.input(step, 1);
    const bool with_cone = step.count - step.outputs == 4;
    Lights& lights = *context_.lights;
    while (next_lights_.back() < lights.count() && !masks_.loop_is_over()) {
        if (next_lights_.back() > 0 && steps_are_spent(step, step.target - opening)) break;
        const size_t number = next_lights_.back()++;
        const Lights::Arriving& light = lights.arriving(number, P, is_lasting_P(P));
        if (light.ambient || !lights.in_category(number, frame_.text_input(step, 0))) continue;
        const float* reached = light.lit;
        scratch_used_ = 0;
        if (with_cone) {
            const Operand &axis = frame_.input(step, 2), &angle = frame_.input(step, 3);
            float* cone = scratch(1);
            for (size_t i = 0; i < lanes(); ++i) {
                const V3f L(light.L[i], light.L[lanes() + i], light.L[2 * lanes() + i]);
                cone[i] =
                    lane_of(lane_is_set(light.lit[i]) && in_cone(L, triple_at(axis, i), at(angle, 0, i)));
            }
            reached = cone;
        }
        masks_.start_turn(reached);
        if (masks_.none()) continue;
        const Operand &L = frame_.operands_of(step)[0], &Cl = frame_.operands_of(step)[1];
        std::memcpy(L.data, light.L, 3 * lanes() * sizeof(float));
        std::memcpy(Cl.data, light.Cl, 3 * lanes() * sizeof(float));
        current_light_ = number;
        return opening + 1;
    }
    next_lights_.pop_back();
    masks_.leave_block();
    return step.target + 1;
}

/// Until rays can be asked for, each of the samples misses: the second half runs as often.
size_t Run::enter_gather(const std::vector<Step>& steps, size_t at_step) {
    constexpr float kMostSamples = 65536;
    const Step& step = steps[at_step];
    warn(step, "gather() sees nothing yet: its rays count as misses", "rsl-no-rays gather");
    const float samples = at(frame_.input(step, 4), 0, 0);
    const size_t otherwise = step.target;
    if (!(samples >= 1)) return steps[otherwise].target + 1;
    masks_.enter_loop();
    gather_turns_.push_back(static_cast<int>(std::min(samples, kMostSamples)));
    return otherwise + 1;
}

size_t Run::next_gather(const std::vector<Step>& steps, size_t at_step) {
    const Step& opening = steps[steps[at_step].target];
    masks_.next_turn();
    if (--gather_turns_.back() > 0 && !masks_.loop_is_over() &&
        !steps_are_spent(opening, at_step - opening.target))
        return opening.target + 1;
    gather_turns_.pop_back();
    masks_.leave_block();
    return at_step + 1;
}

const float* Run::P_data() const {
    const rsl::RegisterId* P = frame_.program().find_global("P");
    return P ? frame_.operand(*P).data : nullptr;
}

/// Sets L in a light shader, from the light to the point, and lets the lanes run that its cone holds.
size_t Run::enter_illuminate(const Step& step, size_t at_step) {
    const bool solar = step.op == Op::Solar;
    const size_t inputs = step.count - step.outputs;
    const size_t first = solar ? 0 : 2;
    const Operand& L = frame_.operands_of(step)[0];
    float* lit = scratch(1);
    for (size_t i = 0; i < lanes(); ++i) {
        V3f direction;
        if (!solar)
            direction = triple_at(frame_.input(step, 0), i) - triple_at(frame_.input(step, 1), i);
        else
            direction = triple_at(frame_.input(step, 0), i) * (inputs == 1 ? -1.0f : 1.0f);
        bool reached = true;
        if (!solar && inputs > first)
            reached = in_cone(direction, triple_at(frame_.input(step, first), i),
                              at(frame_.input(step, first + 1), 0, i));
        lit[i] = lane_of(reached);
        for (int k = 0; k < 3; ++k) L.data[static_cast<size_t>(k) * L.stride + i] = direction[k];
    }
    masks_.enter_if(lit);
    if (LightOutput* out = context_.light_output) {
        const uint32_t* running = masks_.current();
        for (size_t i = 0; i < lanes(); ++i) {
            if (!running[i]) continue;
            out->lit[i] = ~0u;
            for (size_t k = 0; k < 3; ++k) out->L[k * lanes() + i] = L.data[k * L.stride + i];
        }
    }
    return masks_.none() ? step.target : at_step + 1;
}

}  // namespace trapeze::vm
