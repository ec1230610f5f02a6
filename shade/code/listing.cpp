#include <fmt/format.h>

#include "shade/code/program.h"
#include "shade/operations/op_table.h"

namespace trapeze::rsl {
namespace {

/// As the source spells them; the generator is independent of the printer of trees.
std::string_view base_name(Base base) {
    switch (base) {
        case Base::Void:
            return "void";
        case Base::Bool:
            return "bool";
        case Base::Float:
            return "float";
        case Base::Color:
            return "color";
        case Base::Point:
            return "point";
        case Base::Vector:
            return "vector";
        case Base::Normal:
            return "normal";
        case Base::Matrix:
            return "matrix";
        case Base::String:
            return "string";
    }
    return "?";
}

/// A constant's value, a variable's name, or %number for a temporary. Variables of one name in different
/// scopes look alike; the listing is for people.
std::string register_text(const Program& program, RegisterId id) {
    const Register& r = program.reg(id);
    if (r.kind != Register::Kind::Constant)
        return r.name.empty() ? fmt::format("%{}", id) : fmt::format("{}", r.name);
    if (r.type.base == Base::String) return r.texts.empty() ? "\"\"" : fmt::format("\"{}\"", r.texts.front());
    if (r.type.base == Base::Bool) return r.values.front() == 0 ? "false" : "true";
    if (r.values.size() == 1) return fmt::format("{}", r.values.front());
    return fmt::format("({})", fmt::join(r.values, ", "));
}

/// Lines that stand as far out as the block's opening.
bool stands_out(Op op) {
    return divides_block(op) || op == Op::LoopTest;
}

/// "uniform float x = Add a, b", indented by the blocks around; "=?" where lanes that do not run keep what
/// they have, "(by lane)" where a block parts lanes.
void list_code(const Program& program, const Code& code, int indent, std::string& out) {
    for (const Instruction& instruction : code) {
        if (closes_block(instruction.op)) --indent;
        // Ends and middles of blocks stand as far out as the openings.
        const int here = stands_out(instruction.op) ? indent - 1 : indent;
        out.append(static_cast<size_t>(std::max(here, 0)) * 4, ' ');
        for (size_t k = 0; k < instruction.outputs; ++k) {
            const RegisterId id = instruction.operands[k];
            const Register& r = program.reg(id);
            out += fmt::format("{}{} {} {}", k ? ", " : "", r.varying ? "varying" : "uniform",
                               base_name(r.type.base), register_text(program, id));
        }
        if (instruction.outputs) out += instruction.masked ? " =? " : " = ";
        out += row_of(instruction.op).name;
        if (opens_block(instruction.op) && instruction.varying) out += " (by lane)";
        for (size_t k = 0; k < instruction.input_count(); ++k)
            out += (k ? ", " : " ") + register_text(program, instruction.input(k));
        if (instruction.op == Op::Break || instruction.op == Op::Continue)
            out += fmt::format(" {}", instruction.immediate);
        if (instruction.at.line) out += fmt::format("    # line {}", instruction.at.line);
        out += '\n';
        if (opens_block(instruction.op)) ++indent;
    }
}

}  // namespace

/// The shader's kind and name, the code of each parameter's default, and the body: for people, on the command
/// line; nothing reads it back.
std::string listing(const Program& program) {
    static constexpr std::string_view kKinds[] = {"surface", "displacement", "light", "volume", "imager"};
    std::string out = fmt::format("{} {}\n", kKinds[static_cast<size_t>(program.kind)], program.name);
    for (const ProgramParameter& parameter : program.parameters) {
        out += fmt::format("parameter {}\n", parameter.name);
        list_code(program, parameter.initial, 1, out);
    }
    out += "code    # =?: only where lanes run\n";
    list_code(program, program.code, 1, out);
    return out;
}

}  // namespace trapeze::rsl
