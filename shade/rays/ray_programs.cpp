#include "shade/rays/ray_programs.h"

#include <algorithm>

#include "shade/operations/op_table.h"

namespace trapeze {
namespace {

using rsl::Op;

bool asks(const rsl::Code& code) {
    return std::ranges::any_of(code, [](const rsl::Instruction& i) {
        return rsl::row_of(i.op).context == rsl::ContextFamily::Rays && i.op != Op::RayInfo &&
               i.op != Op::RayLevel;
    });
}

}  // namespace

bool asks_for_rays(const rsl::Program& program) {
    return asks(program.code) || std::ranges::any_of(program.parameters, [](const rsl::ProgramParameter& p) {
               return asks(p.initial);
           });
}

bool changes_opacity(const rsl::Program& program) {
    const rsl::RegisterId* const Oi = program.find_global("Oi");
    if (!Oi) return false;
    const rsl::RegisterId* const Os = program.find_global("Os");
    return std::ranges::any_of(program.code, [&](const rsl::Instruction& i) {
        for (size_t k = 0; k < i.outputs; ++k)
            if (i.operands[k] == *Oi) return !(Os && i.op == Op::Move && i.operands[i.outputs] == *Os);
        return false;
    });
}

}  // namespace trapeze
