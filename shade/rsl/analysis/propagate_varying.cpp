#include "shade/rsl/analysis/propagate_varying.h"

#include <algorithm>
#include <set>
#include <tuple>
#include <unordered_map>
#include <unordered_set>

#include "shade/operations/op_table.h"
#include "shade/rsl/analysis/builtins.h"
#include "shade/rsl/analysis/signature.h"

namespace trapeze::rsl {
namespace {

// Walks after which no more is found out and all that is assigned to becomes varying: right, only slower to
// run. Each walk costs as much as the tree is large, and a chain of assignments written backwards through a
// loop needs one for each of its links.
constexpr int kMostPasses = 10;  // then all that may be varying is

/// An answer to a question: found or not, and the value in an output argument. Answers are taken to be the
/// same at all vertices here, as the language declares them; the machine sees to those that are not.
bool is_message(Op op) {
    return keeps_output(op) && asks_surroundings(op);
}

/// A value of a whole grid, which the language takes to be uniform. Several grids may be shaded together,
/// each with its own: for the machine it varies.
bool is_of_grid(Op op) {
    return op == Op::GridMin || op == Op::GridMax || op == Op::GridAverage;
}

/// Whether a value differs between vertices: not, only from grid to grid, or in a grid.
enum class Varies : uint8_t { No, ByGrid, Yes };

/// Whether a call's result differs between vertices even where all arguments are uniform: sums over lights,
/// since light is asked for at P, and texture() without coordinates, which reads at s and t.
bool is_varying(const Expression& call) {
    if (call.builtin->op == Op::Texture)
        return call.children.size() == 1 || call.children[1]->type.base == Base::String;
    return op_traits::has(call.builtin->op, op_traits::kNeedsP);
}

/// Whether a statement's children run once for each light. Only some vertices take part, but texts that are
/// set there are the light's, the same for all.
bool is_light_loop(const Statement& s) {
    return s.kind == Statement::Kind::Illuminance || s.kind == Statement::Kind::Illuminate ||
           s.kind == Statement::Kind::Solar;
}

/// Walks over the shader and its functions until nothing changes: a variable becomes varying when a varying
/// value is assigned to it, or any value where only some vertices take part.
///
/// Functions are shared by their calls, so a parameter is varying if it is at one of them.
class Propagation {
  public:
    Propagation(Shader& shader, const std::vector<Function*>& functions, Reporter& reporter)
        : shader_(shader), functions_(functions), reporter_(reporter) {}

    /// Until nothing changes, or kMostPasses. Variables only ever go from uniform to varying, so it ends.
    void run() {
        for (int pass = 0; pass < kMostPasses; ++pass) {
            changed_ = false;
            pass_over_all();
            if (!changed_) return;
        }
        // Very long chains of assignments: whatever is assigned to is varying.
        all_varying_ = true;
        for (int pass = 0; pass < 2; ++pass) pass_over_all();
    }

  private:
    /// What is known of a function from all that it returns and all places where it is called.
    struct Facts {
        Varies result = Varies::No;
        bool called_apart = false;  ///< where not all vertices take part
    };

    /// One walk over the shader and each function that it calls.
    void pass_over_all() {
        function_ = nullptr;
        depth_.clear();
        for (const auto& parameter : shader_.parameters) declare(*parameter, 0);
        enter_body(*shader_.body);
        for (const Function* function : functions_) {
            function_ = function;
            depth_.clear();
            for (const auto& parameter : function->parameters) depth_[parameter.get()] = 0;
            enter_body(*function->body);
        }
    }

    /// A body with an exit that only some vertices take is apart as a whole: behind the exit not all may run.
    /// What it declares itself is declared apart, too, and so need not vary for that.
    void enter_body(Statement& body) {
        exits_apart_.clear();
        statement(body, find_exits(body).apart ? 1 : 0);
    }

    // ---- Where control parts

    struct Exits {
        bool any = false;    ///< there is a break, continue or return
        bool apart = false;  ///< one that only some vertices take
    };

    /// What leaves the statement, from the leaves up. Statements with an exit that only some vertices take go
    /// into exits_apart_: a loop among them goes on for the others, which makes its turns apart.
    Exits find_exits(const Statement& s) {
        Exits exits;
        const bool jump = s.kind == Statement::Kind::Break || s.kind == Statement::Kind::Continue ||
                          s.kind == Statement::Kind::Return;
        exits.any = jump;
        for (const StatementPtr& child : s.children) {
            const Exits inner = find_exits(*child);
            exits.any = exits.any || inner.any;
            exits.apart = exits.apart || inner.apart;
        }
        if (exits.any && !jump && parts(s)) exits.apart = true;
        if (exits.apart) exits_apart_.insert(&s);
        return exits;
    }

    /// Whether only some vertices may do what is inside.
    bool parts(const Statement& s) const {
        switch (s.kind) {
            case Statement::Kind::If:
            case Statement::Kind::While:
                return varying(*s.expressions[0]);
            case Statement::Kind::For:
                return s.expressions[1] && varying(*s.expressions[1]);
            case Statement::Kind::Illuminance:
            case Statement::Kind::Illuminate:
            case Statement::Kind::Solar:
            case Statement::Kind::Gather:
                return true;
            default:
                return false;
        }
    }

    /// `apart`: in how many places control has parted on the way here.
    void statement(Statement& s, int apart) {
        const bool loop = s.kind == Statement::Kind::While || s.kind == Statement::Kind::For;
        const bool inside = parts(s) || (loop && exits_apart_.contains(&s));
        const int within = apart + (inside ? 1 : 0);
        // A loop's condition and step are run by the vertices that are still in it, a for's first part by
        // all.
        for (size_t i = 0; i < s.expressions.size(); ++i) {
            const bool each_turn = loop && !(s.kind == Statement::Kind::For && i == 0);
            if (s.expressions[i]) expression(*s.expressions[i], each_turn ? within : apart);
        }
        for (const auto& variable : s.variables) declare(*variable, apart);
        if (s.kind == Statement::Kind::Gather) gather_outputs(s, within);
        if (s.kind == Statement::Kind::Return && function_ && !s.expressions.empty())
            note(facts_[function_].result, apart > 0 ? Varies::Yes : varies(*s.expressions[0]));
        light_loops_ += is_light_loop(s);
        for (const StatementPtr& child : s.children) statement(*child, within);
        light_loops_ -= is_light_loop(s);
    }

    /// What rays bring back differs from vertex to vertex: the values of "surface:Ci" and its like.
    void gather_outputs(const Statement& s, int apart) {
        for (size_t i = 6; i < s.expressions.size(); i += 2)
            if (is_gather_output(*s.expressions[i - 1])) assign(*s.expressions[i], Varies::Yes, apart, false);
    }

    /// A variable is at home where it is declared: only assignments in places that are further apart make it
    /// varying. One that outlives its statement is at home outside.
    void declare(Variable& variable, int apart) {
        depth_[&variable] = variable.outlives ? 0 : apart;
        if (variable.type.base == Base::String) text_depth_[&variable] = depth_[&variable] - light_loops_;
        if (!variable.initial) return;
        if (variable.outlives && apart > 0) make_varying(variable, variable.at, false);
        expression(*variable.initial, apart);
        make_varying(variable, varies(*variable.initial), variable.at, true);
        if (all_varying_) make_varying(variable, variable.at, false);
    }

    // ---- Values

    Varies varies(const Expression& e) const {
        return !varying(e) ? Varies::No : varying(e, true) ? Varies::Yes : Varies::ByGrid;
    }

    /// Whether an expression may have different values at different vertices, as far as is known yet; with
    /// `in_grid`, at vertices of one grid.
    bool varying(const Expression& e, bool in_grid = false) const {
        if (e.type.base == Base::String) return false;
        switch (e.kind) {
            case Expression::Kind::Number:
            case Expression::Kind::Text:
                return false;
            case Expression::Kind::Variable:
                return e.variable && varying(*e.variable) && !(in_grid && of_grid_.contains(e.variable));
            case Expression::Kind::Call:
                if (e.builtin && is_varying(e)) return true;
                if (e.builtin && is_message(e.builtin->op)) return false;
                if (e.builtin && in_grid && is_of_grid(e.builtin->op)) return false;
                if (e.builtin && e.builtin->op == Op::ArrayLength && !e.children[0]->type.is_unsized())
                    return false;
                if (e.function) {
                    const auto facts = facts_.find(e.function);
                    const Varies result = facts == facts_.end() ? Varies::No : facts->second.result;
                    return all_varying_ || result > (in_grid ? Varies::ByGrid : Varies::No);
                }
                [[fallthrough]];
            default:
                for (const ExpressionPtr& child : e.children)
                    if (varying(*child, in_grid)) return true;
                return false;
        }
    }

    /// Strings are always uniform. An unspecified local is varying, an unspecified parameter of a function
    /// what its calls make it; those of output may be set to anything.
    bool varying(const Variable& variable) const {
        if (variable.type.base == Base::String) return false;
        if (variable.storage != Storage::Unspecified) return variable.storage == Storage::Varying;
        if (variable.kind != Variable::Kind::FunctionParameter) return true;
        return all_varying_ || variable.output || varying_parameters_.contains(&variable);
    }

    /// All that assigns within the expression, the innermost first.
    void expression(const Expression& e, int apart) {
        for (const ExpressionPtr& child : e.children) expression(*child, apart);
        if (e.type.base == Base::String) check_text(e);
        if (e.kind == Expression::Kind::Assignment)
            assign(*e.children[0], varies(*e.children[1]), apart, true);
        else if (e.kind == Expression::Kind::Call && e.function)
            call(e, apart);
        else if (e.kind == Expression::Kind::Call && e.builtin)
            builtin_outputs(e, apart);
    }

    /// Arguments that a built-in function sets are varying when any that it reads is.
    void builtin_outputs(const Expression& e, int apart) {
        const Signature signature = signature_of(*e.builtin);
        Varies given = Varies::No;
        for (size_t i = 0; i < e.children.size(); ++i)
            if (i >= signature.parameters.size() || !signature.parameters[i].output)
                given = std::max(given, varies(*e.children[i]));
        if (is_message(e.builtin->op)) given = Varies::No;
        for (size_t i = 0; i < std::min(e.children.size(), signature.parameters.size()); ++i)
            if (signature.parameters[i].output) assign(*e.children[i], given, apart, true);
        for (size_t i = signature.parameters.size() + 1; i < e.children.size(); i += 2)
            if (is_named_output(e, i)) assign(*e.children[i], Varies::Yes, apart, false);
    }

    /// Arguments make parameters varying, and parameters that are output their arguments. A call that is
    /// apart makes apart all that the function calls.
    void call(const Expression& e, int apart) {
        const bool outer_apart = function_ && facts_[function_].called_apart;
        note(facts_[e.function].called_apart, apart > 0 || outer_apart);
        for (size_t i = 0; i < e.children.size() && i < e.function->parameters.size(); ++i) {
            Variable& parameter = *e.function->parameters[i];
            const Expression& argument = *e.children[i];
            make_varying(parameter, all_varying_ ? Varies::Yes : varies(argument), argument.at,
                         !parameter.output && !all_varying_);
            if (parameter.output)
                assign(argument, varying(parameter) ? Varies::Yes : Varies::No, apart, false);
        }
    }

    /// A value, varying or not, goes to a variable or an element of one.
    void assign(const Expression& place, Varies value, int apart, bool warn) {
        const bool element = place.kind == Expression::Kind::Element;
        Variable* variable = element ? place.children[0]->variable : place.variable;
        if (!variable) return;
        const auto declared = depth_.find(variable);
        // A variable that this walk has not seen declared is the caller's: its value is apart from the
        // declaration if the assignment is, or if the whole function was called apart.
        const bool parted = declared != depth_.end()
                                ? apart > declared->second
                                : apart > 0 || (function_ && facts_[function_].called_apart);
        if (element) value = std::max(value, varies(*place.children[1]));
        if (variable->type.base == Base::String) return set_text(*variable, place.at, apart - light_loops_);
        if (all_varying_) warn = false;
        if (value == Varies::Yes || (value == Varies::ByGrid && !parted))
            return make_varying(*variable, value, place.at, warn);
        if (parted || all_varying_) make_varying(*variable, place.at, false);
    }

    /// Makes a variable varying if the value that it gets is. One of the whole grid is nothing to warn of.
    void make_varying(Variable& variable, Varies value, SourceLocation at, bool warn) {
        if (value == Varies::Yes) {
            if (of_grid_.erase(&variable)) {
                changed_ = true;
                if (warn && variable.storage != Storage::Unspecified) report(variable, at);
            }
            make_varying(variable, at, warn);
        } else if (value == Varies::ByGrid) {
            if (!varying(variable)) of_grid_.insert(&variable);
            make_varying(variable, at, false);
        }
    }

    void report(const Variable& variable, SourceLocation at) {
        reporter_.warning(
            at, "\"" + variable.name + "\" is uniform and gets a varying value: it becomes varying");
    }

    /// Makes a variable varying. With `warn`, warns where the source declares it uniform.
    void make_varying(Variable& variable, SourceLocation at, bool warn) {
        if (variable.type.base == Base::String || varying(variable)) return;
        changed_ = true;
        if (variable.storage == Storage::Unspecified) {
            varying_parameters_.insert(&variable);
            return;
        }
        if (warn) report(variable, at);
        variable.storage = Storage::Varying;
    }

    // ---- Texts, of which a batch of grids has one

    /// `apart` without loops over lights.
    void set_text(const Variable& text, SourceLocation at, int apart) {
        const auto declared = text_depth_.find(&text);
        if (apart > (declared != text_depth_.end() ? declared->second : 0))
            report_text(at, "\"" + text.name + "\" is a string, and set where only some vertices take part");
    }

    /// Whether a text may be another at other vertices.
    void check_text(const Expression& e) {
        // Behind the name of a texture an index is that of its channel, which may vary.
        const bool element = e.kind == Expression::Kind::Element && e.children[0]->type.is_array();
        const bool chosen = element || e.kind == Expression::Kind::Conditional;
        const size_t choice = element ? 1 : 0;
        if (chosen && varying(*e.children[choice]))
            return report_text(e.at, "a string is chosen by what varies");
        if (e.kind != Expression::Kind::Call || !e.builtin || e.builtin->op != Op::Format) return;
        for (const ExpressionPtr& child : e.children)
            if (varying(*child)) return report_text(e.at, "a string is made of what varies");
    }

    void report_text(SourceLocation at, const std::string& what) {
        if (told_of_texts_.emplace(at.source, at.line, at.column).second)
            reporter_.warning(at,
                              what + ": the first vertex of all that are shaded together decides for all");
    }

    /// Raises a fact, which is never lowered again.
    template <typename Fact>
    void note(Fact& fact, Fact value) {
        if (value <= fact) return;
        fact = value;
        changed_ = true;
    }

    Shader& shader_;
    const std::vector<Function*>& functions_;
    Reporter& reporter_;
    const Function* function_ = nullptr;  // whose body is looked at; null: the shader's
    std::unordered_map<const Function*, Facts> facts_;
    std::unordered_map<const Variable*, int> depth_;  // places where control had parted at the declaration
    std::unordered_set<const Variable*> varying_parameters_;
    std::unordered_set<const Variable*> of_grid_;  // that vary from grid to grid only
    std::unordered_set<const Statement*> exits_apart_;
    std::unordered_map<const Variable*, int> text_depth_;  // the same, without loops over lights
    std::set<std::tuple<uint32_t, uint32_t, uint32_t>> told_of_texts_;
    int light_loops_ = 0;  // around what is looked at
    bool changed_ = false, all_varying_ = false;
};

}  // namespace

void propagate_varying(Shader& shader, const std::vector<Function*>& functions, Reporter& reporter) {
    Propagation(shader, functions, reporter).run();
}

}  // namespace trapeze::rsl
