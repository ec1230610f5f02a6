/// Classes of RSL 2 that are shaders by themselves: they become shaders of RSL 1. Members are variables of
/// the shader's body, methods functions within it, and the body calls those that the renderer would call.
#include <algorithm>
#include <array>
#include <iterator>
#include <map>
#include <optional>
#include <utility>

#include "shade/rsl/syntax/parser.h"

namespace trapeze::rsl {
namespace {

/// A method that the renderer calls, what it makes of a class (nothing: shaders of every kind may have it),
/// and the variables that it is handed, in order.
struct RendererMethod {
    std::string_view name;
    std::optional<ShaderKind> kind;
    std::array<std::string_view, 2> variables;
};
/// In the order of calls.
constexpr RendererMethod kRendererMethods[] = {
    {"construct", {}, {}},
    {"begin", {}, {}},
    {"opacity", ShaderKind::Surface, {"Oi"}},
    {"prelighting", ShaderKind::Surface, {"Ci", "Oi"}},
    {"surface", ShaderKind::Surface, {"Ci", "Oi"}},
    {"lighting", ShaderKind::Surface, {"Ci", "Oi"}},
    {"postlighting", ShaderKind::Surface, {"Ci", "Oi"}},
    {"light", ShaderKind::Light, {"L", "Cl"}},
    {"volume", ShaderKind::Volume, {"Ci", "Oi"}},
    {"imager", ShaderKind::Imager, {"Ci", "Oi"}},
    {"displacement", ShaderKind::Displacement, {"P", "N"}},
};

const RendererMethod* renderer_method(std::string_view name) {
    const auto* const found = std::ranges::find(kRendererMethods, name, &RendererMethod::name);
    return found == std::end(kRendererMethods) ? nullptr : found;
}

ExpressionPtr expression_of(Expression::Kind kind, std::string_view text, SourceLocation at) {
    auto made = std::make_unique<Expression>();
    made->kind = kind;
    made->text = text;
    made->at = at;
    return made;
}

void add_child(Expression& to, Expression::Kind kind, std::string_view text) {
    to.children.push_back(expression_of(kind, text, to.at));
    to.height = 2;
}

StatementPtr evaluate(ExpressionPtr expression) {
    auto statement = std::make_unique<Statement>();
    statement->kind = Statement::Kind::Evaluate;
    statement->at = expression->at;
    statement->expressions.push_back(std::move(expression));
    return statement;
}

/// A call of a method of the renderer's, with the variables that stand for its parameters.
StatementPtr call_of(const std::string& name, const std::vector<std::string_view>& variables,
                     SourceLocation at) {
    ExpressionPtr call = expression_of(Expression::Kind::Call, name, at);
    for (const std::string_view variable : variables) add_child(*call, Expression::Kind::Variable, variable);
    return evaluate(std::move(call));
}

// A class that shades and displaces is two shaders: what displaces leaves its members in output parameters
// under names that no source has, and what shades asks for them by a message, as displacement() does. Other
// classes, which may displace in its place, have other names.

struct HandedMember {
    std::string name, handed_name;
    Type type;
    SourceLocation at;
};

/// Members that are handed over, and output parameters: numbers, points and their like, and texts.
std::vector<HandedMember> handed_members(const std::string& of_class,
                                         const std::vector<std::unique_ptr<Variable>>& parameters,
                                         const std::vector<StatementPtr>& members) {
    std::vector<HandedMember> handed;
    const auto add = [&](const Variable& variable) {
        if (variable.structure || variable.type.is_array()) return;
        handed.push_back(
            {variable.name, "member:" + of_class + ":" + variable.name, variable.type, variable.at});
    };
    for (const auto& parameter : parameters)
        if (parameter->output) add(*parameter);
    for (const StatementPtr& statement : members)
        for (const auto& variable : statement->variables) add(*variable);
    return handed;
}

/// What is uniform goes as varying: it has become that where it got a value that varies, which was said.
void hand_over(const std::vector<HandedMember>& members, Shader& displacement) {
    for (const HandedMember& member : members) {
        auto parameter = std::make_unique<Variable>();
        const bool is_text = member.type.base == Base::String;
        parameter->name = member.handed_name;
        parameter->type = member.type;
        parameter->storage = is_text ? Storage::Uniform : Storage::Varying;
        parameter->kind = Variable::Kind::Parameter;
        parameter->output = true;
        parameter->at = member.at;
        parameter->initial =
            expression_of(is_text ? Expression::Kind::Text : Expression::Kind::Number, "", member.at);
        ExpressionPtr told = expression_of(Expression::Kind::Assignment, "", member.at);
        add_child(*told, Expression::Kind::Variable, member.handed_name);
        add_child(*told, Expression::Kind::Variable, member.name);
        displacement.body->children.push_back(evaluate(std::move(told)));
        displacement.parameters.push_back(std::move(parameter));
    }
}

void take_over(const std::vector<HandedMember>& members, std::vector<StatementPtr>& calls) {
    for (const HandedMember& member : members) {
        ExpressionPtr asked = expression_of(Expression::Kind::Call, "displacement", member.at);
        add_child(*asked, Expression::Kind::Text, member.handed_name);
        add_child(*asked, Expression::Kind::Variable, member.name);
        calls.push_back(evaluate(std::move(asked)));
    }
}

}  // namespace

/// A class on its way into a shader.
struct Parser::ClassParts {
    struct Method {
        std::string name;
        StatementPtr place;  ///< where it is defined: an Empty
        SourceLocation at;
        std::vector<std::string_view> variables;           ///< that the body hands over
        size_t first = 0, last = 0;                        ///< tokens
        std::vector<std::unique_ptr<Function>> functions;  ///< itself behind those nested in it
        bool is_placed = false;
    };

    std::string name;
    SourceLocation at;
    std::vector<std::unique_ptr<Variable>> parameters;
    std::vector<StatementPtr> members;
    std::vector<Method> methods;
    std::map<std::string_view, std::vector<size_t>> numbers;  ///< of methods, by name

    const Method* find(std::string_view method) const {
        const auto found = std::ranges::find(methods, method, &Method::name);
        return found == methods.end() ? nullptr : &*found;
    }
    /// What its methods make of it: of several kinds the first, so that what shades and displaces shades.
    std::optional<ShaderKind> kind() const {
        for (const RendererMethod& method : kRendererMethods)
            if (method.kind && find(method.name)) return method.kind;
        return {};
    }
};

bool Parser::at_class() const {
    return at("class") && ahead(1).kind == Token::Kind::Name && (ahead(2).is("(") || ahead(2).is("{"));
}

/// class name ( parameters ) { members and methods }
/// One that displaces besides what else it does is read twice, and becomes two shaders of one name.
void Parser::class_definition() {
    const size_t first = next_;
    ClassParts parts = class_parts();
    const std::optional<ShaderKind> kind = parts.kind();
    if (!kind) {
        reporter_.error(parts.at, "class \"" + parts.name +
                                      "\" has no method surface, displacement, light, volume or imager: "
                                      "co-shaders of RSL 2 are not supported");
        return;
    }
    const bool displaces = *kind != ShaderKind::Displacement && parts.find("displacement");
    unit_->shaders.push_back(shader_of(std::move(parts), *kind));
    unit_->shaders.back()->displaces = displaces;
    if (!displaces || reporter_.failed()) return;
    next_ = first;
    skips_twins_ = true;
    unit_->shaders.push_back(shader_of(class_parts(), ShaderKind::Displacement));
    skips_twins_ = false;
}

Parser::ClassParts Parser::class_parts() {
    ClassParts parts;
    take();
    parts.at = now().at;
    parts.name = new_name("the class's name");
    if (accept("(")) {
        parts.parameters = formals(Variable::Kind::Parameter);
        expect(")", "after the parameters");
    }
    expect("{", "before the class's members");
    inside_ = parts.name;
    while (!at("}") && !at_end() && !reporter_.full()) {
        try {
            class_member(parts);
        } catch (const Lost&) {
            skip_statement();
        }
    }
    inside_.clear();
    expect("}", "after the class's members");
    return parts;
}

/// Who may use a member makes no difference where nobody else can.
void Parser::class_member(ClassParts& parts) {
    if (accept(";")) return;
    if (at_struct()) return struct_definition();
    while (at_any({"public", "private"}) && ahead(1).kind == Token::Kind::Name) take();
    const bool constant = at("constant") && ahead(1).kind == Token::Kind::Name;
    if (constant) take();
    if (at_function()) return class_method(parts);
    if (!at_specifier()) {
        refuse_rsl2();
        fail_expecting("a member or a method of the class");
    }
    StatementPtr members = declaration();
    for (const auto& variable : members->variables)
        if (constant) variable->storage = Storage::Uniform;
    parts.members.push_back(std::move(members));
}

/// A method that the renderer calls: its parameters named like the variables that they stand for are these.
void Parser::class_method(ClassParts& parts) {
    ClassParts::Method method;
    method.first = next_, method.at = now().at;
    const size_t before = unit_->functions.size();
    method.place = nested_function();
    method.last = next_;
    if (unit_->functions.size() == before) return;  // a prototype
    const auto added = unit_->functions.begin() + static_cast<std::ptrdiff_t>(before);
    std::move(added, unit_->functions.end(), std::back_inserter(method.functions));
    unit_->functions.erase(added, unit_->functions.end());
    Function& function = *method.functions.back();
    method.name = function.name;
    if (const RendererMethod* known = renderer_method(method.name)) {
        std::vector<std::unique_ptr<Variable>> others;
        for (size_t i = 0; i < function.parameters.size(); ++i) {
            const std::string_view stands_for = i < known->variables.size() ? known->variables[i] : "";
            if (std::ranges::find(known->variables, function.parameters[i]->name) != known->variables.end())
                continue;
            if (!stands_for.empty()) method.variables.push_back(stands_for);
            others.push_back(std::move(function.parameters[i]));
        }
        function.parameters = std::move(others);
    }
    parts.methods.push_back(std::move(method));
}

/// Methods may be called before they stand in the source: those that a method calls are put before it, and
/// those that nobody calls are left out. What calls itself in the end is for the analysis to report.
void Parser::place_method(ClassParts& parts, size_t number, int depth, std::vector<StatementPtr>& to) {
    ClassParts::Method& method = parts.methods[number];
    if (method.is_placed || depth > kDeepestNesting) return;
    method.is_placed = true;
    for (size_t i = method.first; i + 1 < method.last; ++i) {
        if (tokens_[i].kind != Token::Kind::Name || !tokens_[i + 1].is("(")) continue;
        const auto called = parts.numbers.find(tokens_[i].text);
        if (called == parts.numbers.end()) continue;
        // Once for a name, however often it is called: a stranger's class may have many methods of it.
        for (const size_t other : std::exchange(called->second, {}))
            place_method(parts, other, depth + 1, to);
    }
    to.push_back(std::move(method.place));
    std::ranges::move(method.functions, std::back_inserter(unit_->functions));
}

std::unique_ptr<Shader> Parser::shader_of(ClassParts parts, ShaderKind kind) {
    auto shader = std::make_unique<Shader>();
    shader->kind = kind, shader->name = parts.name, shader->at = parts.at;
    shader->of_class = true;
    shader->parameters = std::move(parts.parameters);
    shader->body = std::make_unique<Statement>();
    shader->body->kind = Statement::Kind::Block;
    shader->body->at = parts.at;
    std::vector<StatementPtr>& statements = shader->body->children;
    const ClassParts::Method* const displaces = parts.find("displacement");
    std::vector<HandedMember> handed;
    if (displaces && parts.kind() == ShaderKind::Surface)
        handed = handed_members(parts.name, shader->parameters, parts.members);
    for (StatementPtr& member : parts.members) statements.push_back(std::move(member));
    for (size_t i = 0; i < parts.methods.size(); ++i) parts.numbers[parts.methods[i].name].push_back(i);
    // Others, such as those that shade where this one displaces, may name what this kind does not have.
    std::vector<StatementPtr> calls;
    bool takes_over = kind == ShaderKind::Surface;
    for (const RendererMethod& called : kRendererMethods) {
        if (called.kind && std::exchange(takes_over, false)) take_over(handed, calls);
        const ClassParts::Method* const method = parts.find(called.name);
        if (!method || (called.kind && *called.kind != kind)) continue;
        const bool is_part = called.name == "lighting" || called.name == "postlighting";
        if (is_part && parts.find("surface")) continue;  // it does all of it
        place_method(parts, static_cast<size_t>(method - parts.methods.data()), 0, statements);
        calls.push_back(call_of(method->name, method->variables, method->at));
    }
    std::ranges::move(calls, std::back_inserter(statements));
    if (kind == ShaderKind::Displacement) hand_over(handed, *shader);
    return shader;
}

}  // namespace trapeze::rsl
