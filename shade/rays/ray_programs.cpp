#include "shade/rays/ray_programs.h"

#include <algorithm>

#include "shade/materials/named_maps.h"
#include "shade/operations/op_table.h"

namespace trapeze {
namespace {

using rsl::Op;

/// Whether an instruction is a gather that asks a map for sure.
bool gathers_of_map(const rsl::Program& program, const rsl::Instruction& i) {
    if (i.op != Op::Gather) return false;
    const rsl::Register& category = program.reg(i.input(0));
    return category.kind == rsl::Register::Kind::Constant && !category.texts.empty() &&
           category.texts.front().starts_with(rsl::kOfEnvironment);
}

/// indirectdiffuse(map, R), which sends none.
bool looks_at_map(const rsl::Program& program, const rsl::Instruction& i) {
    return i.op == Op::IndirectDiffuse && program.reg(i.input(0)).type.base == rsl::Base::String;
}

bool calls(const rsl::Program& program, const rsl::Code& code, bool maps_are_traced) {
    return std::ranges::any_of(code, [&](const rsl::Instruction& i) {
        return (rsl::sends_rays(i.op) && !gathers_of_map(program, i)) ||
               ((i.op == Op::Shadow || i.op == Op::Environment) && maps_are_traced);
    });
}

bool holds(const std::vector<std::string>& texts) {
    return std::ranges::find(texts, rsl::kTracedMap) != texts.end();
}

/// Whether maps may be traced. A text may reach a call by way of variables: that the code knows it at all is
/// taken for asking.
bool traces_maps(const rsl::Program& program, const BoundShader& shader) {
    const auto knows = [&](rsl::RegisterId id) { return holds(program.reg(id).texts); };
    bool traced = std::ranges::any_of(
        program.code, [&](const rsl::Instruction& i) { return std::ranges::any_of(i.operands, knows); });
    for (size_t i = 0; i < program.parameters.size(); ++i) {
        const bool is_open = program.reg(program.parameters[i].id).kind == rsl::Register::Kind::Parameter;
        traced = traced || (is_open && holds(shader.values()[i].texts));
    }
    return traced;
}

/// Whether the code may trace.
bool asks(const rsl::Program& program, const BoundShader& shader, bool given_traced_map) {
    const bool traced = given_traced_map || traces_maps(program, shader);
    const auto asks_in_default = [&](const rsl::ProgramParameter& p) {
        return calls(shader.program(), p.initial, traced);
    };
    return calls(program, program.code, traced) ||
           std::ranges::any_of(shader.program().parameters, asks_in_default);
}

/// Whether an instruction is occlusion() or indirectdiffuse() with a "filename", and "pointbased" that is not
/// known to be 0.
bool is_of_cloud(const rsl::Program& program, const rsl::Instruction& i) {
    if (i.op != Op::Occlusion && i.op != Op::IndirectDiffuse) return false;
    const auto value_of = [&](const char* name) -> const rsl::Register* {
        for (size_t k = i.outputs; k + 1 < i.operands.size(); ++k)
            if (program.reg(i.operands[k]).texts == std::vector<std::string>{name})
                return &program.reg(i.operands[k + 1]);
        return nullptr;
    };
    const rsl::Register* const asked = value_of("pointbased");
    return asked && value_of("filename") &&
           (asked->kind != rsl::Register::Kind::Constant || asked->values != std::vector<float>{0});
}

/// Whether a program sets Oi to anything but Os or what `allowed` says of a register.
template <class Allowed>
bool sets_opacity(const rsl::Program& program, const Allowed& allowed) {
    const rsl::RegisterId* const Oi = program.find_global("Oi");
    if (!Oi) return false;
    const rsl::RegisterId* const Os = program.find_global("Os");
    return std::ranges::any_of(program.code, [&](const rsl::Instruction& i) {
        for (size_t k = 0; k < i.outputs; ++k) {
            if (i.operands[k] != *Oi) continue;
            const rsl::RegisterId from = i.operands[i.outputs];
            return !(i.op == Op::Move && ((Os && from == *Os) || allowed(from)));
        }
        return false;
    });
}

/// Whether an operation may tell what rays have found.
bool tells_of_rays(Op op) {
    using rsl::ContextFamily;
    const ContextFamily context = rsl::row_of(op).context;
    return rsl::sends_rays(op) || context == ContextFamily::Lights || context == ContextFamily::Messages ||
           op == Op::Environment || op == Op::Shadow;
}

/// The registers of a program that may follow from what rays have told.
class ToldRegisters {
  public:
    explicit ToldRegisters(const rsl::Program& program) : told_(program.registers.size()) {
        for (const char* name : {"Cl", "Ol", "Ci"})
            if (const rsl::RegisterId* const id = program.find_global(name)) told_[*id] = true;
    }
    bool told(rsl::RegisterId id) const { return told_[id]; }
    bool any_input(const rsl::Instruction& i) const {
        return std::any_of(i.operands.begin() + i.outputs, i.operands.end(),
                           [this](rsl::RegisterId id) { return told_[id]; });
    }
    /// False when nothing is new.
    bool follow(const rsl::Code& code) {
        bool is_new = false;
        for (const rsl::Instruction& i : code)
            for (size_t k = 0; (tells_of_rays(i.op) || any_input(i)) && k < i.outputs; ++k) {
                is_new = is_new || !told_[i.operands[k]];
                told_[i.operands[k]] = true;
            }
        return is_new;
    }

  private:
    std::vector<bool> told_;
};

}  // namespace

bool keeps_answers_apart(const rsl::Program& program) {
    std::vector<const rsl::Code*> codes{&program.code};
    for (const rsl::ProgramParameter& parameter : program.parameters) codes.push_back(&parameter.initial);
    ToldRegisters registers(program);
    for (bool is_new = true; is_new;) {
        is_new = false;
        for (const rsl::Code* code : codes) is_new = registers.follow(*code) || is_new;
    }
    const auto spreads = [&](const rsl::Instruction& i) {
        return i.op == Op::Gather ||
               ((rsl::is_control(i.op) || rsl::reads_neighbours(i.op)) && registers.any_input(i));
    };
    const rsl::RegisterId* const Oi = program.find_global("Oi");
    return !(Oi && registers.told(*Oi)) && std::ranges::none_of(codes, [&](const rsl::Code* code) {
        return std::ranges::any_of(*code, spreads);
    });
}

bool asks_for_rays(const BoundShader& shader, const std::set<std::string>* varied, bool given_traced_map) {
    if (!asks(shader.program(), shader, given_traced_map)) return false;
    return !varied || asks(specialised_program(shader, *varied), shader, given_traced_map);
}

bool knows_traced_map(const BoundShader& shader) {
    return traces_maps(shader.program(), shader);
}

bool asks_clouds_alone(const BoundShader& shader) {
    const rsl::Program& program = shader.program();
    return !traces_maps(program, shader) && std::ranges::all_of(program.code, [&](const rsl::Instruction& i) {
        return !rsl::sends_rays(i.op) || gathers_of_map(program, i) || looks_at_map(program, i) ||
               is_of_cloud(program, i);
    });
}

bool leaves_traces(const rsl::Program& program) {
    return std::ranges::any_of(program.code, [](const rsl::Instruction& i) {
        return rsl::op_traits::has(i.op, rsl::op_traits::kEffect);
    });
}

bool changes_opacity(const rsl::Program& program) {
    return sets_opacity(program, [](rsl::RegisterId) { return false; });
}

bool keeps_opaque(const rsl::Program& program) {
    return !sets_opacity(program, [&](rsl::RegisterId from) {
        const rsl::Register& r = program.reg(from);
        return r.kind == rsl::Register::Kind::Constant && !r.values.empty() &&
               std::ranges::all_of(r.values, [](float value) { return value == 1; });
    });
}

}  // namespace trapeze
