/// The state of code generation; the work is in generate_expressions.cpp, generate_calls.cpp,
/// generate_arrays.cpp and generate_statements.cpp.
///
/// Every expression becomes instructions that leave its value in a register. A caller that has a place for
/// the value passes it as `into`, which saves a Move for each assignment; without one the value is where it
/// happens to be, in a variable's own register or a temporary. Such a register must not be written to.
#pragma once

#include <map>
#include <optional>
#include <span>
#include <unordered_map>
#include <utility>

#include "shade/code/generate.h"
#include "shade/rsl/analysis/builtins.h"

namespace trapeze::rsl {

/// Whether a body returns anywhere but at its end.
bool contains_early_return(const Statement& body);
/// Whether a body's last statement is a return.
bool ends_with_return(const Statement& body);
/// Whether a body may change a variable.
bool assigns(const Statement& body, const Variable& variable);

/// Makes the program of one shader. To be used once. Functions are written out at their calls by generating
/// their bodies again, with locals_ saying which registers their parameters are at the time.
class Generator {
  public:
    Generator(const Shader& shader, Diagnostics& diagnostics) : shader_(shader), diagnostics_(diagnostics) {}
    /// To be called once: the program is handed over.
    std::unique_ptr<Program> run();

  private:
    using Ids = std::vector<RegisterId>;
    /// Thrown once an error has been reported that makes going on useless.
    struct TooLarge {};

    // Registers.
    RegisterId add_register(Register::Kind kind, Type type, std::string name = {});
    /// A register that no variable has; memory is shared among those that are not in use together, later
    /// (vm/plane_slots).
    RegisterId temporary(Base base) { return add_register(Register::Kind::Temporary, {base, 0}); }
    /// Registers of constants, predefined variables and variables are shared by all that name the same.
    RegisterId constant(float value);
    RegisterId constant_text(const std::string& text);
    RegisterId global(std::string_view name, Base base);
    RegisterId register_of(const Variable& variable);
    Base base_of(RegisterId id) const { return program_->reg(id).type.base; }

    /// Instructions. All instructions are made here, and counted. The reference holds until the next one is.
    Instruction& emit(Op op, Ids outputs, const Ids& inputs, int32_t immediate = 0);
    /// Into `into`, or a new temporary.
    RegisterId compute(Op op, Base base, const Ids& inputs, std::optional<RegisterId> into = {});
    /// Blocks are opened and closed in pairs, and each open() begins a region.
    void open(Op op, Ids outputs, const Ids& inputs);
    void turn_to_else(RegisterId decision);
    void close(Op op);

    // Expressions: the register that holds the value, which is `into` when given.
    RegisterId value(const Expression& e, std::optional<RegisterId> into = {});
    RegisterId number_value(const Expression& e, std::optional<RegisterId> into);
    RegisterId binary_value(const Expression& e, std::optional<RegisterId> into);
    RegisterId conditional_value(const Expression& e, std::optional<RegisterId> into);
    RegisterId cast_value(const Expression& e, std::optional<RegisterId> into);
    RegisterId assignment_value(const Expression& e);
    RegisterId combined(Operator op, Base base, RegisterId a, RegisterId b, std::optional<RegisterId> into);
    /// Without `into` nothing is moved, and the result may be a variable's register: not to be written to.
    RegisterId moved(RegisterId from, Base base, std::optional<RegisterId> into);

    // Arrays, of a length in their type or not: generate_arrays.cpp.
    void add_counts(RegisterId array);
    RegisterId count_of(RegisterId array);
    RegisterId element(RegisterId array, Base base, RegisterId index, std::optional<RegisterId> into);
    void set_element(RegisterId array, RegisterId index, RegisterId value);
    void push(RegisterId array, RegisterId value);
    void copy_array(RegisterId from, RegisterId to, Base base);
    void assign_list(const Expression& list, RegisterId array);
    RegisterId array_value(const Expression& e, std::optional<RegisterId> into);
    std::optional<RegisterId> array_spline(const Expression& e, std::optional<RegisterId> into);

    // Calls: generate_calls.cpp. The analysis has chosen the overload and converted the arguments.
    RegisterId call_value(const Expression& e, std::optional<RegisterId> into);
    RegisterId builtin_value(const Expression& e, std::optional<RegisterId> into);
    RegisterId surface_parameter(std::string_view name, std::string_view hidden_name);
    void add_unnamed_inputs(Op op, Ids& inputs);
    std::optional<RegisterId> rewritten_builtin(const Expression& e, std::optional<RegisterId> into);
    RegisterId set_part(const Expression& e);
    RegisterId chain_value(const Expression& e, std::optional<RegisterId> into);
    RegisterId named_matrix(const Expression* from, const Expression& to);
    RegisterId named_transform_value(const Expression& e, std::optional<RegisterId> into);
    RegisterId map_value(const Expression& e, std::optional<RegisterId> into);
    RegisterId function_value(const Expression& e);
    RegisterId inline_body(const Function& function, Base result);
    /// A place for an output argument, and what must be done to it afterwards if it is an array's element.
    RegisterId output_place(const Expression& argument, Base base);
    /// Puts an output into the element of an array that was passed for it; nothing to do for variables, which
    /// are passed by their registers.
    void write_back(const Expression& argument, RegisterId value);

    // Statements: generate_statements.cpp. Each appends to code_ and leaves no value.
    void statement(const Statement& s);
    void declare(const Statement& s);
    void declare_outliving(const Statement& s);
    void clear(RegisterId id);
    void initialise(RegisterId id, const Variable& variable);
    void if_statement(const Statement& s);
    void loop_statement(const Statement& s);
    void insert(size_t at, Op op, const Ids& operands, uint32_t region);
    size_t begin_loop();
    void end_loop(size_t opening);
    void add_turns(Ids& inputs);
    void count_turn(uint32_t region, size_t at);
    void light_block(const Statement& s);
    void option_for_lights(const Expression& name, const Expression& argument, Ids& inputs);
    void warn_of_growing(const char* word, const Expression& name, const Expression& argument);
    void keep_inputs(size_t opening);
    void gather_statement(const Statement& s);
    void return_statement(const Statement& s);
    RegisterId condition(const Expression& e);
    void add_parameters();
    void copy_written_globals();

    const Shader& shader_;
    Diagnostics& diagnostics_;
    std::unique_ptr<Program> program_;
    Code* code_ = nullptr;          ///< where instructions go
    size_t instruction_count_ = 0;  ///< in all pieces of code, for kMaxInstructions
    SourceLocation at_;             ///< of what is being translated; goes into each instruction
    uint32_t region_ = 0, last_region_ = 0;
    std::vector<uint32_t> open_regions_;                      ///< regions around region_, the outermost first
    std::unordered_map<const Variable*, RegisterId> locals_;  ///< of locals and functions' parameters now
    std::map<std::string, RegisterId, std::less<>> by_name_;  ///< globals and parameters
    std::map<float, RegisterId> numbers_;
    std::map<std::string, RegisterId> texts_;
    int call_depth_ = 0;
    int light_loops_ = 0;       ///< illuminance blocks around what is being generated
    int32_t random_calls_ = 0;  ///< numbers the calls of random(), so that no two give the same
    /// A loop around what is being generated, but not one over lights: random() asks in which turn it is, by
    /// a register of the region outside, which is there once somebody has asked.
    struct Turns {
        uint32_t outside = 0;
        std::optional<RegisterId> number;
    };
    std::vector<Turns> turns_;
    bool for_uniform_ = false;  ///< what is being computed goes to a uniform variable
    /// Of the function (or shader) whose body is being generated.
    struct Body {
        std::optional<RegisterId> result;
        bool in_scope = false;  ///< a return jumps
    };
    Body body_;

    /// While it lives, what is computed goes to a variable of this storage.
    class ForUniform {
      public:
        ForUniform(Generator& generator, Storage storage)
            : flag_(generator.for_uniform_), before_(std::exchange(flag_, storage == Storage::Uniform)) {}
        ~ForUniform() { flag_ = before_; }
        ForUniform(const ForUniform&) = delete;

      private:
        bool& flag_;
        bool before_;
    };
};

}  // namespace trapeze::rsl
