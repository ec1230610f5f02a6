#include "shade/rays/ray_programs.h"

#include <algorithm>

#include "shade/operations/op_table.h"

namespace trapeze {
namespace {

using rsl::Op;

bool calls(const rsl::Code& code, bool maps_are_traced) {
    return std::ranges::any_of(code, [&](const rsl::Instruction& i) {
        return rsl::sends_rays(i.op) || (i.op == Op::Shadow && maps_are_traced);
    });
}

bool holds(const std::vector<std::string>& texts) {
    return std::ranges::find(texts, rsl::kTracedMap) != texts.end();
}

}  // namespace

bool asks_for_rays(const BoundShader& shader) {
    const rsl::Program& program = shader.program();
    // A text may reach a call by way of variables: that it is there at all is taken for asking.
    const bool traced =
        std::ranges::any_of(program.registers, [](const rsl::Register& r) { return holds(r.texts); }) ||
        std::ranges::any_of(shader.values(), [](const BoundShader::Value& v) { return holds(v.texts); });
    return calls(program.code, traced) ||
           std::ranges::any_of(program.parameters,
                               [&](const rsl::ProgramParameter& p) { return calls(p.initial, traced); });
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
