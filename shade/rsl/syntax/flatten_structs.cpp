#include "shade/rsl/syntax/flatten_structs.h"

#include <algorithm>
#include <iterator>
#include <optional>
#include <unordered_map>
#include <utility>

#include "shade/rsl/syntax/clone.h"
#include "shade/rsl/syntax/struct_pieces.h"

namespace trapeze::rsl {
namespace {

/// Variables and values that a file's structs may become: copies of large structs multiply.
constexpr size_t kMostPieces = 200'000;

/// A walk over the whole tree, with what names mean where it is.
class Flattener {
  public:
    Flattener(TranslationUnit& unit, Reporter& reporter) : unit_(unit), reporter_(reporter) {
        for (const auto& structure : unit.structs) structs_[structure->name] = structure.get();
        for (const auto& function : unit.functions) {
            functions_[function.get()] = function.get();
            if (function->result_structure) results_[function->name] = function->result_structure;
        }
    }

    void run() {
        // Functions that stand within others, or in shaders, are met there.
        for (const auto& f : unit_.functions)
            if (f->inside.empty()) function(*f);
        for (const auto& shader : unit_.shaders) {
            scopes_.emplace_back();
            for (const auto& parameter : shader->parameters) {
                if (parameter->structure) error(parameter->at, "a shader's parameter cannot be a struct");
                if (parameter->initial) expression(parameter->initial);
                declare(*parameter);
            }
            statement(*shader->body);
            scopes_.pop_back();
        }
    }

  private:
    /// What a variable's name means: null for what is no struct.
    struct Known {
        const Struct* structure = nullptr;
        Storage storage = Storage::Unspecified;
    };
    /// A variable of a struct, or a member that is one, with the storage of the whole variable.
    struct Place {
        std::string name;
        const Struct* structure;
        Storage storage;
    };

    void error(SourceLocation at, std::string text) { reporter_.error(at, std::move(text)); }

    /// The members of a struct; none once there are too many of all.
    std::vector<Leaf> leaves(const Struct& structure, SourceLocation at) {
        if (pieces_ > kMostPieces) return {};
        const std::vector<Leaf> all = leaves_of(structure);
        for (const Leaf& leaf : all)
            pieces_ += 1 + leaf.name.size() / 64 + static_cast<size_t>(std::max(leaf.member->type.length, 0));
        if (pieces_ > kMostPieces) error(at, "the structs of this file have too many members together");
        return all;
    }

    // ---- Names

    /// Of two structs the analysis says so.
    void declare(const Variable& variable) {
        const auto [known, is_new] = scopes_.back().try_emplace(variable.name);
        if (!is_new && (known->second.structure == nullptr) != (variable.structure == nullptr))
            reporter_.warning(variable.at, "\"" + variable.name.substr(0, 80) +
                                               "\" is declared twice: this one hides the other");
        known->second = {variable.structure, variable.storage};
    }

    Known find(const std::string& name) const {
        for (size_t i = scopes_.size(); i-- > 0;)
            if (const auto known = scopes_[i].find(name); known != scopes_[i].end()) return known->second;
        return {};
    }

    /// In a method what no variable hides means the struct's member of that name.
    const Variable* member_of_this(const std::string& name) const {
        if (!method_) return nullptr;
        for (const auto& scope : scopes_)
            if (scope.contains(name)) return nullptr;
        return method_->find(name);
    }

    /// The struct that an expression names; nothing for what is none. Members that there are not are
    /// reported.
    std::optional<Place> place(const Expression& e) {
        if (e.kind == Expression::Kind::Variable) {
            const Variable* own = member_of_this(e.text);
            const Known known = own ? Known{own->structure, Storage::Unspecified} : find(e.text);
            if (!known.structure) return {};
            return Place{own ? "this->" + e.text : e.text, known.structure, known.storage};
        }
        if (e.kind != Expression::Kind::Member) return {};
        const auto of = place(*e.children[0]);
        const Variable* member = of ? of->structure->find(e.text) : nullptr;
        if (!member || !member->structure) return {};
        return Place{of->name + "->" + e.text, member->structure, of->storage};
    }

    const Struct* constructed(const Expression& e) const {
        if (e.kind != Expression::Kind::Call) return nullptr;
        const auto known = structs_.find(e.text);
        return known == structs_.end() ? nullptr : known->second;
    }

    const Struct* returned(const Expression& e) const {
        if (e.kind != Expression::Kind::Call) return nullptr;
        const auto known = results_.find(e.text);
        return known == results_.end() ? nullptr : known->second;
    }

    // ---- Expressions

    void expression(ExpressionPtr& e) {
        resolve_method(*e);
        if (e->kind == Expression::Kind::Member) return member(e);
        if (place(*e))
            return error(e->at, "\"" + e->text + "\" is a struct; one of its members is wanted here");
        if (constructed(*e) || returned(*e))
            return error(e->at, "a struct is made here, which goes to a variable or a function only");
        if (e->kind == Expression::Kind::Variable && member_of_this(e->text)) e->text = "this->" + e->text;
        if (e->kind != Expression::Kind::Call) {
            for (ExpressionPtr& child : e->children) expression(child);
            return;
        }
        std::vector<ExpressionPtr> arguments = std::exchange(e->children, {});
        for (ExpressionPtr& argument : arguments) this->argument(std::move(argument), e->children);
    }

    /// A call of a method becomes one of its function, with the struct's members in front of the arguments.
    void resolve_method(Expression& e) {
        if (e.kind != Expression::Kind::Call) return;
        const size_t colons = e.text.find("::");
        const bool of_variable = e.text.starts_with("->");
        std::string name = of_variable ? e.text.substr(2) : e.text, object = "this";
        const Struct* structure = method_;
        if (of_variable) {
            const auto named = place(*e.children[0]);
            e.children.erase(e.children.begin());
            if (!named) {
                e.text = name;
                return error(e.at, "methods are called of structs; co-shaders of RSL 2 are not supported");
            }
            object = named->name, structure = named->structure;
        } else if (colons != std::string::npos) {
            const std::string base = name.substr(0, colons);
            name = name.substr(colons + 2);
            while (structure && structure->name != base) structure = structure->base;
        }
        const Struct* owner = method_owner(structure, name);
        if (!owner) {
            if (of_variable || colons != std::string::npos)
                error(e.at, "there is no method \"" + name.substr(0, 80) + "\" of this struct");
            return;
        }
        e.text = owner->name + "->" + name;
        std::vector<ExpressionPtr> arguments = std::exchange(e.children, {});
        for (const Leaf& leaf : leaves(*owner, e.at))
            e.children.push_back(new_expression(Expression::Kind::Variable, object + leaf.name, e.at));
        std::move(arguments.begin(), arguments.end(), std::back_inserter(e.children));
        e.height = std::max<uint16_t>(e.height, 2);
    }

    void member(ExpressionPtr& e) {
        const auto of = place(*e->children[0]);
        if (!of) {
            // What is wrong may stand further left.
            ExpressionPtr& left = e->children[0];
            if (left->kind == Expression::Kind::Member) member(left);
            if (left->kind == Expression::Kind::Member) return;
            return error(e->at, "\"->\" stands behind variables that are structs");
        }
        const Variable* found = of->structure->find(e->text);
        if (!found)
            return error(e->at, "struct \"" + of->structure->name + "\" has no member \"" +
                                    e->text.substr(0, 80) + "\"");
        if (found->structure)
            return error(e->at, "\"" + of->name + "->" + e->text +
                                    "\" is a struct; one of its members is wanted here");
        e = new_expression(Expression::Kind::Variable, of->name + "->" + e->text, e->at);
    }

    /// Structs become as many arguments as they have members.
    void argument(ExpressionPtr e, std::vector<ExpressionPtr>& to) {
        resolve_method(*e);
        const auto named = place(*e);
        const Struct* structure = named ? named->structure : constructed(*e);
        if (!structure) {
            expression(e);
            to.push_back(std::move(e));
            return;
        }
        const SourceLocation at = e->at;
        std::vector<ExpressionPtr> all = values(std::move(e), *structure, at);
        std::move(all.begin(), all.end(), std::back_inserter(to));
    }

    /// The values of a struct's members, in the order of leaves(): of a variable, or of what a constructor is
    /// given, the rest by default.
    std::vector<ExpressionPtr> values(ExpressionPtr e, const Struct& wanted, SourceLocation at) {
        std::vector<ExpressionPtr> all;
        if (const auto named = place(*e)) {
            if (named->structure != &wanted) return mismatch(wanted, *named->structure, e->at);
            for (const Leaf& leaf : leaves(wanted, at))
                all.push_back(new_expression(Expression::Kind::Variable, named->name + leaf.name, at));
            return all;
        }
        const Struct* made = constructed(*e);
        if (made != &wanted) {
            if (made) return mismatch(wanted, *made, e->at);
            error(e->at, "a struct \"" + wanted.name + "\" is wanted here");
            return all;
        }
        std::vector<ExpressionPtr> given = given_to(*e, wanted, reporter_);
        for (size_t i = 0; i < wanted.members.size(); ++i) {
            const Variable& member = *wanted.members[i];
            if (member.structure) {
                ExpressionPtr inner =
                    given[i] ? std::move(given[i])
                             : new_expression(Expression::Kind::Call, member.structure->name, at);
                std::vector<ExpressionPtr> parts = values(std::move(inner), *member.structure, at);
                std::move(parts.begin(), parts.end(), std::back_inserter(all));
                continue;
            }
            pieces_ += 1 + static_cast<size_t>(std::max(member.type.length, 0));
            if (pieces_ > kMostPieces) {
                error(at, "the structs of this file have too many members together");
                return {};
            }
            if (given[i]) expression(given[i]);
            if (!given[i]) given[i] = member.initial ? clone(member.initial) : nothing_in(member, at);
            all.push_back(std::move(given[i]));
        }
        return all;
    }

    std::vector<ExpressionPtr> mismatch(const Struct& wanted, const Struct& given, SourceLocation at) {
        error(at, "this is a struct \"" + given.name + "\", a \"" + wanted.name + "\" is wanted");
        return {};
    }

    // ---- Statements

    void statement(Statement& s) {
        if (reporter_.full() || pieces_ > kMostPieces) return;
        switch (s.kind) {
            case Statement::Kind::Declare:
                return declaration(s);
            case Statement::Kind::Evaluate:
                return evaluation(s);
            case Statement::Kind::Return:
                return return_statement(s);
            case Statement::Kind::Empty:
                // A nested function sees what stands around it.
                if (const auto known = functions_.find(s.defines); known != functions_.end())
                    function(*known->second);
                return;
            default:
                break;
        }
        for (ExpressionPtr& e : s.expressions)
            if (e) expression(e);
        const bool own_scope = s.kind == Statement::Kind::Block && !s.open;
        if (own_scope) scopes_.emplace_back();
        for (StatementPtr& child : s.children) statement(*child);
        if (own_scope) scopes_.pop_back();
    }

    /// One after the other, in an open block where a function makes a value.
    void declaration(Statement& s) {
        auto variables = std::exchange(s.variables, {});
        std::vector<StatementPtr> all;
        all.push_back(new_statement(Statement::Kind::Declare, s.at));
        for (auto& variable : variables) {
            if (!variable->structure) {
                if (variable->initial) expression(variable->initial);
                declare(*variable);
                all.back()->variables.push_back(std::move(variable));
                continue;
            }
            ExpressionPtr initial = std::move(variable->initial);
            StatementPtr call;
            if (initial) resolve_method(*initial);
            if (initial && returned(*initial))
                call = call_into(variable->name, *variable->structure, *initial);
            if (call) initial.reset();
            std::vector<ExpressionPtr> given;
            if (initial) given = values(std::move(initial), *variable->structure, variable->at);
            add_members(*variable, std::move(given), all.back()->variables);
            declare(*variable);
            if (!call) continue;
            all.push_back(std::move(call));
            all.push_back(new_statement(Statement::Kind::Declare, s.at));
        }
        if (all.size() == 1) {
            s.variables = std::move(all[0]->variables);
            return;
        }
        s.kind = Statement::Kind::Block, s.open = true;
        s.children = std::move(all);
    }

    /// Declares a variable's members, with these values, or by default.
    void add_members(const Variable& variable, std::vector<ExpressionPtr> given,
                     std::vector<std::unique_ptr<Variable>>& to) {
        const Struct& structure = *variable.structure;
        const std::vector<Leaf> all = leaves(structure, variable.at);
        for (size_t i = 0; i < all.size(); ++i) {
            auto member = std::make_unique<Variable>();
            member->name = variable.name + all[i].name;
            member->type = all[i].member->type;
            member->storage =
                variable.storage != Storage::Unspecified ? variable.storage : all[i].member->storage;
            member->kind = variable.kind, member->at = variable.at;
            member->output = variable.output, member->external = variable.external;
            // Arguments make parameters what they are; members of output are what their struct says.
            const bool is_parameter = variable.kind == Variable::Kind::FunctionParameter;
            if (is_parameter && !variable.output) member->storage = variable.storage;
            if (i < given.size())
                member->initial = std::move(given[i]);
            else if (!is_parameter && !variable.external)
                member->initial = clone(all[i].member->initial);
            to.push_back(std::move(member));
        }
    }

    /// f(members of the variable, arguments): what returns a struct sets the members of one.
    StatementPtr call_into(const std::string& variable, const Struct& structure, Expression& call) {
        const Struct* result = returned(call);
        if (result != &structure) mismatch(structure, *result, call.at);
        ExpressionPtr e = new_expression(Expression::Kind::Call, call.text, call.at);
        e->height = call.height;
        for (const Leaf& leaf : leaves(structure, call.at))
            e->children.push_back(new_expression(Expression::Kind::Variable, variable + leaf.name, call.at));
        for (ExpressionPtr& argument : call.children) this->argument(std::move(argument), e->children);
        if (!e->children.empty()) e->height = std::max<uint16_t>(e->height, 2);
        StatementPtr s = new_statement(Statement::Kind::Evaluate, call.at);
        s->expressions.push_back(std::move(e));
        return s;
    }

    /// to = value, for all members. What is made from members of the same variable is complete before any of
    /// them is set.
    void assign(Statement& s, const Place& to, ExpressionPtr value) {
        const SourceLocation at = value->at;
        const Struct& structure = *to.structure;
        resolve_method(*value);
        s.expressions.clear();
        s.kind = Statement::Kind::Block, s.open = false;
        Variable temporary;
        temporary.name = "(" + structure.name + ")", temporary.structure = &structure, temporary.at = at;
        temporary.storage = to.storage;
        const std::vector<Leaf> all = leaves(structure, at);
        std::vector<ExpressionPtr> parts;
        StatementPtr declare = new_statement(Statement::Kind::Declare, at), call;
        if (returned(*value))
            call = call_into(temporary.name, structure, *value);
        else
            parts = values(std::move(value), structure, at);
        const std::string root = to.name.substr(0, to.name.find("->"));
        const bool is_apart = !call && std::ranges::none_of(parts, [&](const ExpressionPtr& part) {
            return names_any(*part, root + "->");
        });
        if (!is_apart) {
            add_members(temporary, std::exchange(parts, {}), declare->variables);
            s.children.push_back(std::move(declare));
            if (call) s.children.push_back(std::move(call));
            for (const Leaf& leaf : all)
                parts.push_back(new_expression(Expression::Kind::Variable, temporary.name + leaf.name, at));
        }
        for (size_t i = 0; i < std::min(all.size(), parts.size()); ++i)
            s.children.push_back(assignment_of(to.name + all[i].name, std::move(parts[i]), at));
    }

    void evaluation(Statement& s) {
        ExpressionPtr& e = s.expressions[0];
        if (e->kind == Expression::Kind::Assignment) {
            if (const auto to = place(*e->children[0])) {
                if (e->op != Operator::None) return error(e->at, "structs are assigned by \"=\" only");
                return assign(s, *to, std::move(e->children[1]));
            }
        }
        resolve_method(*e);
        // What it returns is not wanted.
        if (const Struct* structure = returned(*e)) return assign_to_nothing(s, *structure);
        expression(e);
    }

    void assign_to_nothing(Statement& s, const Struct& structure) {
        const ExpressionPtr call = std::move(s.expressions[0]);
        const std::string to = "(" + structure.name + ")";
        Variable temporary;
        temporary.name = to, temporary.structure = &structure, temporary.at = call->at;
        s.expressions.clear();
        s.kind = Statement::Kind::Block;
        s.children.push_back(new_statement(Statement::Kind::Declare, call->at));
        add_members(temporary, {}, s.children.back()->variables);
        s.children.push_back(call_into(to, structure, *call));
    }

    void return_statement(Statement& s) {
        if (!result_ || s.expressions.empty()) {
            for (ExpressionPtr& e : s.expressions) expression(e);
            return;
        }
        ExpressionPtr value = std::move(s.expressions[0]);
        s.expressions.clear();
        resolve_method(*value);
        StatementPtr inner = new_statement(Statement::Kind::Block, s.at);
        if (returned(*value))
            inner = call_into(kResult, *result_, *value);
        else
            assign(*inner, {kResult, result_, Storage::Unspecified}, std::move(value));
        s.kind = Statement::Kind::Block;
        s.children.push_back(std::move(inner));
        s.children.push_back(new_statement(Statement::Kind::Return, s.at));
    }

    /// A struct that is returned, and that whose method it is, stand in front of the parameters, as output.
    void function(Function& f) {
        const Struct* const outer = std::exchange(result_, f.result_structure);
        const Struct* const outer_method = method_;
        if (f.inside.empty()) method_ = f.method_of;
        scopes_.emplace_back();
        std::vector<std::unique_ptr<Variable>> parameters;
        if (result_) {
            Variable result;
            result.name = kResult, result.structure = result_, result.at = f.at;
            result.kind = Variable::Kind::FunctionParameter, result.output = true;
            add_members(result, {}, parameters);
        }
        if (f.method_of) {
            Variable self;
            self.name = "this", self.structure = f.method_of, self.at = f.at;
            self.kind = Variable::Kind::FunctionParameter, self.output = true;
            add_members(self, {}, parameters);
            declare(self);
        }
        f.hidden = parameters.size();
        for (auto& parameter : f.parameters) {
            declare(*parameter);
            if (parameter->structure && parameter->initial)
                reporter_.warning(parameter->at, "default values of structs are ignored here");
            if (parameter->structure)
                add_members(*parameter, {}, parameters);
            else
                parameters.push_back(std::move(parameter));
        }
        // Names in scopes_ are copies, and need the variables no longer.
        f.parameters = std::move(parameters);
        f.result_structure = nullptr, f.method_of = nullptr;
        statement(*f.body);
        scopes_.pop_back();
        result_ = outer, method_ = outer_method;
    }

    static constexpr const char* kResult = "(returned)";

    TranslationUnit& unit_;
    Reporter& reporter_;
    std::unordered_map<std::string, const Struct*> structs_;
    std::unordered_map<const Function*, Function*> functions_;
    std::unordered_map<std::string, const Struct*> results_;  ///< of functions, by name
    std::vector<std::unordered_map<std::string, Known>> scopes_;
    const Struct* method_ = nullptr;  ///< whose method is looked at
    const Struct* result_ = nullptr;  ///< of the function that is looked at
    size_t pieces_ = 0;
};

}  // namespace

void flatten_structs(TranslationUnit& unit, Reporter& reporter) {
    if (!unit.structs.empty()) Flattener(unit, reporter).run();
}

}  // namespace trapeze::rsl
