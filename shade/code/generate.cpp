#include "shade/code/generate.h"

#include <fmt/format.h>

#include "shade/code/generator.h"

namespace trapeze::rsl {

std::unique_ptr<Program> generate(const Shader& shader, Diagnostics& diagnostics) {
    return Generator(shader, diagnostics).run();
}

/// Parameters come first, with a piece of code each for its default; then the body. An error on the way has
/// been reported, and there is no program.
std::unique_ptr<Program> Generator::run() {
    program_ = std::make_unique<Program>();
    program_->kind = shader_.kind;
    program_->name = shader_.name;
    program_->displaces = shader_.displaces;
    at_ = shader_.at;
    try {
        for (const auto& variable : shader_.globals) register_of(*variable);
        add_parameters();
        code_ = &program_->code;
        copy_written_globals();
        // A return from the middle of a shader leaves a scope around all of it.
        const bool returns = contains_early_return(*shader_.body);
        if (returns) open(Op::Scope, {}, {});
        body_.in_scope = returns;
        statement(*shader_.body);
        if (returns) close(Op::EndScope);
    } catch (const TooLarge&) {
        return nullptr;
    }
    return std::move(program_);
}

/// Predefined variables that the renderer does not want changed: what follows works on copies. Once at the
/// body's beginning: from there on the name means the copy, in functions that are inlined as well.
void Generator::copy_written_globals() {
    for (const auto& variable : shader_.globals) {
        if (!variable->copied) continue;
        const RegisterId copy = add_register(Register::Kind::Local, variable->type, variable->name);
        emit(Op::Move, {copy}, {register_of(*variable)});
        by_name_[variable->name] = copy;
    }
}

/// Defaults may name earlier parameters and call functions. Their code is kept apart from the body's, one
/// piece for each parameter, since a value of the scene's takes its place (Machine::run_initial()).
void Generator::add_parameters() {
    for (const auto& variable : shader_.parameters) {
        ProgramParameter& parameter = program_->parameters.emplace_back();
        parameter.name = variable->name;
        parameter.type = variable->type;
        parameter.storage = variable->storage == Storage::Varying ? Storage::Varying : Storage::Uniform;
        parameter.output = variable->output;
        parameter.at = variable->at;
        parameter.id = add_register(Register::Kind::Parameter, variable->type, variable->name);
        by_name_[variable->name] = parameter.id;
        Code initial;
        code_ = &initial;
        if (variable->initial) initialise(parameter.id, *variable);
        program_->parameters.back().initial = std::move(initial);
    }
}

/// A register belongs to the region that it is made in, but those of parameters and predefined variables
/// outlive all.
RegisterId Generator::add_register(Register::Kind kind, Type type, std::string name) {
    Register r;
    r.kind = kind;
    r.type = type;
    r.name = std::move(name);
    r.region = kind == Register::Kind::Global || kind == Register::Kind::Parameter ? 0 : region_;
    program_->registers.push_back(std::move(r));
    const auto id = static_cast<RegisterId>(program_->registers.size() - 1);
    if (type.is_unsized()) add_counts(id);
    return id;
}

/// One register for each number; NaN, which equals nothing, gets a new one each time. -0 and 0 are equal, and
// share the register of the one that came first. A NaN as a key would break the map's order.
RegisterId Generator::constant(float value) {
    if (value == value) {
        if (const auto known = numbers_.find(value); known != numbers_.end()) return known->second;
    }
    const RegisterId id = add_register(Register::Kind::Constant, {Base::Float, 0});
    program_->registers[id].values = {value};
    if (value == value) numbers_[value] = id;
    return id;
}

/// Shared by all that name the same text. Constants are never written to, so sharing is safe.
RegisterId Generator::constant_text(const std::string& text) {
    const auto [known, is_new] = texts_.try_emplace(text, 0);
    if (is_new) {
        known->second = add_register(Register::Kind::Constant, {Base::String, 0});
        program_->registers[known->second].texts = {text};
    }
    return known->second;
}

/// A predefined variable, whether the source names it or an operation needs it unnamed. `globals` of the
/// program is the list of what the machine has to fill before a run.
RegisterId Generator::global(std::string_view name, Base base) {
    if (const auto known = by_name_.find(name); known != by_name_.end()) return known->second;
    const RegisterId id = add_register(Register::Kind::Global, {base, 0}, std::string(name));
    program_->globals.push_back(id);
    by_name_[std::string(name)] = id;
    return id;
}

/// Locals get their register when they are first met; a function that is inlined again has new ones. Keyed by
/// the variable of the tree: names may come again in other scopes.
RegisterId Generator::register_of(const Variable& variable) {
    switch (variable.kind) {
        case Variable::Kind::Global:
            return global(variable.name, variable.type.base);
        case Variable::Kind::Parameter:
            return by_name_.at(variable.name);
        default: {
            const auto [known, is_new] = locals_.try_emplace(&variable, 0);
            if (is_new) known->second = add_register(Register::Kind::Local, variable.type, variable.name);
            return known->second;
        }
    }
}

/// Appends an instruction to the code that is being made. The bound keeps functions that call functions from
/// filling the memory.
Instruction& Generator::emit(Op op, Ids outputs, const Ids& inputs, int32_t immediate) {
    if (++instruction_count_ > kMaxInstructions) {
        diagnostics_.error(
            at_, fmt::format("shader \"{}\" is too large: its functions, written out where they are "
                             "called, make more than {} instructions",
                             shader_.name, kMaxInstructions));
        throw TooLarge{};
    }
    Instruction& instruction = code_->emplace_back();
    instruction.op = op;
    instruction.outputs = static_cast<uint8_t>(outputs.size());
    instruction.immediate = immediate;
    instruction.region = region_;
    instruction.at = at_;
    instruction.operands = std::move(outputs);
    instruction.operands.insert(instruction.operands.end(), inputs.begin(), inputs.end());
    return instruction;
}

/// One instruction with one output, which is of type `base` when it is a temporary.
RegisterId Generator::compute(Op op, Base base, const Ids& inputs, std::optional<RegisterId> into) {
    const RegisterId out = into ? *into : temporary(base);
    emit(op, {out}, inputs);
    return out;
}

/// Begins a block: what follows is a region of its own, so that storage inference knows which values outlive
/// the lanes that it switches off.
void Generator::open(Op op, Ids outputs, const Ids& inputs) {
    emit(op, std::move(outputs), inputs);
    open_regions_.push_back(region_);
    region_ = ++last_region_;
}

/// The other half is a region of its own, outside of which lanes that it switches off go on. The else is a
/// region of its own: what the first half has computed need not have been, for lanes that come here.
void Generator::turn_to_else(RegisterId decision) {
    region_ = open_regions_.back();
    emit(Op::Else, {}, {decision});
    region_ = ++last_region_;
}

/// Ends the innermost block; code goes on in the region around it.
void Generator::close(Op op) {
    region_ = open_regions_.back();
    open_regions_.pop_back();
    emit(op, {}, {});
}

}  // namespace trapeze::rsl
