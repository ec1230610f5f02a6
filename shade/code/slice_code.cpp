#include "shade/code/slice_code.h"

#include <algorithm>
#include <utility>
#include <vector>

#include "shade/code/blocks.h"
#include "shade/operations/op_table.h"

namespace trapeze::rsl {
namespace {

/// Breaks, continues and returns.
bool is_jump(Op op) {
    return is_control(op) && !opens_block(op) && !divides_block(op) && !closes_block(op);
}

/// Marks instructions from those that are wanted back to what they read, each once: sources of strangers may
/// be long. Variables count as wanted or not, as a whole: an instruction that sets a wanted one stays
/// wherever it stands. So do the blocks around what stays, with their conditions, and the jumps in the
/// outermost of these, which say for which lanes it runs.
class Slicer {
  public:
    explicit Slicer(const Program& program)
        : program_(program),
          blocks_(program.code),
          stays_(program.code.size()),
          read_(program.registers.size()),
          writers_(program.registers.size()),
          jumps_(program.code.size()) {
        std::vector<size_t> outermost(program.code.size(), Blocks::kNone);
        for (size_t i = 0; i < program.code.size(); ++i) {
            const Instruction& instruction = program.code[i];
            for (size_t k = 0; k < instruction.outputs; ++k) writers_[instruction.operands[k]].push_back(i);
            if (op_traits::has(instruction.op, op_traits::kEffect)) waiting_.push_back(i);
            // Openings come before what is in them.
            const size_t around = blocks_.around[i];
            if (around == Blocks::kNone) continue;
            outermost[i] = outermost[around] == Blocks::kNone ? around : outermost[around];
            if (is_jump(instruction.op)) jumps_[outermost[i]].push_back(i);
        }
    }

    /// Which instructions stay that a register may have its value.
    const std::vector<bool>& run(RegisterId wanted) {
        want(wanted);
        while (!waiting_.empty()) {
            const size_t i = waiting_.back();
            waiting_.pop_back();
            keep(i);
            for (size_t at = blocks_.around[i]; at != Blocks::kNone && !stays_[at]; at = blocks_.around[at])
                keep(at);
        }
        return stays_;
    }

  private:
    /// All that sets it is to stay.
    void want(RegisterId id) {
        if (read_[id]) return;
        read_[id] = true;
        waiting_.insert(waiting_.end(), writers_[id].begin(), writers_[id].end());
    }
    /// An opening with the rest of its block's frame.
    void keep(size_t i) {
        keep_one(i);
        if (!opens_block(program_.code[i].op)) return;
        keep_one(blocks_.end[i]);
        if (blocks_.middle[i] != Blocks::kNone) keep_one(blocks_.middle[i]);
        waiting_.insert(waiting_.end(), jumps_[i].begin(), jumps_[i].end());
        jumps_[i].clear();
    }
    void keep_one(size_t i) {
        if (stays_[i]) return;
        stays_[i] = true;
        const Instruction& instruction = program_.code[i];
        for (size_t k = 0; k < instruction.input_count(); ++k) want(instruction.input(k));
        const ContextFamily context = row_of(instruction.op).context;
        const bool runs_lights = context == ContextFamily::Lights || instruction.op == Op::Illuminance;
        // What displaces has run before, and what is set in the scene asks nothing back.
        const bool asks_back = context == ContextFamily::Messages &&
                               instruction.op != Op::DisplacementMessage &&
                               instruction.op != Op::AttributeMessage &&
                               instruction.op != Op::OptionMessage && instruction.op != Op::RendererInfo;
        if (runs_lights || asks_back) want_what_others_may_ask();
    }
    /// Lights may ask for what the surface has by the names of its variables.
    void want_what_others_may_ask() {
        if (std::exchange(others_ask_, true)) return;
        for (RegisterId id = 0; id < program_.registers.size(); ++id) {
            const Register::Kind kind = program_.reg(id).kind;
            if (kind == Register::Kind::Parameter || kind == Register::Kind::Global) want(id);
        }
    }

    const Program& program_;
    Blocks blocks_;
    std::vector<bool> stays_;                   ///< of instructions
    std::vector<bool> read_;                    ///< of registers: their values are wanted
    std::vector<std::vector<size_t>> writers_;  ///< of registers
    std::vector<std::vector<size_t>> jumps_;    ///< of outermost openings: those in it that do not stay yet
    std::vector<size_t> waiting_;
    bool others_ask_ = false;
};

}  // namespace

Program slice(const Program& program, std::string_view variable) {
    Program part = program;
    const RegisterId* const wanted = program.find_global(variable);
    if (!wanted) return part;
    Slicer slicer(program);
    const std::vector<bool>& stays = slicer.run(*wanted);
    part.code.clear();
    std::vector<bool> named(program.registers.size());
    const auto name = [&](const Instruction& instruction) {
        for (const RegisterId id : instruction.operands) named[id] = true;
    };
    for (const ProgramParameter& parameter : program.parameters)
        std::ranges::for_each(parameter.initial, name);
    for (size_t i = 0; i < stays.size(); ++i) {
        if (!stays[i]) continue;
        part.code.push_back(program.code[i]);
        name(program.code[i]);
    }
    std::erase_if(part.globals, [&](RegisterId id) { return !named[id]; });
    return part;
}

}  // namespace trapeze::rsl
