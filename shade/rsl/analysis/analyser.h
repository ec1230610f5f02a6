/// The analysis' state, shared by its parts: analyse.cpp has shaders, functions and names,
/// analyse_statements.cpp statements, possible_types.cpp the types that expressions can have,
/// choose_types.cpp those that they get, calls.cpp the choice of overloads.
///
/// In the shading language a call may mean a float or a colour according to what is wanted of it: noise(P) is
/// both. So expressions are walked twice: from the leaves up, for the types that each can have and what
/// conversions each would cost (Choices); then from the root down, where each gets the cheapest type that
/// serves. The second walk puts the casts into the tree.
#pragma once

#include <deque>
#include <map>
#include <set>
#include <unordered_map>

#include "shade/rsl/analysis/conversions.h"
#include "shade/rsl/analysis/signature.h"
#include "shade/rsl/syntax/ast.h"
#include "shade/rsl/syntax/reporter.h"

namespace trapeze::rsl {

/// Analyses a whole source. To be used once.
class Analyser {
  public:
    Analyser(TranslationUnit& unit, Reporter& reporter) : unit_(unit), reporter_(reporter) {}
    void run();

  private:
    /// A function as one shader uses it. It is `complete` when its body has been analysed: a call that meets
    /// it before is a recursion, which the language does not have.
    struct Instance {
        std::unique_ptr<Function> function;
        const Function* original = nullptr;
        bool complete = false;
        uint64_t operations = 0, array_floats = 0;  ///< with those of the functions it calls
        int depth = 0;                              ///< of its tree, likewise
    };
    /// What is declared between two braces, by name. Keys are views of the names in the tree, which outlives
    /// the analysis.
    struct Scope {
        std::unordered_map<std::string_view, Variable*> variables;
        std::unordered_map<std::string_view, std::vector<Instance*>> functions;
    };
    /// A shader or a function whose body is analysed.
    struct Body {
        Instance* instance = nullptr;               ///< null: the shader
        bool nested = false;                        ///< a function defined within the body below
        size_t first_scope = 0;                     ///< its outermost one, in scopes_
        int loops = 0;                              ///< around the statement that is analysed
        bool returns = false;                       ///< a return with a value was met
        int depth = 0;                              ///< of the statement that is analysed
        uint64_t operations = 0, array_floats = 0;  ///< with those of called functions
        uint64_t own_operations = 0;                ///< without those of called functions
        int deepest = 0;                            ///< the greatest depth met, called functions written out
        std::set<Variable*> written_parameters;     ///< not output, and assigned to
    };

    // Shaders, functions and names: analyse.cpp. Bodies nest as functions are entered from calls in the
    // middle of an expression; scopes of all of them are on one stack.
    void analyse_shader(Shader& shader);
    void analyse_body(Function& function);
    Instance* instance_of(const Function& original, bool nested, SourceLocation at);
    void finish_instance(Instance& instance);
    void copy_written_parameters(Function& function);
    void declare(Variable& variable);
    bool bind_external(const Variable& variable);
    void check_array(Variable& variable);
    void initial_value(Variable& variable);
    /// Look-ups return null for an unknown name and report nothing; unknown_variable() does that, with what
    /// was probably meant.
    Variable* find_variable(std::string_view name);
    Variable* find_outside(std::string_view name, size_t number);
    Variable* global(std::string_view name);
    void unknown_variable(const Expression& e);
    Body& body() { return bodies_.back(); }

    // Statements: analyse_statements.cpp. They are handed over by their pointers where one may be replaced by
    // another.
    void statement(StatementPtr& s);
    void scoped(StatementPtr& s);
    void block(Statement& s);
    void declaration(Statement& s);
    void declare_again(StatementPtr& s);
    void light_loop(Statement& s);
    void take_options(Statement& s, const std::string& word);
    bool is_for_lights(const Expression& option, const Expression& value, const std::string& word);
    void value_for_lights(const std::string& name, ExpressionPtr& e);
    void check_value_to_send(const std::string& word, const std::string& name, const Expression& e);
    bool is_for_hits(const Expression& name, const Expression& value);
    static StatementPtr message_of_light(const Expression& option, ExpressionPtr value);
    void gather(Statement& s);
    /// Names that rays do not know are warned of here, where they are constants: a run would find out only
    /// when a ray is sent.
    void check_ray_arguments(const Expression& call, const Signature& signature);
    void check_ray_argument(std::string_view call, SourceLocation at, const Expression& name,
                            const Expression& value);
    void jump(const Statement& s);
    void return_statement(Statement& s);
    void loop(Statement& s);
    /// An expression that stands by itself; of a type if that is not Void.
    void value(ExpressionPtr& e, Base wanted);
    void value_of_array(Variable& variable);

    /// The walk up. Each part looks at one kind of expression, reports what cannot be, and gives the types
    /// that the expression can have.
    Choices possible_types(Expression& e);
    Choices possible_types_within(Expression& e);
    Choices possible_types_once(Expression& e);
    Choices variable_types(Expression& e);
    Choices element_types(Expression& e);
    Choices binary_types(Expression& e);
    Choices conditional_types(Expression& e);
    Choices cast_types(Expression& e);
    Choices assignment_types(Expression& e);
    Choices component_assignment_types(Expression& e);
    Choices array_assignment_types(Expression& e);
    Choices tuple_types(Expression& e);
    Choices call_types(Expression& e);
    Choices choices_of(const Expression& e) const;
    /// Questions that choose between readings of one syntax; they report nothing.
    bool is_component(const Expression& e) const;
    /// Whether an expression names something that can be written to.
    bool is_place(const Expression& e) const;
    void check_index(const Expression& element);

    // What it becomes.
    /// The walk down. Each part settles Expression::type, and of calls the function, and puts the casts in.
    void choose_type(ExpressionPtr& e, Base wanted);
    void give_type(Expression& e, Base base);
    void choose_binary(Expression& e, Base base);
    void choose_cast(Expression& e);
    void choose_assignment(Expression& e);
    void choose_array_assignment(Expression& e);
    void choose_call(Expression& e, Base base);
    void choose_argument(Expression& call, size_t i, const Signature& signature);
    /// The only place where casts that the source does not name come into the tree.
    void convert(ExpressionPtr& e, Base to);
    void check_written(const Expression& place);
    /// Lets an array be resized, by a built-in function or by one that it is passed to as output.
    void resize(const Expression& array, bool by_builtin);

    // Calls.
    /// A cost of Choices::kNever says that the call does not fit.
    std::vector<Signature> candidates(const Expression& call);
    std::vector<int> costs_of(const std::vector<Signature>& all, const Expression& call) const;
    int cost_of(const Signature& signature, const Expression& call, bool as_they_are) const;
    int cost_of_argument(const Signature::Parameter& parameter, const Expression& argument) const;
    bool becomes_as_it_is(const Signature::Parameter& parameter, const Expression& argument) const;
    /// From here on: messages about calls that fit nothing, and what follows from one that fits.
    bool lacks_knots(const Expression& call);
    bool sets_distance(const Expression& call);
    /// Forms of other renderers: other_forms.cpp.
    void write_as_known(Expression& call);
    void write_output(Expression& call);
    // Parameters of functions that have values of their own: default_values.cpp.
    bool is_plain(const Expression& e) const;
    void check_defaults(Function& function);
    void put_in_order(Expression& call, const std::vector<Signature>& all);
    void add_defaults(Expression& call, const Signature& signature);
    void explain(std::vector<Signature> all, const Expression& call);
    void unknown_function(const Expression& call);
    void enter_function(Expression& call, const Function& original);
    void use_globals(const Expression& call);

    void error(SourceLocation at, std::string text) { reporter_.error(at, std::move(text)); }

    TranslationUnit& unit_;
    Reporter& reporter_;
    std::unordered_map<std::string_view, std::vector<const Function*>> file_functions_;
    std::vector<std::unique_ptr<Function>> kept_;  ///< instances of shaders that are done
    uint64_t copied_ = 0;                          ///< operations in all instances

    // What is known of the shader that is analysed now.
    Shader* shader_ = nullptr;
    std::map<const Function*, Instance*> file_instances_;  ///< of the file's functions, by the original
    std::deque<Instance> instances_;  ///< nested ones, too; a deque, since others point to them
    std::unordered_map<const Function*, Instance*> instance_of_copy_;  ///< by Instance::function
    /// Predefined variables that the shader has named so far; Shader::globals owns them.
    std::map<std::string, Variable*, std::less<>> globals_;
    std::deque<Scope> scopes_;                ///< of all bodies, the innermost last
    std::deque<Body> bodies_;                 ///< the shader's, then those of functions that are entered
    std::set<const Variable*> warned_;        ///< variables that were warned of, once each
    std::set<std::string_view> unavailable_;  ///< functions that were warned of
    int depth_ = 0;                           ///< of all frames together

    std::unordered_map<const Expression*, Choices> choices_;  ///< of the expression that is analysed
    const Expression* channel_ = nullptr;                     ///< may be a string with an index
    int height_ = 0;                                          ///< of the expression that is analysed
};

}  // namespace trapeze::rsl
