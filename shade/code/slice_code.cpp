#include "shade/code/slice_code.h"

#include <algorithm>

#include "shade/code/blocks.h"
#include "shade/operations/op_table.h"

namespace trapeze::rsl {
namespace {

/// Breaks, continues and returns.
bool is_jump(Op op) {
    return is_control(op) && !opens_block(op) && !divides_block(op) && !closes_block(op);
}

/// Marks instructions from those that are wanted back to what they read. Variables count as wanted or not, as
/// a whole: an instruction that sets a wanted one stays wherever it stands. So do the blocks around what
/// stays, with their conditions, and the jumps in these, which say for which lanes it runs.
class Slicer {
  public:
    Slicer(const Program& program, RegisterId wanted)
        : program_(program),
          blocks_(program.code),
          stays_(program.code.size()),
          read_(program.registers.size()) {
        read_[wanted] = true;
    }

    std::vector<bool> run() {
        for (bool changed = true; changed;) {
            changed = false;
            for (size_t i = program_.code.size(); i-- > 0;)
                if (!stays_[i] && is_wanted(i)) keep(i), changed = true;
        }
        return stays_;
    }
    bool reads(RegisterId id) const { return read_[id]; }

  private:
    bool is_wanted(size_t i) const {
        const Instruction& instruction = program_.code[i];
        if (op_traits::has(instruction.op, op_traits::kEffect)) return true;
        if (is_jump(instruction.op)) return is_within_what_stays(i);
        return std::any_of(instruction.operands.begin(), instruction.operands.begin() + instruction.outputs,
                           [this](RegisterId id) { return read_[id]; });
    }
    bool is_within_what_stays(size_t i) const {
        for (size_t at = blocks_.around[i]; at != Blocks::kNone; at = blocks_.around[at])
            if (stays_[at]) return true;
        return false;
    }

    /// With the blocks around it.
    void keep(size_t i) {
        keep_one(i);
        if (opens_block(program_.code[i].op)) keep_marks(i);
        for (size_t at = blocks_.around[i]; at != Blocks::kNone && !stays_[at]; at = blocks_.around[at]) {
            keep_one(at);
            keep_marks(at);
        }
    }
    void keep_marks(size_t opening) {
        keep_one(blocks_.end[opening]);
        if (blocks_.middle[opening] != Blocks::kNone) keep_one(blocks_.middle[opening]);
    }
    void keep_one(size_t i) {
        stays_[i] = true;
        const Instruction& instruction = program_.code[i];
        for (size_t k = 0; k < instruction.input_count(); ++k) read_[instruction.input(k)] = true;
        // Lights may ask for what the surface has by the name of its variables.
        const ContextFamily context = row_of(instruction.op).context;
        const bool runs_lights = context == ContextFamily::Lights || instruction.op == Op::Illuminance;
        if (!runs_lights && context != ContextFamily::Messages) return;
        for (size_t id = 0; id < read_.size(); ++id) {
            const Register::Kind kind = program_.registers[id].kind;
            if (kind == Register::Kind::Parameter || kind == Register::Kind::Global) read_[id] = true;
        }
    }

    const Program& program_;
    Blocks blocks_;
    std::vector<bool> stays_;  ///< of instructions
    std::vector<bool> read_;   ///< of registers: their values are wanted
};

}  // namespace

Program slice(const Program& program, std::string_view variable) {
    Program part = program;
    const RegisterId* const wanted = program.find_global(variable);
    if (!wanted) return part;
    Slicer slicer(program, *wanted);
    const std::vector<bool> stays = slicer.run();
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
