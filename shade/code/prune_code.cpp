#include <map>

#include "shade/code/blocks.h"
#include "shade/code/optimise.h"
#include "shade/operations/op_table.h"

namespace trapeze::rsl {
namespace {

/// Counts how often each register is read, by the code and by the defaults of parameters, and takes out what
/// nobody reads until that leaves nothing more unread. Counts are kept up to date by erase(), so that no pass
/// has to walk over the code for them.
class Pruner {
  public:
    explicit Pruner(Program& program) : program_(program), reads_(program.registers.size(), 0) {}

    /// Each of the three removals may make work for the others. Defaults can only lose what is unread: blocks
    /// in them are left as they are.
    void run() {
        for (ProgramParameter& parameter : program_.parameters) count_reads(parameter.initial);
        count_reads(program_.code);
        for (bool changed = true; changed;) {
            changed = remove_unread(program_.code) || remove_overwritten(program_.code) ||
                      remove_empty_blocks(program_.code);
        }
        for (ProgramParameter& parameter : program_.parameters)
            while (remove_unread(parameter.initial)) {}
    }

  private:
    void count_reads(const Code& code) {
        for (const Instruction& instruction : code) count(instruction, 1);
    }

    /// A register that is read twice by one instruction counts twice.
    void count(const Instruction& instruction, int sign) {
        for (size_t k = 0; k < instruction.input_count(); ++k) reads_[instruction.input(k)] += sign;
    }

    /// Others may see a parameter or predefined variable after the run.
    bool is_private(RegisterId id) const {
        const Register::Kind kind = program_.reg(id).kind;
        return kind == Register::Kind::Temporary || kind == Register::Kind::Local;
    }

    /// Whether an instruction does nothing that anyone sees.
    bool is_unread(const Instruction& instruction) const {
        if (!is_pure(instruction.op) || instruction.outputs == 0) return false;
        for (size_t k = 0; k < instruction.outputs; ++k) {
            const RegisterId id = instruction.operands[k];
            if (!is_private(id) || reads_[id] > 0) return false;
        }
        return true;
    }

    /// Takes out the marked instructions, and what they read off the counts. Whether there were any.
    bool erase(Code& code, const std::vector<bool>& gone) {
        size_t kept = 0;
        for (size_t i = 0; i < code.size(); ++i) {
            if (gone[i]) {
                count(code[i], -1);
                continue;
            }
            if (kept != i) code[kept] = std::move(code[i]);
            ++kept;
        }
        const bool changed = kept != code.size();
        code.resize(kept);
        return changed;
    }

    /// Pure instructions whose outputs nobody reads.
    bool remove_unread(Code& code) {
        std::vector<bool> gone(code.size(), false);
        // Backwards, so that what fed an unread instruction goes in the same pass.
        for (size_t i = code.size(); i-- > 0;) {
            if (!is_unread(code[i])) continue;
            gone[i] = true;
            count(code[i], -1);
        }
        for (size_t i = 0; i < code.size(); ++i)
            if (gone[i]) count(code[i], 1);  // erase() takes it off again
        return erase(code, gone);
    }

    /// A variable set twice, with nothing in between that reads it or jumps.
    bool remove_overwritten(Code& code) {
        std::vector<bool> gone(code.size(), false);
        // For each local, the instruction that set it last, while nothing has read it since.
        std::map<RegisterId, size_t> pending;
        for (size_t i = 0; i < code.size(); ++i) {
            const Instruction& instruction = code[i];
            if (is_control(instruction.op)) {
                pending.clear();
                continue;
            }
            for (size_t k = 0; k < instruction.input_count(); ++k) pending.erase(instruction.input(k));
            for (size_t k = 0; k < instruction.outputs; ++k) {
                const RegisterId id = instruction.operands[k];
                // SetElement and its like leave part of the old value, and so read it.
                const bool whole =
                    !keeps_output(instruction.op) && program_.reg(id).kind == Register::Kind::Local;
                const auto before = pending.find(id);
                if (whole && before != pending.end()) gone[before->second] = true;
                pending.erase(id);
                if (whole && instruction.outputs == 1 && is_pure(instruction.op)) pending[id] = i;
            }
        }
        return erase(code, gone);
    }

    /// An Else without contents, and an If or Scope. Loops stay, though empty: one that never ends is to be
    /// reported.
    bool remove_empty_blocks(Code& code) {
        std::vector<bool> gone(code.size(), false);
        for (size_t i = 0; i + 1 < code.size(); ++i) {
            if (code[i].op == Op::Else && code[i + 1].op == Op::EndIf) gone[i] = true;
            // Blocks that only switch lanes: with nothing inside they have nothing to switch them for.
            const bool plain = code[i].op == Op::If || code[i].op == Op::Scope;
            if (plain && closes_block(code[i + 1].op)) gone[i] = gone[i + 1] = true;
        }
        return erase(code, gone);
    }

    Program& program_;
    std::vector<int> reads_;
};

}  // namespace

void prune_code(Program& program) {
    Pruner(program).run();
}

}  // namespace trapeze::rsl
