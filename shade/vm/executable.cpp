#include "shade/vm/executable.h"

#include <algorithm>
#include <cstdlib>
#include <new>

#include "shade/code/blocks.h"
#include "shade/operations/op_table.h"
#include "shade/vm/plane_slots.h"
#include "shade/vm/run_defaults.h"

namespace trapeze::vm {
namespace {

using rsl::Blocks;
using rsl::Op;

/// The loop or scope that a jump leaves or goes on with; the outermost one when it names more than there are.
size_t left_by(const rsl::Code& code, const Blocks& blocks, size_t i) {
    size_t left = blocks.around[i];
    int levels = code[i].immediate;
    for (size_t b = left; b != Blocks::kNone; b = blocks.around[b]) {
        const bool counts = code[i].op == Op::Leave ? code[b].op == Op::Scope : rsl::opens_loop(code[b].op);
        if (!counts) continue;
        left = b;
        if (code[i].op == Op::Leave || --levels <= 0) break;
    }
    return left;
}

/// Whether control may have to run the shaders of lights, or of what rays hit.
bool may_wait(Op op) {
    return op == Op::Illuminance || op == Op::EndIlluminance || op == Op::Gather || op == Op::EndGather;
}

/// The end of the half of a block in which instruction i stands: its middle where that is still to come, or
/// its closing instruction. Lanes that have been switched off meet the others there.
size_t rest_of_block(const Blocks& blocks, size_t i) {
    const size_t around = blocks.around[i], middle = blocks.middle[around];
    return middle != Blocks::kNone && middle > i ? middle : blocks.end[around];
}

/// Where a step of control goes on when no lane is left to run what follows it. Made once when the code is
/// laid out, so that a run jumps without a search.
size_t target_of(const rsl::Code& code, const Blocks& blocks, size_t i) {
    const size_t around = blocks.around[i];
    switch (code[i].op) {
        case Op::If:
            return blocks.middle[i] != Blocks::kNone ? blocks.middle[i] : blocks.end[i];
        case Op::Else:
        case Op::GatherElse:
            return blocks.end[i];
        case Op::EndLoop:
        case Op::EndIlluminance:
        case Op::EndGather:
            return blocks.opening[i];
        case Op::LoopTest:
            return blocks.end[around];
        case Op::Break:
        case Op::Continue:
        case Op::Leave: {
            const size_t left = left_by(code, blocks, i);
            if (code[left].varying) return rest_of_block(blocks, i);
            return code[i].op == Op::Continue ? blocks.middle[left] : blocks.end[left] + 1;
        }
        case Op::EndIf:
            return around != Blocks::kNone && code[around].varying ? rest_of_block(blocks, i) : i + 1;
        case Op::Gather:
            return blocks.middle[i];
        default:
            return rsl::opens_block(code[i].op) ? blocks.end[i] : 0;
    }
}

}  // namespace

/// Constants come from aligned_alloc(), which delete must not be given.
void Executable::Free::operator()(float* p) const {
    std::free(p);
}

/// Registers are placed before steps are made, and defaults of parameters before the code; keeps_P_ is found
/// last, from the outputs of all instructions, since a call's output argument sets P as an assignment does.
Executable::Executable(rsl::Program source, const LoopLimits& limits)
    : program_(std::move(source)), limits_(limits) {
    place_registers();
    for (const rsl::ProgramParameter& parameter : program_.parameters)
        initials_.push_back(make_steps(parameter.initial));
    code_ = make_steps(program_.code);
    run_defaults_ = vm::has_run_default(program_);
    start_values_ = vm::start_values(program_);
    const rsl::RegisterId* P = program_.find_global("P");
    for (const rsl::Instruction& instruction : program_.code)
        for (size_t k = 0; k < instruction.outputs; ++k)
            if (P && instruction.operands[k] == *P) keeps_P_ = false;
}

/// Gives each register its place: varying ones share planes where they are never alive together, uniform ones
/// and constants have one block of kLanes floats for each component, texts are strings. Arrays of no length
/// in their type get memory in a run. Constants are filled in here, once for all runs.
void Executable::place_registers() {
    const PlaneSlots slots = assign_plane_slots(program_);
    varying_planes_ = slots.planes;
    places_.resize(program_.registers.size());
    for (size_t id = 0; id < places_.size(); ++id) {
        const rsl::Register& r = program_.registers[id];
        Place& place = places_[id];
        place.planes = plane_count(r.type);
        if (r.type.is_unsized()) {
            place.growing = static_cast<uint32_t>(growing_.size());
            growing_.push_back(static_cast<rsl::RegisterId>(id));
        }
        if (r.type.base == rsl::Base::String) {
            place.kind = Place::Kind::Text;
            place.at = text_count();
            place.planes = 0;
            for (int k = 0; k < std::max(r.type.length, 1); ++k)
                texts_.push_back(static_cast<size_t>(k) < r.texts.size() ? r.texts[static_cast<size_t>(k)]
                                                                         : "");
        } else if (r.kind == rsl::Register::Kind::Constant) {
            place.kind = Place::Kind::Constant;
            place.at = constant_planes_;
            constant_planes_ += place.planes;
        } else if (r.type.is_unsized()) {
            place.kind = r.varying ? Place::Kind::Varying : Place::Kind::Uniform;
        } else if (r.varying) {
            place.kind = Place::Kind::Varying;
            place.at = slots.first[id];
        } else {
            place.kind = Place::Kind::Uniform;
            place.at = uniform_planes_;
            uniform_planes_ += place.planes;
        }
    }
    constants_.reset(
        static_cast<float*>(std::aligned_alloc(64, (constant_planes_ + 1) * kLanes * sizeof(float))));
    if (!constants_) throw std::bad_alloc();
    for (size_t id = 0; id < places_.size(); ++id) {
        if (places_[id].kind != Place::Kind::Constant) continue;
        for (uint32_t k = 0; k < places_[id].planes; ++k)
            std::fill_n(constants_.get() + (places_[id].at + k) * kLanes, kLanes,
                        program_.registers[id].values[k]);
    }
}

/// The kernel for the widths that the instruction's operands have; null for control, for an operation that no
/// kernel does, and where one of the operands is a text.
Kernel Executable::kernel_of(const rsl::Instruction& instruction) const {
    if (rsl::is_control(instruction.op)) return nullptr;
    std::vector<int> widths;
    for (const rsl::RegisterId id : instruction.operands) {
        const rsl::Type type = program_.reg(id).type;
        if (type.base == rsl::Base::String) return nullptr;
        widths.push_back(rsl::width_of(type.base));
    }
    return find_kernel(instruction.op, widths);
}

/// The steps of a piece of code, one for each instruction, so that jumps may be worked out from the indices
/// of its blocks. The middle and the end of a block part lanes exactly if its opening does, and a jump if the
/// loop or scope that it leaves does.
std::vector<Step> Executable::make_steps(const rsl::Code& code) {
    const Blocks blocks(code);
    std::vector<Step> steps;
    steps.reserve(code.size());
    for (size_t i = 0; i < code.size(); ++i) {
        const rsl::Instruction& instruction = code[i];
        Step& step = steps.emplace_back();
        step.op = instruction.op;
        step.outputs = instruction.outputs;
        step.masked = instruction.masked;
        step.varying = instruction.varying;
        step.immediate = instruction.immediate;
        step.at = instruction.at;
        step.first = static_cast<uint32_t>(operands_.size());
        step.count = static_cast<uint32_t>(instruction.operands.size());
        operands_.insert(operands_.end(), instruction.operands.begin(), instruction.operands.end());
        step.kernel = kernel_of(instruction);
        if (!step.kernel)
            step.context_op = find_context_op(step.op), step.waiting_op = find_waiting_op(step.op);
        step.waits = step.waiting_op || may_wait(step.op);
        step.target = static_cast<uint32_t>(target_of(code, blocks, i));
        if (blocks.opening[i] != Blocks::kNone) step.varying = code[blocks.opening[i]].varying;
        // A jump is one for all lanes, or one lane by lane, as the block that it leaves is.
        const bool jumps = step.op == Op::Break || step.op == Op::Continue || step.op == Op::Leave;
        if (jumps) step.varying = code[left_by(code, blocks, i)].varying;
        // Without lanes an If goes to its Else, which a uniform one must pass by.
        if (step.op == Op::If) step.immediate = blocks.middle[i] != Blocks::kNone;
        if (step.op == Op::LoopTest) step.varying = code[blocks.around[i]].varying;
        // A kernel reads a group of lanes before it writes them; all else may still want what it has
        // overwritten.
        if (step.kernel && !rsl::reads_neighbours(step.op)) continue;
        for (size_t k = 0; k < instruction.input_count(); ++k)
            for (size_t o = 0; o < instruction.outputs; ++o)
                if (instruction.input(k) == instruction.operands[o]) step.through_scratch = true;
    }
    return steps;
}

}  // namespace trapeze::vm
