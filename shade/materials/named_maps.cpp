#include "shade/materials/named_maps.h"

#include <bit>
#include <map>

#include "core/scene/scene.h"
#include "shade/code/optimise.h"
#include "shade/operations/op_table.h"

namespace trapeze {
namespace {

using rsl::Base;
using rsl::Instruction;
using rsl::Op;
using rsl::Register;
using rsl::RegisterId;

/// Rounds of following names, which are handed on from variable to variable and through functions: each round
/// follows one step.
constexpr int kMostRounds = 8;

/// A copy of a shader's code in which parameters are the constants that an instance gives them, folded as far
/// as that goes. Parameters that the code sets, arrays, and those in `varied` stay open.
class Specialised {
  public:
    Specialised(const BoundShader& shader, const std::set<std::string>& varied) : program_(shader.program()) {
        count_writes();
        for (size_t i = 0; i < program_.parameters.size(); ++i) {
            rsl::ProgramParameter& parameter = program_.parameters[i];
            parameter.initial.clear();
            Register& r = program_.registers[parameter.id];
            if (writes_[parameter.id] || parameter.type.is_array() || varied.contains(parameter.name))
                continue;
            r.kind = Register::Kind::Constant;
            r.values = shader.values()[i].floats;
            r.texts = shader.values()[i].texts;
        }
        rsl::optimise(program_);
        for (int round = 0; round < kMostRounds && follow_texts(); ++round) rsl::optimise(program_);
    }

    const rsl::Program& program() const { return program_; }

    std::vector<NamedMap> maps() const {
        std::vector<NamedMap> found;
        for (const Instruction& instruction : program_.code) {
            const bool is_depths = instruction.op == Op::Shadow;
            if (!is_depths && instruction.op != Op::Texture && instruction.op != Op::Environment &&
                instruction.op != Op::Bump)
                continue;
            const std::string* name = text_of(instruction.input(0));
            const bool traced =
                name && *name == rsl::kTracedMap && (is_depths || instruction.op == Op::Environment);
            if (name && !name->empty() && !traced) found.push_back({*name, is_depths, instruction.at});
        }
        return found;
    }

  private:
    /// Counts the instructions that set each register: a text is followed through registers that are set
    /// once.
    void count_writes() {
        writes_.clear();
        for (const Instruction& instruction : program_.code)
            for (size_t k = 0; k < instruction.outputs; ++k) ++writes_[instruction.output(k)];
    }

    /// The text that a register always holds; null when it is not known.
    const std::string* text_of(RegisterId id) const {
        const Register& r = program_.reg(id);
        const bool is_text =
            r.kind == Register::Kind::Constant && r.type.base == Base::String && r.texts.size() == 1;
        return is_text ? &r.texts[0] : nullptr;
    }

    /// Follows texts one step: the optimiser folds numbers. False when nothing more is known.
    bool follow_texts() {
        bool followed = false;
        count_writes();
        for (Instruction& instruction : program_.code) {
            std::vector<const std::string*> texts;
            for (size_t k = 0; k < instruction.input_count(); ++k)
                if (const std::string* text = text_of(instruction.input(k))) texts.push_back(text);
            if (texts.empty() || texts.size() != instruction.input_count()) continue;
            if (instruction.op == Op::Equal || instruction.op == Op::NotEqual) {
                const bool holds = (*texts[0] == *texts[1]) == (instruction.op == Op::Equal);
                set_constant(instruction, {holds ? std::bit_cast<float>(~0u) : 0.0f}, {});
                followed = true;
            } else if (instruction.op == Op::Concat || instruction.op == Op::Move) {
                const RegisterId out = instruction.output();
                const Register::Kind kind = program_.reg(out).kind;
                const bool is_private = kind == Register::Kind::Local || kind == Register::Kind::Temporary;
                if (!is_private || writes_[out] != 1 || program_.reg(out).type.is_array()) continue;
                std::string whole;
                for (const std::string* text : texts) whole += *text;
                Register& r = program_.registers[out];
                r.kind = Register::Kind::Constant;
                r.texts = {std::move(whole)};
                instruction.outputs = 0;  // marked as done
                followed = true;
            }
        }
        std::erase_if(program_.code, [](const Instruction& i) {
            return i.outputs == 0 && (i.op == Op::Concat || i.op == Op::Move);
        });
        return followed;
    }

    /// The instruction becomes the Move of a constant of its output's type.
    void set_constant(Instruction& instruction, std::vector<float> values, std::vector<std::string> texts) {
        Register r;
        r.kind = Register::Kind::Constant;
        r.type = program_.reg(instruction.output()).type;
        r.values = std::move(values);
        r.texts = std::move(texts);
        program_.registers.push_back(std::move(r));
        instruction.op = Op::Move;
        instruction.immediate = 0;
        instruction.operands = {instruction.output(), static_cast<RegisterId>(program_.registers.size() - 1)};
    }

    rsl::Program program_;
    std::map<RegisterId, int> writes_;
};

}  // namespace

std::set<std::string> variables_of(const Scene& scene) {
    std::set<std::string> names;
    for (const Primitive& primitive : scene.primitives)
        if (!primitive.shape_keys.empty())
            for (const Parameter& variable : primitive.shape().variables.values) names.insert(variable.name);
    return names;
}

std::vector<NamedMap> named_maps(const BoundShader& shader, const std::set<std::string>& varied) {
    // Most shaders ask for none, and are not made again to see that.
    const bool asks = std::ranges::any_of(shader.program().code, [](const rsl::Instruction& instruction) {
        return rsl::row_of(instruction.op).context == rsl::ContextFamily::Maps;
    });
    return asks ? Specialised(shader, varied).maps() : std::vector<NamedMap>();
}

rsl::Program specialised_program(const BoundShader& shader, const std::set<std::string>& varied) {
    return Specialised(shader, varied).program();
}

}  // namespace trapeze
