#include "shade/code/infer_storage.h"

#include "shade/code/blocks.h"
#include "shade/operations/op_table.h"

namespace trapeze::rsl {
namespace {

/// One piece of code. Repeats until nothing changes: what varies makes more vary. A register varies when
/// anything that it is computed from does, or when it is written where lanes have parted and read where they
/// are together again; a block parts lanes when its condition varies.
class Inference {
  public:
    Inference(Program& program, Code& code) : program_(program), code_(code), blocks_(code) {}

    /// Whether anything was found to vary that was not known to.
    bool pass() {
        changed_ = false;
        for (size_t i = 0; i < code_.size(); ++i) visit(i);
        return changed_;
    }

    /// Marks the instructions that must leave lanes alone which do not run. A temporary, and what is read
    /// only inside the region, may hold anything in such lanes; so most instructions run without a mask, at
    /// full speed.
    void set_masks() {
        for (size_t i = 0; i < code_.size(); ++i) {
            Instruction& instruction = code_[i];
            if (is_control(instruction.op)) continue;
            instruction.masked = false;
            for (size_t k = 0; k < instruction.outputs; ++k)
                if (outlives_region(instruction, instruction.operands[k]) && in_varying_block(i))
                    instruction.masked = true;
            if (op_traits::has(instruction.op, op_traits::kEffect) && in_varying_block(i))
                instruction.masked = true;
        }
    }

  private:
    /// Whether a register is read outside the region in which the instruction stands, as far as its kind
    /// tells.
    bool outlives_region(const Instruction& instruction, RegisterId id) const {
        const Register& r = program_.reg(id);
        return r.kind != Register::Kind::Temporary && r.region != instruction.region;
    }

    /// Whether some lanes may not be running at an instruction.
    bool in_varying_block(size_t i) const {
        for (size_t b = blocks_.around[i]; b != Blocks::kNone; b = blocks_.around[b])
            if (code_[b].varying) return true;
        return false;
    }

    /// Flags only ever go from false to true, so that passes come to an end.
    void set(bool& flag) {
        if (flag) return;
        flag = true;
        changed_ = true;
    }

    /// Lanes that leave separately make all loops (and scopes) that they leave vary.
    void leave(size_t i, bool scope, int levels) {
        bool separately = false;
        size_t last = blocks_.around[i];
        for (size_t b = last; b != Blocks::kNone; b = blocks_.around[b]) {
            last = b;
            separately = separately || code_[b].varying;
            if (scope ? code_[b].op == Op::Scope : opens_loop(code_[b].op) && --levels == 0) break;
        }
        if (!separately) return;
        for (size_t b = blocks_.around[i]; b != Blocks::kNone; b = blocks_.around[b]) {
            if (opens_loop(code_[b].op) || code_[b].op == Op::Scope) set(code_[b].varying);
            if (b == last) return;
        }
    }

    /// What one instruction says of its block, its outputs and itself.
    void visit(size_t i) {
        Instruction& instruction = code_[i];
        bool any = is_varying_by_itself(instruction.op);
        for (size_t k = 0; k < instruction.input_count(); ++k)
            any = any || program_.reg(instruction.input(k)).varying;
        switch (instruction.op) {
            case Op::If:
                if (any) set(instruction.varying);
                return;
            // The loop around it parts lanes: some leave it in this turn and others go on.
            case Op::LoopTest:
                if (any) set(code_[blocks_.around[i]].varying);
                return;
            case Op::Break:
            case Op::Continue:
                leave(i, false, instruction.immediate);
                return;
            case Op::Leave:
                leave(i, true, 0);
                return;
            case Op::Illuminance:
            case Op::Illuminate:
            case Op::Solar:
            case Op::Gather:
                set(instruction.varying);
                any = true;
                break;
            default:
                if (is_control(instruction.op)) return;
        }
        for (size_t k = 0; k < instruction.outputs; ++k) {
            Register& out = program_.registers[instruction.operands[k]];
            if (out.type.base == Base::String) continue;
            const bool apart = outlives_region(instruction, instruction.operands[k]) && in_varying_block(i);
            if (any || apart) set(out.varying);
            // An output that varies for another reason is set in all its lanes, though the inputs are
            // uniform.
            if (out.varying && !is_control(instruction.op)) instruction.varying = true;
        }
    }

    Program& program_;
    Code& code_;
    Blocks blocks_;
    bool changed_ = false;
};

}  // namespace

bool is_uniform_global(std::string_view name) {
    return name == "E" || name == "ncomps" || name == "time" || name == "dtime";
}

/// Begins with what is known: predefined variables vary but for a few, parameters as declared or as the scene
/// gives them. The code of defaults and of the body share registers, so all pieces are gone over until none
/// changes.
void infer_storage(Program& program, const std::set<std::string>& varying) {
    for (Register& r : program.registers)
        r.varying =
            r.kind == Register::Kind::Global && r.type.base != Base::String && !is_uniform_global(r.name);
    for (const ProgramParameter& parameter : program.parameters)
        program.registers[parameter.id].varying =
            parameter.type.base != Base::String &&
            (parameter.storage == Storage::Varying || varying.contains(parameter.name));

    std::vector<Inference> parts;
    for (ProgramParameter& parameter : program.parameters) parts.emplace_back(program, parameter.initial);
    parts.emplace_back(program, program.code);
    for (bool changed = true; changed;) {
        changed = false;
        for (Inference& part : parts) changed = part.pass() || changed;
    }
    for (Inference& part : parts) part.set_masks();
}

}  // namespace trapeze::rsl
