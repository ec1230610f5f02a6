#include "shade/vm/machine.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdlib>
#include <cstring>
#include <new>

#include "shade/operations/op_table.h"

namespace trapeze::vm {

using rsl::Op;

/// What one run needs besides its registers, kept for the next at the same depth.
struct Machine::Level {
    struct Free {
        void operator()(float* p) const { std::free(p); }
    };
    MaskStack masks;
    std::vector<std::unique_ptr<float, Free>> scratch;  ///< one for each call of Run::scratch() in a step
    std::vector<size_t> scratch_floats;                 ///< size of each; they only grow
};

Machine::Machine() = default;
Machine::~Machine() = default;

/// Registers of one program are found again by its executable. Copies serve several layers or lights that use
/// the same shader at one time.
Registers& Machine::registers(const std::shared_ptr<const Executable>& executable, size_t copy) {
    std::unique_ptr<Registers>& registers = registers_[{executable.get(), copy}];
    if (!registers) registers = std::make_unique<Registers>(executable);
    return *registers;
}

void Machine::run(Registers& registers, const Context& context) {
    Run(*this, registers, context).run(registers.executable().code());
}

void Machine::run_initial(Registers& registers, size_t parameter, const Context& context) {
    Run(*this, registers, context).run(registers.executable().initial(parameter));
}

namespace {

Machine::Level& level_at(std::vector<std::unique_ptr<Machine::Level>>& levels, size_t depth) {
    while (levels.size() <= depth) levels.push_back(std::make_unique<Machine::Level>());
    return *levels[depth];
}

}  // namespace

Run::Run(Machine& machine, Registers& registers, const Context& context)
    : machine_(machine),
      registers_(registers),
      context_(context),
      level_(level_at(machine.levels_, machine.depth_)),
      masks_(level_.masks) {
    ++machine_.depth_;
    masks_.start(registers.lanes());
}

Run::~Run() {
    --machine_.depth_;
}

/// Scratch is counted by calls within a step, so that operands that a step asks for one after the other never
/// overlap; the next step begins again with the first.
float* Run::scratch(size_t planes) {
    const size_t floats = planes * lanes();
    if (scratch_used_ == level_.scratch.size()) {
        level_.scratch.emplace_back();
        level_.scratch_floats.push_back(0);
    }
    if (level_.scratch_floats[scratch_used_] < floats) {
        level_.scratch[scratch_used_].reset(
            static_cast<float*>(std::aligned_alloc(64, floats * sizeof(float))));
        if (!level_.scratch[scratch_used_]) throw std::bad_alloc();
        level_.scratch_floats[scratch_used_] = floats;
    }
    return level_.scratch[scratch_used_++].get();
}

void Run::warn(const Step& step, std::string text, std::string kind) {
    if (context_.diagnostics) context_.diagnostics->warning(step.at, std::move(text), std::move(kind));
}

/// Control says where to go on; after any other step it is the next.
void Run::run(const std::vector<Step>& steps) {
    for (size_t at = 0; at < steps.size();) {
        const Step& step = steps[at];
        if (rsl::is_control(step.op)) {
            at = control(steps, at);
        } else {
            plain(step);
            ++at;
        }
    }
}

/// Does a step with these operands, which are its own or scratch in place of its outputs, over `count` lanes.
void Run::call(const Step& step, std::span<const Operand> operands, size_t count) {
    if (step.kernel)
        step.kernel(count, operands);
    else if (step.context_op)
        step.context_op(*this, step, operands);
}

/// A step that is no control. It may write where its outputs are when all lanes run, and also when some do
/// not but nothing outlives the block in which they were switched off (Instruction::masked); else it goes
/// through scratch. A masked step with no lane left is not done at all.
void Run::plain(const Step& step) {
    const std::span<const Operand> operands = registers_.operands_of(step);
    scratch_used_ = 0;
    if (step.masked && !masks_.all()) {
        if (masks_.none()) return;
        // A uniform output has one value for all lanes, and is set whichever of them run.
        if (step.varying) return through_scratch(step, operands);
    }
    if (step.through_scratch) return through_scratch(step, operands);
    call(step, operands, step.varying ? lanes() : kLanes);
}

/// Computes into other planes, of which lanes that run are copied.
void Run::through_scratch(const Step& step, std::span<const Operand> operands) {
    // More operands than this have only calls with many named arguments.
    constexpr size_t kMaxInPlace = 32;
    Operand in_place[kMaxInPlace];
    std::vector<Operand> many;
    std::span<Operand> redirected(in_place, std::min(operands.size(), kMaxInPlace));
    if (operands.size() > kMaxInPlace) {
        many.resize(operands.size());
        redirected = many;
    }
    std::copy(operands.begin(), operands.end(), redirected.begin());
    for (size_t k = 0; k < step.outputs; ++k) {
        const uint32_t planes = registers_.executable().places()[registers_.register_of(step, k)].planes;
        if (!planes) continue;  // a text
        redirected[k].data = scratch(planes);
        // What the operation does not set is copied back, too, and must be what it was.
        if (rsl::keeps_output(step.op)) copy_planes(operands[k], planes, redirected[k].data);
    }
    call(step, redirected, step.varying ? lanes() : kLanes);
    for (size_t k = 0; k < step.outputs; ++k) {
        const uint32_t planes = registers_.executable().places()[registers_.register_of(step, k)].planes;
        if (planes) copy_running(step.masked && !masks_.all(), redirected[k].data, planes, operands[k]);
    }
}

/// All lanes of so many planes of an operand, one after the other.
void Run::copy_planes(const Operand& from, size_t planes, float* to) const {
    std::memcpy(to, from.data, planes * (from.lane_mask ? lanes() : kLanes) * sizeof(float));
}

/// Copies planes to an operand: all lanes, or (`masked`) those that run. A uniform operand has lanes of its
/// own number, kLanes, all of which are the same; it is copied whole.
void Run::copy_running(bool masked, const float* from, size_t planes, const Operand& to) const {
    const size_t plane = to.lane_mask ? lanes() : kLanes;
    if (!masked || !to.lane_mask) {
        std::memcpy(to.data, from, planes * plane * sizeof(float));
        return;
    }
    const uint32_t* running = masks_.current();
    for (size_t p = 0; p < planes; ++p) {
        const float* source = from + p * plane;
        float* target = to.data + p * plane;
        for (size_t i = 0; i < plane; ++i) target[i] = running[i] ? source[i] : target[i];
    }
}

}  // namespace trapeze::vm
