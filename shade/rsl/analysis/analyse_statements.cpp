#include <algorithm>

#include "shade/operations/ray_parameters.h"
#include "shade/rsl/analysis/analyser.h"
#include "shade/rsl/analysis/globals.h"
#include "shade/rsl/syntax/parser.h"
#include "shade/rsl/syntax/printer.h"

namespace trapeze::rsl {

/// Takes one expression through both walks (see analyser.h). What they learn of it is of no use afterwards.
/// `wanted` is the type that it is converted to; Void lets it have its own.
void Analyser::value(ExpressionPtr& e, Base wanted) {
    choices_.clear();
    height_ = e->height;
    body().deepest = std::max(body().deepest, body().depth + e->height);
    possible_types(*e);
    choose_type(e, wanted);
    choices_.clear();
    height_ = 0;
}

/// A statement within another one. What one without braces declares is known behind it, as other compilers
/// have it, unless the name already means something there.
void Analyser::scoped(StatementPtr& s) {
    if (s->kind == Statement::Kind::Declare) declare_again(s);
    // Only names that mean nothing yet live on; otherwise code behind would change its meaning.
    const bool declares =
        s->kind == Statement::Kind::Declare && std::ranges::none_of(s->variables, [&](const auto& v) {
            return v->external || find_variable(v->name) || find_global(shader_->kind, v->name);
        });
    if (declares)
        for (const auto& variable : s->variables) variable->outlives = true;
    const bool own_scope =
        s->kind == Statement::Kind::Block || (s->kind == Statement::Kind::Declare && !declares);
    if (own_scope) scopes_.emplace_back();
    statement(s);
    if (own_scope) scopes_.pop_back();
}

/// The other branch's declaration of a variable that lives on becomes an assignment to it.
void Analyser::declare_again(StatementPtr& s) {
    if (s->variables.size() != 1 || !s->variables.front()->initial) return;
    Variable& again = *s->variables.front();
    const Variable* known = find_variable(again.name);
    // "if (a) float x = 1; else float x = 2;" is meant as one variable with two values.
    if (!known || !known->outlives || known->type != again.type || again.type.is_array()) return;
    auto place = std::make_unique<Expression>();
    place->kind = Expression::Kind::Variable;
    place->text = again.name;
    place->at = again.at;
    auto assignment = std::make_unique<Expression>();
    assignment->kind = Expression::Kind::Assignment;
    assignment->at = again.at;
    assignment->height = static_cast<uint16_t>(again.initial->height + 1);
    assignment->children.push_back(std::move(place));
    assignment->children.push_back(std::move(again.initial));
    s->kind = Statement::Kind::Evaluate;
    s->variables.clear();
    s->expressions.push_back(std::move(assignment));
}

/// Counts the statement and its depth, since all of it is inlined where the function is called.
void Analyser::statement(StatementPtr& s) {
    if (reporter_.full()) return;
    ++body().operations;
    ++body().own_operations;
    ++body().depth;
    switch (s->kind) {
        case Statement::Kind::Block:
            block(*s);
            break;
        case Statement::Kind::Declare:
            declaration(*s);
            break;
        case Statement::Kind::Evaluate:
            value(s->expressions[0], Base::Void);
            break;
        case Statement::Kind::If:
            value(s->expressions[0], Base::Bool);
            for (StatementPtr& child : s->children) scoped(child);
            break;
        case Statement::Kind::While:
        case Statement::Kind::For:
            loop(*s);
            break;
        case Statement::Kind::Illuminance:
        case Statement::Kind::Illuminate:
        case Statement::Kind::Solar:
            light_loop(*s);
            break;
        case Statement::Kind::Gather:
            gather(*s);
            break;
        case Statement::Kind::Break:
        case Statement::Kind::Continue:
            jump(*s);
            break;
        case Statement::Kind::Return:
            return_statement(*s);
            break;
        case Statement::Kind::Empty:
            // A nested function: it is analysed where it is written, and known from here on.
            if (s->defines)
                if (const Instance* instance = instance_of(*s->defines, true, s->at))
                    s->defines = instance->function.get();
            break;
    }
    --body().depth;
}

/// Statements in order. A block that the parser made without braces is open: its names belong outside.
void Analyser::block(Statement& s) {
    if (!s.open) scopes_.emplace_back();
    for (StatementPtr& child : s.children) statement(child);
    if (!s.open) scopes_.pop_back();
}

/// extern variables mean those of outside and leave the tree; all others are new. One after another, so that
/// "float a = 1, b = a" means what it says.
void Analyser::declaration(Statement& s) {
    std::vector<std::unique_ptr<Variable>> kept;
    for (auto& variable : s.variables) {
        if (variable->external) {
            if (variable->initial) error(variable->at, "an extern variable has its value from outside");
            if (bind_external(*variable)) continue;
        }
        if (variable->output) error(variable->at, "only parameters are output");
        check_array(*variable);
        initial_value(*variable);  // before the name is known: it may mean one of outside
        declare(*variable);
        kept.push_back(std::move(variable));
    }
    s.variables = std::move(kept);
}

/// while and for. The condition is expression 0 of a while, 1 of a for; the others are run for what they do.
void Analyser::loop(Statement& s) {
    for (size_t i = 0; i < s.expressions.size(); ++i) {
        const bool is_condition = s.kind == Statement::Kind::While || i == 1;
        if (s.expressions[i]) value(s.expressions[i], is_condition ? Base::Bool : Base::Void);
    }
    // Counted for break and continue, which name loops by their number.
    ++body().loops;
    scoped(s.children[0]);
    --body().loops;
}

/// lightsource("name", value): what "light:name" asks for, once in each turn.
StatementPtr Analyser::message_of_light(const Expression& option, ExpressionPtr value) {
    auto call = std::make_unique<Expression>();
    call->kind = Expression::Kind::Call, call->text = "lightsource", call->at = option.at;
    auto name = std::make_unique<Expression>();
    name->kind = Expression::Kind::Text, name->at = option.at;
    name->text = option.text.substr(option.text.find(':') + 1);
    call->children.push_back(std::move(name));
    call->children.push_back(std::move(value));
    auto statement = std::make_unique<Statement>();
    statement->kind = Statement::Kind::Evaluate, statement->at = option.at;
    statement->expressions.push_back(std::move(call));
    return statement;
}

/// Whether a named option of illuminance is for lights, to which a run hands it on; says what is wrong with
/// others. That lights are not run again ("reuse") is so anyhow, where they may be known.
bool Analyser::is_for_lights(const Expression& option, const Expression& value, const std::string& word) {
    const bool literal = option.kind == Expression::Kind::Text && word == "illuminance";
    if (literal && option.text == "lightcache") {
        if (value.kind != Expression::Kind::Text || value.text == "refresh") return true;
        if (value.text != "reuse")
            reporter_.warning(
                value.at,
                "\"lightcache\" of illuminance knows \"refresh\" and \"reuse\", not \"" + value.text + "\"");
        return false;
    }
    if (literal && option.text.starts_with(kSendToLight)) {
        if (option.text.size() > kSendToLight.size()) return true;
        error(option.at, "\"" + option.text + "\" of illuminance names no parameter");
        return false;
    }
    reporter_.warning(option.at, "\"" + option.text + "\" of " + word + " is ignored");
    return false;
}

/// "name", value, ... behind the arguments of a loop over lights or of a light's block. They are known by a
/// string literal from which on names and values pair up to the end; categories are strings, too, and so a
/// lone one stays. What is for lights stays, too.
void Analyser::take_options(Statement& s, const std::string& word) {
    const size_t given = s.expressions.size();
    for (size_t i = s.kind == Statement::Kind::Solar ? 0 : 1; i < given; ++i) {
        if (s.expressions[i]->kind != Expression::Kind::Text || (given - i) % 2 != 0) continue;
        std::vector<StatementPtr> messages;
        size_t kept = i;
        for (size_t name = i; name < given; name += 2) {
            ExpressionPtr option = std::move(s.expressions[name]), value = std::move(s.expressions[name + 1]);
            const bool from_light = s.kind == Statement::Kind::Illuminance &&
                                    option->kind == Expression::Kind::Text &&
                                    option->text.starts_with("light:");
            if (from_light) {
                messages.push_back(message_of_light(*option, std::move(value)));
            } else if (is_for_lights(*option, *value, word)) {
                s.expressions[kept++] = std::move(option);
                s.expressions[kept++] = std::move(value);
            }
        }
        s.expressions.resize(kept);
        s.named = kept - i;
        if (messages.empty()) return;
        auto block = std::make_unique<Statement>();
        block->kind = Statement::Kind::Block, block->at = s.at;
        block->children = std::move(messages);
        block->children.push_back(std::move(s.children[0]));
        s.children[0] = std::move(block);
        return;
    }
}

/// What stands behind a name that is for lights.
void Analyser::value_for_lights(const std::string& name, ExpressionPtr& e) {
    const bool sent = name != "lightcache";
    value(e, sent ? Base::Void : Base::String);
    if (sent) check_value_to_send("illuminance", name, *e);
}

void Analyser::check_value_to_send(const std::string& word, const std::string& name, const Expression& e) {
    if (e.type.base == Base::Void || e.type.base == Base::Bool)
        error(e.at, "\"" + name + "\" of " + word + " has no value to send");
}

/// Whether a name sends a value along with gather's rays; says what is wrong with it.
bool Analyser::is_for_hits(const Expression& name, const Expression& value) {
    const std::optional<SentName> sent =
        name.kind == Expression::Kind::Text ? sent_name(name.text) : std::nullopt;
    if (!sent) return false;
    if (sent->name.empty()) error(name.at, "\"" + name.text + "\" of gather names no parameter");
    check_value_to_send("gather", name.text, value);
    return true;
}

/// illuminance([category,] P [, axis, angle]), illuminate(P [, axis, angle]), solar([axis, angle]). The
/// category's type is found by trial: possible types are asked for, and forgotten again, before the arguments
/// are analysed for good.
void Analyser::light_loop(Statement& s) {
    const bool illuminance = s.kind == Statement::Kind::Illuminance;
    const std::string word = illuminance                             ? "illuminance"
                             : s.kind == Statement::Kind::Illuminate ? "illuminate"
                                                                     : "solar";
    const ShaderKind kind = shader_->kind;
    const bool in_place =
        illuminance ? kind == ShaderKind::Surface || kind == ShaderKind::Volume : kind == ShaderKind::Light;
    if (!in_place)
        error(s.at, word + " belongs into " + (illuminance ? "surface and volume" : "light") + " shaders");

    take_options(s, word);
    // What each argument is converted to; there are as many as the form that was meant has arguments.
    std::vector<Base> wanted;
    const size_t given = s.expressions.size() - s.named;
    if (illuminance && given > 0) {
        // The category is known by being a string.
        choices_.clear();
        const Choices first = possible_types(*s.expressions[0]);
        choices_.clear();
        if (first.cost_to(Base::String) < Choices::kNever && !first.is_unknown())
            wanted.push_back(Base::String);
    }
    if (s.kind != Statement::Kind::Solar) wanted.push_back(Base::Point);
    if (given > wanted.size()) {
        wanted.push_back(Base::Vector);
        wanted.push_back(Base::Float);
    }
    if (given != wanted.size()) {
        error(s.at, word + " takes " +
                        (illuminance                             ? "([category,] P [, axis, angle])"
                         : s.kind == Statement::Kind::Illuminate ? "(P [, axis, angle])"
                                                                 : "([axis, angle])"));
    } else {
        for (size_t i = 0; i < given; ++i) value(s.expressions[i], wanted[i]);
    }
    for (size_t i = given; i + 1 < s.expressions.size(); i += 2) {
        value(s.expressions[i], Base::String);
        value_for_lights(s.expressions[i]->text, s.expressions[i + 1]);
    }
    // The statement's body reads or sets these, named in the source or not.
    global("L");
    global(illuminance ? "Cl" : "Ps");
    body().loops += illuminance ? 1 : 0;
    scoped(s.children[0]);
    body().loops -= illuminance ? 1 : 0;
}

/// gather(category, P, direction, angle, samples, name, value, ...): what a name with a colon asks for is
/// written to its value.
void Analyser::gather(Statement& s) {
    static constexpr Base kWanted[] = {Base::String, Base::Point, Base::Vector, Base::Float, Base::Float};
    const size_t given = s.expressions.size();
    if (given < 5 || (given - 5) % 2 != 0)
        error(s.at, "gather takes (category, P, direction, angle, samples, \"name\", value, ...)");
    if (const Expression* const category = given > 0 ? s.expressions[0].get() : nullptr;
        category && category->kind == Expression::Kind::Text && category->text.starts_with("pointcloud:"))
        reporter_.warning(category->at,
                          "gather() of \"" + category->text + "\" is not supported: it traces rays");
    for (size_t i = 0; i < given; ++i) {
        // Behind the first five, names and values in turn.
        const bool is_name = i >= 5 && (i - 5) % 2 == 0;
        value(s.expressions[i], i < 5 ? kWanted[i] : is_name ? Base::String : Base::Void);
        if (i < 5 || is_name) continue;
        const Expression& name = *s.expressions[i - 1];
        if (!is_gather_output(name)) {
            if (!is_for_hits(name, *s.expressions[i]))
                check_ray_argument("gather", s.at, name, *s.expressions[i]);
            continue;
        }
        if (is_place(*s.expressions[i]))
            check_written(*s.expressions[i]);
        else
            error(s.expressions[i]->at, "gather writes \"" + name.text + "\" to a variable");
    }
    ++body().loops;
    for (StatementPtr& child : s.children) scoped(child);
    --body().loops;
}

/// break and continue, which may name a loop further out by its number. Loops of a function that is called do
/// not count: no jump leaves a function.
void Analyser::jump(const Statement& s) {
    const std::string word = s.kind == Statement::Kind::Break ? "break" : "continue";
    if (body().loops == 0)
        error(s.at, word + " stands outside of loops");
    else if (s.levels > body().loops)
        error(s.at, word + " " + std::to_string(s.levels) + " stands in only " +
                        std::to_string(body().loops) + (body().loops == 1 ? " loop" : " loops"));
}

/// A value in a function that has a type, none in others and in shaders. In a shader's own body a return
/// without a value ends the shader.
void Analyser::return_statement(Statement& s) {
    const Base result = body().instance ? body().instance->function->result.base : Base::Void;
    body().returns = body().returns || !s.expressions.empty();
    if (s.expressions.empty()) {
        if (result != Base::Void) error(s.at, "a " + std::string(name_of(result)) + " is to be returned");
        return;
    }
    if (result != Base::Void) return value(s.expressions[0], result);
    // An error, but the value is analysed all the same, for what else is wrong with it.
    value(s.expressions[0], Base::Void);
    error(s.at,
          body().instance ? "this function returns nothing: its type is void" : "a shader returns no value");
}

}  // namespace trapeze::rsl
