#include <fmt/format.h>

#include <algorithm>

#include "shade/code/blocks.h"
#include "shade/code/generator.h"

namespace trapeze::rsl {
namespace {

/// Whether a return stands anywhere in a statement.
bool contains_return(const Statement& s) {
    if (s.kind == Statement::Kind::Return) return true;
    for (const StatementPtr& child : s.children)
        if (contains_return(*child)) return true;
    return false;
}

/// Whether an expression may change a variable, by assignment or as the argument of a call. May say yes too
/// often, never no wrongly.
bool assigned_in(const Expression& e, const Variable& variable) {
    const auto names = [&](const Expression& target) {
        return target.kind == Expression::Kind::Variable && target.variable == &variable;
    };
    if (e.kind == Expression::Kind::Assignment && names(*e.children[0])) return true;
    if (e.kind == Expression::Kind::Assignment && e.children[0]->kind == Expression::Kind::Element &&
        names(*e.children[0]->children[0]))
        return true;
    // A function of the shader's own may set what is passed to it: a copy too many does no harm.
    if (e.kind == Expression::Kind::Call && (!e.builtin || sets_arguments(*e.builtin)))
        for (const ExpressionPtr& child : e.children)
            if (names(*child)) return true;
    for (const ExpressionPtr& child : e.children)
        if (assigned_in(*child, variable)) return true;
    return false;
}

}  // namespace

/// A return that is the last statement, also within a last block, is not early: control ends there anyway.
/// Bodies without one need no scope in the machine, which keeps a mask for each.
bool contains_early_return(const Statement& body) {
    if (body.kind != Statement::Kind::Block)
        return contains_return(body) && body.kind != Statement::Kind::Return;
    for (size_t i = 0; i < body.children.size(); ++i) {
        const Statement& child = *body.children[i];
        const bool last = i + 1 == body.children.size();
        if (last && child.kind == Statement::Kind::Block) return contains_early_return(child);
        if (contains_return(child) && !(last && child.kind == Statement::Kind::Return)) return true;
    }
    return false;
}

/// Looks into last blocks only: an if whose halves both return does not count.
bool ends_with_return(const Statement& body) {
    if (body.kind == Statement::Kind::Return) return true;
    return body.kind == Statement::Kind::Block && !body.children.empty() &&
           ends_with_return(*body.children.back());
}

/// A walk over the whole body for each parameter of each call; bodies are small, and a needless copy would
/// cost at every vertex.
bool assigns(const Statement& s, const Variable& variable) {
    for (const ExpressionPtr& e : s.expressions)
        if (e && assigned_in(*e, variable)) return true;
    for (const auto& declared : s.variables)
        if (declared->initial && assigned_in(*declared->initial, variable)) return true;
    for (const StatementPtr& child : s.children)
        if (assigns(*child, variable)) return true;
    return false;
}

/// Appends the code of one statement. Of an Empty that stands for a nested function nothing is left. The
/// place goes into each instruction that follows, for messages of the run.
void Generator::statement(const Statement& s) {
    if (s.at.line) at_ = s.at;
    switch (s.kind) {
        case Statement::Kind::Block:
            for (const StatementPtr& child : s.children) {
                // Before the statement that declares them, so that they are 0 where it is not run.
                if (!s.open) declare_outliving(*child);
                statement(*child);
            }
            break;
        case Statement::Kind::Declare:
            declare(s);
            break;
        case Statement::Kind::Evaluate:
            value(*s.expressions[0]);
            break;
        case Statement::Kind::If:
            if_statement(s);
            break;
        case Statement::Kind::While:
        case Statement::Kind::For:
            loop_statement(s);
            break;
        case Statement::Kind::Illuminance:
        case Statement::Kind::Illuminate:
        case Statement::Kind::Solar:
            light_block(s);
            break;
        case Statement::Kind::Gather:
            gather_statement(s);
            break;
        case Statement::Kind::Break:
            emit(Op::Break, {}, {}, s.levels);
            break;
        case Statement::Kind::Continue:
            emit(Op::Continue, {}, {}, s.levels);
            break;
        case Statement::Kind::Return:
            return_statement(s);
            break;
        case Statement::Kind::Empty:
            break;
    }
}

/// A variable without an initial value starts as 0 wherever it is declared, so that a run never sees what
/// another left behind; the optimiser drops the zero where it is overwritten.
void Generator::declare(const Statement& s) {
    for (const auto& variable : s.variables) {
        if (!variable->outlives) locals_.erase(variable.get());
        const RegisterId id = register_of(*variable);
        if (!variable->initial)
            clear(id);
        else
            initialise(id, *variable);
    }
}

/// Variables of a block that statements without braces declare somewhere within this one of its statements.
/// They are cleared in the block that they live in, since a branch that declares them may not be run in all
/// lanes.
void Generator::declare_outliving(const Statement& s) {
    for (const auto& variable : s.variables) {
        if (!variable->outlives) continue;
        locals_.erase(variable.get());
        clear(register_of(*variable));
    }
    if (s.kind == Statement::Kind::Block && !s.open) return;
    for (const StatementPtr& child : s.children) declare_outliving(*child);
}

/// Zeros, empty texts, or zeros in all elements: variables without a value of their own are the same in each
/// run.
void Generator::clear(RegisterId id) {
    const Type type = program_->reg(id).type;
    if (type.is_unsized())
        for (const RegisterId number : {program_->reg(id).count, program_->reg(id).reserved})
            emit(Op::Move, {number}, {constant(0)});
    else if (type.is_array())
        emit(Op::Clear, {id}, {});
    else if (type.base == Base::String)
        moved(constant_text(""), Base::String, id);
    else
        emit(Op::Move, {id}, {constant(0)});
}

/// One value serves all elements of an array. A list that is too short leaves the rest 0 unless it says
/// otherwise, so the array is cleared first.
void Generator::initialise(RegisterId id, const Variable& variable) {
    const Expression& initial = *variable.initial;
    const ForUniform for_uniform(*this, variable.storage);
    const Type type = program_->reg(id).type;
    if (initial.kind == Expression::Kind::List) {
        const bool is_short =
            !initial.repeats && initial.children.size() < static_cast<size_t>(std::max(type.length, 0));
        if (is_short || type.is_unsized()) clear(id);
        return assign_list(initial, id);
    }
    if (!type.is_array() || initial.type.is_array()) {
        if (type.is_unsized()) clear(id);
        value(initial, id);
        return;
    }
    const RegisterId all = value(initial);
    for (int i = 0; i < type.length; ++i) emit(Op::SetElement, {id}, {constant(static_cast<float>(i)), all});
}

/// A register with a lane mask in place of a number: all bits where the value is true.
RegisterId Generator::condition(const Expression& e) {
    const RegisterId id = value(e);
    return base_of(id) == Base::Bool ? id : compute(Op::ToBool, Base::Bool, {id});
}

/// Else is given the condition again: lanes that parted at the If take the other half where it does not hold.
/// The decision keeps its register until the else: nothing that runs in between may write to it.
void Generator::if_statement(const Statement& s) {
    const RegisterId decision = condition(*s.expressions[0]);
    open(Op::If, {}, {decision});
    statement(*s.children[0]);
    if (s.children.size() > 1) {
        turn_to_else(decision);
        statement(*s.children[1]);
    }
    close(Op::EndIf);
}

/// Returns where the loop's opening will be.
size_t Generator::begin_loop() {
    turns_.push_back({region_, {}});
    return code_->size();
}

/// Puts an instruction between those that are there. Who holds places of the code behind it counts on.
void Generator::insert(size_t at, Op op, const Ids& operands, uint32_t region) {
    Instruction made;
    made.op = op;
    made.outputs = 1;
    made.region = region;
    made.operands = operands;
    made.at = at < code_->size() ? (*code_)[at].at : at_;
    code_->insert(code_->begin() + static_cast<std::ptrdiff_t>(at), std::move(made));
}

/// The turns that random() asks for are counted from 0.
void Generator::end_loop(size_t opening) {
    const Turns turns = turns_.back();
    turns_.pop_back();
    if (turns.number) insert(opening, Op::Move, {*turns.number, constant(0)}, turns.outside);
}

/// Counts a turn of the innermost loop, at a place of the code.
void Generator::count_turn(uint32_t region, size_t at) {
    if (const auto number = turns_.back().number)
        insert(at, Op::Add, {*number, *number, constant(1)}, region);
}

/// The turns of all loops around, the outermost first.
void Generator::add_turns(Ids& inputs) {
    for (Turns& turns : turns_) {
        if (!turns.number) {
            turns.number = add_register(Register::Kind::Local, {Base::Float, 0});
            program_->registers[*turns.number].region = turns.outside;
        }
        inputs.push_back(*turns.number);
    }
}

/// while and for. The condition is computed inside the loop in every turn, and stands before the body; what a
/// Continue jumps to, LoopStep, stands before the for's step.
void Generator::loop_statement(const Statement& s) {
    const bool counts = s.kind == Statement::Kind::For;
    const Expression* initial = counts ? s.expressions[0].get() : nullptr;
    const Expression* test = s.expressions[counts ? 1 : 0].get();
    if (initial) value(*initial);
    const size_t opening = begin_loop();
    open(Op::Loop, {}, {});
    if (test) emit(Op::LoopTest, {}, {condition(*test)});
    statement(*s.children[0]);
    emit(Op::LoopStep, {}, {});
    if (counts)
        for (size_t i = 2; i < s.expressions.size(); ++i)
            if (s.expressions[i]) value(*s.expressions[i]);
    count_turn(region_, code_->size());
    close(Op::EndLoop);
    end_loop(opening);
}

/// illuminance in surfaces and volumes; illuminate and solar in lights, which tell by them that the light has
/// a direction. All set L. After a loop over lights within another one's turn, L and Cl are that turn's
/// again.
void Generator::light_block(const Statement& s) {
    Ids inputs, outputs = {global("L", Base::Vector)};
    Op op = Op::Solar, end = Op::EndSolar;
    if (s.kind == Statement::Kind::Illuminance) {
        op = Op::Illuminance, end = Op::EndIlluminance;
        global("N", Base::Normal);  // lights may ask for it
        outputs.push_back(global("Cl", Base::Color));
        // The operation always has a category; without one it is empty, which means all lights.
        if (s.expressions[0]->type.base != Base::String) inputs.push_back(constant_text(""));
    } else {
        program_->directional = true;
        if (s.kind == Statement::Kind::Illuminate) {
            op = Op::Illuminate, end = Op::EndIlluminate;
        }
    }
    const bool within_turn = op == Op::Illuminance && light_loops_ > 0;
    Ids of_turn;
    for (size_t i = 0; within_turn && i < outputs.size(); ++i) {
        of_turn.push_back(add_register(Register::Kind::Local, program_->reg(outputs[i]).type));
        moved(outputs[i], base_of(outputs[i]), of_turn[i]);
    }
    const size_t plain = s.expressions.size() - s.named;
    for (size_t i = 0; i < plain; ++i) inputs.push_back(value(*s.expressions[i]));
    const size_t plain_inputs = inputs.size();
    for (size_t i = plain; i + 1 < s.expressions.size(); i += 2)
        option_for_lights(*s.expressions[i], *s.expressions[i + 1], inputs);
    // Light from all sides comes from where the surface looks.
    if (op == Op::Solar && inputs.empty()) inputs.push_back(global("Ns", Base::Normal));
    if (op == Op::Illuminate) inputs.insert(inputs.begin(), global("Ps", Base::Point));
    // keep_inputs() may insert copies in front of it, when all of the body is known.
    const size_t opening = code_->size();
    if (s.at.line) at_ = s.at;
    open(op, outputs, inputs);
    if (op == Op::Illuminance) (*code_)[opening].immediate = static_cast<int32_t>(plain_inputs);
    light_loops_ += op == Op::Illuminance ? 1 : 0;
    statement(*s.children[0]);
    light_loops_ -= op == Op::Illuminance ? 1 : 0;
    close(end);
    if (op == Op::Illuminance) keep_inputs(opening);
    for (size_t i = 0; i < of_turn.size(); ++i) moved(of_turn[i], base_of(outputs[i]), outputs[i]);
}

/// A name and a value behind the plain inputs of Illuminance. Arrays are sent as they are when the loop
/// begins: keep_inputs() does not copy them.
void Generator::option_for_lights(const Expression& name, const Expression& argument, Ids& inputs) {
    RegisterId sent = value(argument);
    const Type type = program_->reg(sent).type;
    if (type.is_unsized()) return warn_of_growing("illuminance", name, argument);
    if (type.is_array()) {
        const RegisterId copy = add_register(Register::Kind::Local, type);
        copy_array(sent, copy, type.base);
        sent = copy;
    }
    inputs.push_back(constant_text(name.text));
    inputs.push_back(sent);
}

void Generator::warn_of_growing(const char* word, const Expression& name, const Expression& argument) {
    diagnostics_.warning(
        argument.at, fmt::format("\"{}\" of {} is ignored: arrays that grow are not sent", name.text, word),
        "rsl-send-type " + name.text);
}

/// A loop over lights or rays asks for its inputs again in each turn: those that its turns change become
/// copies.
void Generator::keep_inputs(size_t opening) {
    std::vector<RegisterId> written;
    collect_written(*code_, opening, code_->size(), written);
    std::sort(written.begin(), written.end());
    for (size_t k = 0; k < (*code_)[opening].input_count(); ++k) {
        const RegisterId input = (*code_)[opening].input(k);
        if (!std::binary_search(written.begin(), written.end(), input)) continue;
        if (program_->reg(input).type.is_array()) continue;
        const RegisterId copy = temporary(base_of(input));
        Instruction& block = (*code_)[opening];
        program_->registers[copy].region = block.region;
        block.operands[block.outputs + k] = copy;
        insert(opening++, Op::Move, {copy, input}, block.region);
    }
}

/// A loop over rays, whose second half is for those that hit nothing. The opening sets the outputs in each
/// turn; elements of arrays are set behind it, in either half.
void Generator::gather_statement(const Statement& s) {
    constexpr size_t kPlain = 5;  // category, P, direction, angle, samples
    Ids inputs, names, more, outputs;
    std::vector<std::pair<const Expression*, RegisterId>> elements;
    for (size_t i = 0; i < kPlain; ++i) inputs.push_back(value(*s.expressions[i]));
    for (size_t i = kPlain; i + 1 < s.expressions.size(); i += 2) {
        const Expression &name = *s.expressions[i], &argument = *s.expressions[i + 1];
        if (!is_gather_output(name)) {
            const RegisterId given = value(argument);
            if (name.text.starts_with("send:") && program_->reg(given).type.is_unsized()) {
                warn_of_growing("gather", name, argument);
                continue;
            }
            more.push_back(value(name));
            more.push_back(given);
        } else if (argument.type.is_array() || argument.type.base == Base::String) {
            diagnostics_.warning(argument.at,
                                 fmt::format("gather() does not bring back {}: \"{}\" stays as it is",
                                             argument.type.is_array() ? "arrays" : "texts", name.text),
                                 "rsl-gather-type " + name.text);
        } else {
            names.push_back(value(name));
            outputs.push_back(output_place(argument, argument.type.base));
            elements.push_back({&argument, outputs.back()});
        }
    }
    inputs.insert(inputs.end(), names.begin(), names.end());
    inputs.insert(inputs.end(), more.begin(), more.end());
    const auto half = [&](size_t child) {
        for (const auto& [argument, place] : elements) write_back(*argument, place);
        if (child < s.children.size()) statement(*s.children[child]);
    };
    const size_t opening = begin_loop();
    open(Op::Gather, outputs, inputs);
    const uint32_t hit = region_;
    const size_t first = code_->size();
    half(0);
    // As in turn_to_else(): the second half is a region of its own.
    region_ = open_regions_.back();
    emit(Op::GatherElse, {}, {});
    region_ = ++last_region_;
    const size_t second = code_->size();
    half(1);
    // Each ray takes one half, which may end anywhere: turns are counted where they begin, from 1.
    count_turn(region_, second), count_turn(hit, first);
    close(Op::EndGather);
    keep_inputs(opening);
    end_loop(opening);
}

/// The value goes to the caller's register; at the end of a body nothing has to be left. Leave takes lanes
/// out of the running ones up to the end of the scope; others go on.
void Generator::return_statement(const Statement& s) {
    if (!s.expressions.empty() && s.expressions[0]) {
        if (body_.result)
            value(*s.expressions[0], *body_.result);
        else
            value(*s.expressions[0]);
    }
    if (body_.in_scope) emit(Op::Leave, {}, {});
}

}  // namespace trapeze::rsl
