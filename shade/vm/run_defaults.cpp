#include "shade/vm/run_defaults.h"

#include <algorithm>

#include "shade/operations/op_table.h"

namespace trapeze::vm {
namespace {

using rsl::Op;
using rsl::Register;

}  // namespace

/// Parameters are looked at in their order, since a default may name parameters before it and no others.
/// Others are computed once for a material, when it is bound.
std::vector<bool> has_run_default(const rsl::Program& program) {
    std::vector<bool> found;
    std::vector<bool> known_late(program.registers.size(), false);
    for (const rsl::ProgramParameter& parameter : program.parameters) {
        bool late = may_ask_object_space(program, parameter.initial);
        for (const rsl::Instruction& instruction : parameter.initial) {
            late = late || rsl::asks_surroundings(instruction.op);
            for (size_t k = 0; k < instruction.input_count() && !late; ++k) {
                const rsl::RegisterId id = instruction.input(k);
                late = known_late[id] || program.reg(id).kind == Register::Kind::Global;
            }
        }
        known_late[parameter.id] = late;
        found.push_back(late);
    }
    return found;
}

/// "object" is the one space of which each primitive has its own though they share a material; all others are
/// known when parameters are set.
bool may_ask_object_space(const rsl::Program& program, const rsl::Code& code) {
    return std::ranges::any_of(code, [&](const rsl::Instruction& instruction) {
        if (instruction.op != Op::SpaceMatrix) return false;
        for (size_t i = 0; i < instruction.input_count(); ++i) {
            const Register& name = program.reg(instruction.input(i));
            // A name that is computed, or a parameter, may be any.
            if (name.kind != Register::Kind::Constant || name.texts.empty() || name.texts[0] == "object")
                return true;
        }
        return false;
    });
}

}  // namespace trapeze::vm
