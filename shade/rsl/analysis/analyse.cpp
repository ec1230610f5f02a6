#include "shade/rsl/analysis/analyser.h"

#include <utility>

#include "shade/rsl/analysis/analysis.h"
#include "shade/rsl/analysis/globals.h"
#include "shade/rsl/analysis/propagate_varying.h"
#include "shade/rsl/analysis/suggestions.h"
#include "shade/rsl/syntax/clone.h"
#include "shade/rsl/syntax/parser.h"
#include "shade/rsl/syntax/printer.h"

namespace trapeze::rsl {
namespace {

// Bounds a call's cost, which is compared with every function of its name.
constexpr size_t kMostOverloads = 32;  // written functions of one name

/// Names from the source are cut, for a message must not grow with a file from a stranger.
std::string in_quotes(std::string_view name) {
    return "\"" + std::string(name.substr(0, 80)) + "\"";
}

/// Makes all that name a variable name another one. The name in the text stays: the new variable has the same
/// one.
void replace_variable(Expression& e, const Variable* old, Variable* now) {
    if (e.variable == old) e.variable = now;
    for (const ExpressionPtr& child : e.children) replace_variable(*child, old, now);
}

/// Functions that are nested in the statement are the caller's to look at: their bodies stand elsewhere in
/// the tree.
void replace_variable(Statement& s, const Variable* old, Variable* now) {
    for (const ExpressionPtr& e : s.expressions)
        if (e) replace_variable(*e, old, now);
    for (const auto& variable : s.variables)
        if (variable->initial) replace_variable(*variable->initial, old, now);
    for (const StatementPtr& child : s.children) replace_variable(*child, old, now);
}

}  // namespace

void analyse(TranslationUnit& unit, Reporter& reporter) {
    Analyser(unit, reporter).run();
}

/// Shaders one after the other: functions have no meaning by themselves, since the variables that they name
/// as extern are those of the shader that calls them. Those that no shader calls are not looked at.
void Analyser::run() {
    for (const auto& function : unit_.functions) {
        if (!function->inside.empty()) continue;
        std::vector<const Function*>& same_name = file_functions_[function->name];
        same_name.push_back(function.get());
        if (same_name.size() > kMostOverloads)
            return error(function->at, "too many functions are called " + in_quotes(function->name));
    }
    for (const auto& function : unit_.functions) check_defaults(*function);
    // Two shaders of one name: a scene could not say which it means. Of a class it says by where it names it.
    std::set<std::pair<std::string_view, int>> names;
    for (const auto& shader : unit_.shaders) {
        if (reporter_.full()) return;
        const int kind = shader->of_class ? static_cast<int>(shader->kind) : -1;
        if (!names.emplace(shader->name, kind).second)
            error(shader->at, "there are two shaders " + in_quotes(shader->name) + " in this file");
        analyse_shader(*shader);
    }
    unit_.functions = std::move(kept_);
}

// ---- Shaders and functions

/// Parameters are declared one by one as their defaults are analysed, for a default may name the parameters
/// before it.
void Analyser::analyse_shader(Shader& shader) {
    shader_ = &shader;
    file_instances_.clear();
    instances_.clear();
    instance_of_copy_.clear();
    globals_.clear();
    warned_.clear();
    unavailable_.clear();
    scopes_.clear();
    bodies_.clear();
    bodies_.emplace_back();
    scopes_.emplace_back();
    for (const auto& parameter : shader.parameters) {
        check_array(*parameter);
        if (parameter->external) error(parameter->at, "a shader's parameter cannot be extern");
        // Parameters come from the scene, once for all vertices, unless they say otherwise.
        if (parameter->storage == Storage::Unspecified) parameter->storage = Storage::Uniform;
        initial_value(*parameter);
        declare(*parameter);
    }
    statement(shader.body);
    if (body().operations > kMostInlined)
        error(shader.at, "this shader is too large once its functions are put in place of their calls");
    if (body().array_floats > kMostArrayFloatsTogether)
        error(shader.at, "the arrays of this shader are too large together");
    std::vector<Function*> functions;
    for (Instance& instance : instances_)
        if (instance.complete) functions.push_back(instance.function.get());
    if (!reporter_.failed()) propagate_varying(shader, functions, reporter_);
    for (Instance& instance : instances_) kept_.push_back(std::move(instance.function));
}

/// A copy of the function for this shader, analysed; null after an error that concerns the call. Copies are
/// limited in number and depth, as calls are inlined: a few functions that each call the one before twice
/// would make a program of any size.
Analyser::Instance* Analyser::instance_of(const Function& original, bool nested, SourceLocation at) {
    if (depth_ + body().depth + height_ > kDeepestInlined) {
        error(at, "functions that call functions nest too deeply here");
        return nullptr;
    }
    if (copied_ > kMostInlined) {
        error(at, "this file is too large: too many shaders have too many functions");
        return nullptr;
    }
    Instance& instance = instances_.emplace_back();
    instance.original = &original;
    instance.function = clone(original);
    instance_of_copy_[instance.function.get()] = &instance;
    if (nested) {
        std::vector<Instance*>& same_name = scopes_.back().functions[original.name];
        same_name.push_back(&instance);
        if (same_name.size() > kMostOverloads) {
            error(original.at, "too many functions are called " + in_quotes(original.name));
            return nullptr;
        }
    } else {
        file_instances_[&original] = &instance;
    }
    // What is analysed now has to wait: a call is met in the middle of an expression, whose choices are put
    // aside while the function's own expressions are walked.
    auto choices = std::move(choices_);
    const Expression* channel = std::exchange(channel_, nullptr);
    const int height = std::exchange(height_, 0);
    // The tree's height as code generation will meet it, with the function in place of its call.
    const int entered = body().depth + height;
    depth_ += entered;
    choices_.clear();

    Body& inner = bodies_.emplace_back();
    inner.instance = &instance;
    inner.nested = nested;
    inner.first_scope = scopes_.size();
    analyse_body(*instance.function);
    finish_instance(instance);
    scopes_.resize(inner.first_scope);
    bodies_.pop_back();

    depth_ -= entered;
    choices_ = std::move(choices);
    channel_ = channel;
    height_ = height;
    return &instance;
}

/// A function's parameters and statements, as the innermost body. The scope of the parameters stays open for
/// whoever called this, and is closed with the body.
void Analyser::analyse_body(Function& function) {
    scopes_.emplace_back();
    for (const auto& parameter : function.parameters) {
        if (parameter->external) error(parameter->at, "a function's parameter cannot be extern");
        if (parameter->type.length > 0) check_array(*parameter);
        declare(*parameter);
    }
    statement(function.body);
    if (function.result.base != Base::Void && !body().returns)
        reporter_.warning(function.at,
                          "function " + in_quotes(function.name) + " never returns a value: it is 0");
}

/// What a call of the function adds to its caller: counts are kept from running over, since calls multiply
/// them.
void Analyser::finish_instance(Instance& instance) {
    copy_written_parameters(*instance.function);
    copied_ += body().own_operations;
    instance.operations = std::min<uint64_t>(body().operations, uint64_t{kMostInlined} * 2);
    instance.array_floats = std::min<uint64_t>(body().array_floats, uint64_t{kMostArrayFloatsTogether} * 2);
    instance.depth = body().deepest;
    instance.complete = true;
}

/// Parameters stand for the caller's variables, and only those that are output may change them. What a
/// function does to others happens to a local of the same name.
void Analyser::copy_written_parameters(Function& function) {
    for (const auto& parameter : function.parameters) {
        if (!body().written_parameters.contains(parameter.get())) continue;
        auto local = std::make_unique<Variable>();
        local->name = parameter->name;
        local->type = parameter->type;
        local->storage = parameter->storage;
        local->at = parameter->at;
        replace_variable(*function.body, parameter.get(), local.get());
        // Functions nested in this one may name its parameter, and mean the local now.
        for (const Instance& other : instances_)
            if (other.complete && other.function->inside == function.name)
                replace_variable(*other.function->body, parameter.get(), local.get());
        local->initial = std::make_unique<Expression>();
        local->initial->kind = Expression::Kind::Variable;
        local->initial->text = parameter->name;
        local->initial->at = parameter->at;
        local->initial->type = parameter->type;
        local->initial->variable = parameter.get();
        auto declaration = std::make_unique<Statement>();
        declaration->kind = Statement::Kind::Declare;
        declaration->at = parameter->at;
        declaration->variables.push_back(std::move(local));
        function.body->children.insert(function.body->children.begin(), std::move(declaration));
    }
}

// ---- Variables

/// Puts a name into the innermost scope. A local declared twice is warned of and hides the first; any other
/// name is an error.
void Analyser::declare(Variable& variable) {
    Variable*& known = scopes_.back().variables[variable.name];
    if (known && variable.kind == Variable::Kind::Local && known->kind == Variable::Kind::Local)
        reporter_.warning(variable.at,
                          in_quotes(variable.name) + " is declared twice: this one hides the other");
    else if (known)
        error(variable.at, in_quotes(variable.name) + " is declared twice");
    known = &variable;
}

/// A local array without a length has that of its list of values until something resizes it, and a parameter
/// of the shader the one that the scene gives; bounds keep a shader from wanting all memory. All arrays of a
/// body are counted together, with those of the functions that are inlined into it: each lane has them all.
void Analyser::check_array(Variable& variable) {
    if (!variable.type.is_array()) return;
    const bool listed = variable.initial && variable.initial->kind == Expression::Kind::List &&
                        !variable.initial->children.empty();
    if (variable.type.length == Type::kUnsized && variable.kind == Variable::Kind::Local && listed &&
        variable.initial->children.size() <= static_cast<size_t>(kLongestArray)) {
        variable.type.length = static_cast<int>(variable.initial->children.size());
        variable.growable = true;
    }
    // Strings have no floats, yet each costs something.
    const int length = variable.type.length == Type::kUnsized ? kFloatsOfUnsized : variable.type.length;
    const uint64_t floats =
        static_cast<uint64_t>(length) * static_cast<uint64_t>(std::max(width_of(variable.type.base), 1));
    if (floats > kMostArrayFloats)
        error(variable.at, "array " + in_quotes(variable.name) + " is too large: " + std::to_string(floats) +
                               " floats, at most " + std::to_string(kMostArrayFloats));
    else if (variable.kind != Variable::Kind::FunctionParameter)
        body().array_floats += floats;
}

/// A default or initial value, in the type of the variable.
void Analyser::initial_value(Variable& variable) {
    if (!variable.initial) return;
    if (variable.external) {
        error(variable.at, "an extern variable has its value from outside");
    } else if (variable.type.is_array()) {
        value_of_array(variable);
    } else if (variable.initial->kind == Expression::Kind::List) {
        error(variable.initial->at, in_quotes(variable.name) + " is no array, and has one value");
    } else {
        value(variable.initial, variable.type.base);
    }
}

/// A list, another array, or one value for all elements. Fewer values than elements leave the rest 0, or the
/// last value where the list says so; more are an error, since some were meant and would be lost.
void Analyser::value_of_array(Variable& variable) {
    // Without braces: an array that is copied, or one value for all.
    if (variable.initial->kind != Expression::Kind::List) {
        const Expression& from = *variable.initial;
        const Variable* named = from.kind == Expression::Kind::Variable ? find_variable(from.text) : nullptr;
        if (!named && from.kind == Expression::Kind::Variable && body().nested)
            named = find_outside(from.text, bodies_.size() - 1);
        const bool is_array = named && named->type.is_array();
        value(variable.initial, is_array ? Base::Void : variable.type.base);
        const Type given = variable.initial->type;
        const bool any_length = given.length == Type::kUnsized || variable.type.length == Type::kUnsized;
        if (!is_array && variable.type.length == Type::kUnsized)
            error(variable.initial->at,
                  "array " + in_quotes(variable.name) + " needs a length, or values in braces");
        if (is_array &&
            (given.base != variable.type.base || (given.length != variable.type.length && !any_length)))
            error(variable.initial->at, in_quotes(variable.name) + " is a " + print(variable.type) +
                                            ", its initial value a " + print(given));
        return;
    }
    std::vector<ExpressionPtr>& values = variable.initial->children;
    const size_t most =
        static_cast<size_t>(variable.type.length == Type::kUnsized ? kLongestArray : variable.type.length);
    if (values.size() > most)
        error(values[most]->at, std::to_string(values.size()) + " values for the " + std::to_string(most) +
                                    " elements of " + in_quotes(variable.name));
    if (variable.initial->repeats && (variable.type.is_unsized() || variable.growable))
        error(variable.initial->at, "\"...\" fills arrays of a length of their own alone");
    for (ExpressionPtr& e : values) value(e, variable.type.base);
    variable.initial->type = variable.type;
}

/// Makes a name of outside known in this scope; false, after a report, when there is none. After an error of
/// kind the name is bound all the same: one message is enough.
bool Analyser::bind_external(const Variable& variable) {
    Variable* found =
        bodies_.size() == 1 ? find_variable(variable.name) : find_outside(variable.name, bodies_.size() - 1);
    // The renderer's variables are outside of all.
    if (!found) found = global(variable.name);
    if (!found) {
        Suggestion suggestion(variable.name);
        for (const GlobalVariable& row : global_variables(shader_->kind)) suggestion.consider(row.name);
        for (const auto& parameter : shader_->parameters) suggestion.consider(parameter->name);
        error(variable.at, "there is no variable " + in_quotes(variable.name) + " outside, in " +
                               std::string(name_of(shader_->kind)) + " shader " + in_quotes(shader_->name) +
                               suggestion.text());
        return false;
    }
    const bool same_kind = same_family(found->type.base, variable.type.base) &&
                           found->type.is_array() == variable.type.is_array();
    if (!same_kind)
        error(variable.at, "extern " + in_quotes(variable.name) + " is a " + print(found->type) +
                               " outside, not a " + print(variable.type));
    scopes_.back().variables[found->name] = found;
    return true;
}

/// The innermost variable of that name in the body that is analysed; null when it has none.
Variable* Analyser::find_variable(std::string_view name) {
    for (size_t i = scopes_.size(); i-- > body().first_scope;) {
        const auto entry = scopes_[i].variables.find(name);
        if (entry != scopes_[i].variables.end()) return entry->second;
    }
    return nullptr;
}

/// What body `number` sees outside itself. Of a nested function: what encloses it, body by body. Of another:
/// the shader's parameters and outermost variables, which are the first two scopes; what the callers in
/// between declare is not seen.
Variable* Analyser::find_outside(std::string_view name, size_t number) {
    const Body& inner = bodies_[number];
    if (number == 0) return nullptr;
    const size_t first = inner.nested ? bodies_[number - 1].first_scope : 0;
    const size_t last = inner.nested ? inner.first_scope : std::min<size_t>(2, inner.first_scope);
    for (size_t i = last; i-- > first;) {
        const auto entry = scopes_[i].variables.find(name);
        if (entry != scopes_[i].variables.end()) return entry->second;
    }
    return inner.nested ? find_outside(name, number - 1) : nullptr;
}

/// The renderer's variable of that name, made when it is first named; null when there is none. Only those
/// that a shader uses are made, so that the machine has to fill no others.
Variable* Analyser::global(std::string_view name) {
    const auto entry = globals_.find(name);
    if (entry != globals_.end()) return entry->second;
    const GlobalVariable* row = find_global(shader_->kind, name);
    if (!row) return nullptr;
    auto variable = std::make_unique<Variable>();
    variable->name = row->name;
    variable->type.base = row->base;
    variable->storage = row->storage;
    variable->kind = Variable::Kind::Global;
    variable->output = row->writable;
    globals_[variable->name] = variable.get();
    shader_->globals.push_back(std::move(variable));
    return shader_->globals.back().get();
}

/// Says that there is no such variable: with the word extern where the shader has one, with the kinds of
/// shaders that have one, or with a name that is near.
void Analyser::unknown_variable(const Expression& e) {
    if (bodies_.size() > 1 && find_outside(e.text, bodies_.size() - 1)) {
        error(e.at,
              in_quotes(e.text) + " is a variable of the shader: functions name those as \"extern\" first");
        return;
    }
    Suggestion suggestion(e.text);
    for (size_t i = scopes_.size(); i-- > body().first_scope;)
        for (const auto& [name, variable] : scopes_[i].variables) suggestion.consider(name);
    for (const GlobalVariable& row : global_variables(shader_->kind)) suggestion.consider(row.name);
    std::string where;
    if (suggestion.text().empty())
        for (const ShaderKind kind : {ShaderKind::Surface, ShaderKind::Displacement, ShaderKind::Light,
                                      ShaderKind::Volume, ShaderKind::Imager})
            if (where.empty() && find_global(kind, e.text))
                where = "; " + std::string(name_of(kind)) + " shaders have one, this is a " +
                        std::string(name_of(shader_->kind)) + " shader";
    error(e.at, "there is no variable " + in_quotes(e.text) + where + suggestion.text());
}

}  // namespace trapeze::rsl
