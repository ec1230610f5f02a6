#include "shade/vm/start_values.h"

#include <algorithm>
#include <string_view>
#include <utility>

#include "shade/operations/op_table.h"

namespace trapeze::vm {
namespace {

using rsl::Op;

/// Variables that the renderer has values for; others of globals.cpp start as 0.
constexpr std::pair<std::string_view, Predefined> kNames[] = {{"P", Predefined::P},
                                                              {"Ps", Predefined::Ps},
                                                              {"N", Predefined::N},
                                                              {"Ns", Predefined::Ns},
                                                              {"Ng", Predefined::Ng},
                                                              {"dPdu", Predefined::dPdu},
                                                              {"dPdv", Predefined::dPdv},
                                                              {"Cs", Predefined::Cs},
                                                              {"Os", Predefined::Os},
                                                              {"Ci", Predefined::Ci},
                                                              {"Oi", Predefined::Oi},
                                                              {"u", Predefined::u},
                                                              {"v", Predefined::v},
                                                              {"s", Predefined::s},
                                                              {"t", Predefined::t},
                                                              {"du", Predefined::du},
                                                              {"dv", Predefined::dv},
                                                              {"I", Predefined::I},
                                                              {"time", Predefined::time},
                                                              {"dtime", Predefined::dtime},
                                                              {"ncomps", Predefined::ncomps},
                                                              {"dPdtime", Predefined::dPdtime},
                                                              {rsl::kSurfaceU, Predefined::SurfaceU},
                                                              {rsl::kSurfaceV, Predefined::SurfaceV},
                                                              {rsl::kRayOrigin, Predefined::RayOrigin},
                                                              {rsl::kRayWay, Predefined::RayWay}};

Predefined predefined(std::string_view name) {
    const auto* row = std::ranges::find(kNames, name, &std::pair<std::string_view, Predefined>::first);
    return row != std::end(kNames) ? row->second : Predefined::Other;
}

/// Whether a register is among the inputs. Operands hold the outputs first, then the inputs.
bool reads(const rsl::Instruction& instruction, rsl::RegisterId id) {
    const auto inputs = instruction.operands.begin() + instruction.outputs;
    return std::find(inputs, instruction.operands.end(), id) != instruction.operands.end();
}

/// Parameters' defaults are computed before the program's code.
bool defaults_read(const rsl::Program& program, rsl::RegisterId id) {
    return std::ranges::any_of(program.parameters, [&](const rsl::ProgramParameter& parameter) {
        return std::ranges::any_of(parameter.initial, [&](const auto& i) { return reads(i, id); });
    });
}

/// Whether what comes first of the two is a look, or a write that may leave lanes as they are. A conservative
/// look along the code, without following jumps: the first instruction that names the register decides, and a
/// write counts only if it stands in no block, so that it certainly runs, and for all lanes.
bool is_needed(const rsl::Code& code, rsl::RegisterId id) {
    for (const rsl::Instruction& instruction : code) {
        const auto inputs = instruction.operands.begin() + instruction.outputs;
        if (reads(instruction, id)) return true;
        // Lanes that have left run nothing of what follows.
        if (instruction.op == Op::Leave) return true;
        if (std::find(instruction.operands.begin(), inputs, id) == inputs) continue;
        return instruction.region != 0 || instruction.masked || rsl::is_control(instruction.op) ||
               rsl::keeps_output(instruction.op);
    }
    return true;
}

}  // namespace

/// Globals that nothing reads are listed too, and marked: whoever sets up a run need not fill them.
std::vector<StartValue> start_values(const rsl::Program& program) {
    std::vector<StartValue> values;
    for (const rsl::RegisterId id : program.globals)
        values.push_back({id, predefined(program.reg(id).name),
                          is_needed(program.code, id) || defaults_read(program, id)});
    return values;
}

}  // namespace trapeze::vm
