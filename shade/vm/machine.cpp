#include "shade/vm/machine.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdlib>
#include <cstring>
#include <new>

#include "shade/operations/op_table.h"

namespace trapeze::vm {

using rsl::Op;

/// What one run needs besides its registers, kept for the next at the same depth. Levels are owned by the
/// machine and outlive their runs: masks and scratch of depth d are free again for any run that starts at
/// that depth.
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

Task<> Machine::run(Registers& registers, const Context& context) {
    Run run(*this, registers, context);
    co_await run.run(registers.executable().code());
}

Task<> Machine::run_initial(Registers& registers, size_t parameter, const Context& context) {
    Run run(*this, registers, context);
    co_await run.run(registers.executable().initial(parameter));
}

namespace {

/// Levels are held by pointer, so that a run keeps its reference while runs inside it add more of them.
Machine::Level& level_at(std::vector<std::unique_ptr<Machine::Level>>& levels, size_t depth) {
    while (levels.size() <= depth) levels.push_back(std::make_unique<Machine::Level>());
    return *levels[depth];
}

}  // namespace

/// The depth counts runs that are open on this machine. Runs end in the reverse order of their beginning,
/// since each is awaited by the one that started it, so that a counter is enough.
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

/// The place is that of the step in the shader's source; the kind makes the message appear once however many
/// grids run into it.
void Run::warn(const Step& step, std::string text, std::string kind) {
    if (context_.diagnostics) context_.diagnostics->warning(step.at, std::move(text), std::move(kind));
}

/// Only the steps that may wait are awaited; all between them run in one plain function, which spares most
/// programs the cost of a coroutine for each step.
Task<> Run::run(const std::vector<Step>& steps) {
    for (size_t at = 0; (at = run_to_wait(steps, at)) < steps.size();) {
        if (steps[at].waiting_op) {
            co_await waiting(steps[at]);
            ++at;
        } else {
            at = co_await waiting_control(steps, at);
        }
    }
}

/// Runs steps from one on, until one may have to wait for other shaders, or to the end; returns where it is.
/// Control says where to go on; after any other step it is the next.
size_t Run::run_to_wait(const std::vector<Step>& steps, size_t at) {
    while (at < steps.size() && !steps[at].waits) {
        const Step& step = steps[at];
        if (rsl::is_control(step.op)) {
            at = control(steps, at);
        } else {
            plain(step);
            ++at;
        }
    }
    return at;
}

/// Does a step with these operands, which are its own or scratch in place of its outputs, over `count` lanes.
void Run::call(const Step& step, std::span<const Operand> operands, size_t count) {
    if (step.kernel)
        step.kernel(count, operands);
    else if (step.context_op)
        step.context_op(*this, step, operands);
}

/// A step that is no control may write where its outputs are when all lanes run, and also when some do not
/// but nothing outlives the block in which they were switched off (Instruction::masked); else it goes through
/// scratch. A masked step with no lane left is not done at all.
Run::Way Run::way_of(const Step& step) const {
    if (step.masked && !masks_.all()) {
        if (masks_.none()) return Way::NotAtAll;
        // A uniform output has one value for all lanes, and is set whichever of them run.
        if (step.varying && !rsl::masks_itself(step.op)) return Way::ThroughScratch;
    }
    return step.through_scratch && !rsl::masks_itself(step.op) ? Way::ThroughScratch : Way::InPlace;
}

/// Computes into other planes, of which lanes that run are copied (take_back()). Operations know nothing of
/// masks: they set all lanes, and what lanes that do not run had before is kept by copying the others back.
class Run::Redirected {
  public:
    Redirected(Run& run, const Step& step, std::span<const Operand> operands) : all_(in_place_) {
        if (operands.size() > kMaxInPlace) {
            many_.resize(operands.size());
            all_ = many_;
        }
        all_ = all_.first(operands.size());
        std::copy(operands.begin(), operands.end(), all_.begin());
        for (size_t k = 0; k < step.outputs; ++k) {
            const uint32_t planes = run.planes_of(step, k);
            if (!planes) continue;  // a text
            all_[k].data = run.scratch(planes);
            // What the operation does not set is copied back, too, and must be what it was.
            if (rsl::keeps_output(step.op)) run.copy_planes(operands[k], planes, all_[k].data);
        }
    }
    Redirected(const Redirected&) = delete;
    Redirected& operator=(const Redirected&) = delete;

    std::span<const Operand> operands() const { return all_; }

  private:
    // More operands than this have only calls with many named arguments.
    static constexpr size_t kMaxInPlace = 32;
    Operand in_place_[kMaxInPlace];
    std::vector<Operand> many_;
    std::span<Operand> all_;
};

/// A text among the outputs has no planes: the operation has set it in place.
void Run::take_back(const Step& step, const Redirected& redirected) {
    const std::span<const Operand> outputs = registers_.operands_of(step);
    for (size_t k = 0; k < step.outputs; ++k)
        if (const uint32_t planes = planes_of(step, k))
            copy_running(step.masked && !masks_.all(), redirected.operands()[k].data, planes, outputs[k]);
}

/// Steps whose operands are all uniform run over one group of kLanes lanes, whatever the batch's size.
void Run::plain(const Step& step) {
    scratch_used_ = 0;
    const Way way = way_of(step);
    const size_t count = step.varying ? lanes() : kLanes;
    if (way == Way::InPlace) call(step, registers_.operands_of(step), count);
    if (way != Way::ThroughScratch) return;
    const Redirected redirected(*this, step, registers_.operands_of(step));
    call(step, redirected.operands(), count);
    take_back(step, redirected);
}

/// The same, with other shaders in between.
Task<> Run::waiting(const Step& step) {
    scratch_used_ = 0;
    const Way way = way_of(step);
    if (way == Way::InPlace) co_await step.waiting_op(*this, step, registers_.operands_of(step));
    if (way != Way::ThroughScratch) co_return;
    const Redirected redirected(*this, step, registers_.operands_of(step));
    co_await step.waiting_op(*this, step, redirected.operands());
    take_back(step, redirected);
}

/// Planes of a step's output; 0 of a text.
uint32_t Run::planes_of(const Step& step, size_t output) const {
    return registers_.executable().places()[registers_.register_of(step, output)].planes;
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
