/// The shading language's syntax tree, as the parser makes it and the analysis completes it.
///
/// The analysis resolves names and overloads, checks types, and makes every conversion explicit as a Cast
/// with `implicit` set, so that code generation meets only operands of the types that operators want. The
/// printer leaves such casts out. A float beside a triple in + - * / stays a float, as the machine's
/// operations by component take it; points, vectors and normals stand for each other without a cast inside
/// operators.
#pragma once

#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "core/diagnostics.h"
#include "shade/rsl/syntax/type.h"

namespace trapeze::rsl {

struct Builtin;   // builtins.h
struct Function;  // below
struct Struct;    // below
struct Expression;
struct Statement;
using ExpressionPtr = std::unique_ptr<Expression>;
using StatementPtr = std::unique_ptr<Statement>;

/// Operators of Expression::op. The order is relied on: comparisons by size stand together (combined() of
/// code generation), and text_of() has its marks in it.
enum class Operator : uint8_t {
    None,
    Add,
    Subtract,
    Multiply,
    Divide,
    Dot,    ///< a . b
    Cross,  ///< a ^ b
    Less,
    LessEqual,
    Greater,
    GreaterEqual,
    Equal,
    NotEqual,
    And,
    Or,
    Negate,
    Not,
};

/// A variable. There is one object for each declaration, and every expression that names it points to it.
struct Variable {
    enum class Kind : uint8_t { Global, Parameter, Local, FunctionParameter };
    std::string name;
    Type type;
    Storage storage = Storage::Unspecified;
    Kind kind = Kind::Local;
    const Struct* structure = nullptr;  ///< of a struct: `type` says nothing (flatten_structs.h)
    bool output = false;                ///< a shader's output parameter, or a function's
    /// Names a variable of outside (`extern`). The analysis takes such declarations out of the tree.
    bool external = false;
    /// Declared in a statement without braces (`if (a) float x = 1;`): it lives on behind that, where it was
    /// 0 before.
    bool outlives = false;
    /// An array whose length is only that of its first values: it gets none of its own once something resizes
    /// it.
    bool growable = false;
    bool copied = false;  ///< a predefined variable that is only read, yet assigned to: the shader has a copy
    ExpressionPtr initial;  ///< default or initial value; may be null. An array's is a List.
    SourceLocation at;
};

/// Bounds of the tree's height, so that passes may recurse: one expression's, and how deep statements and
/// expressions in parentheses nest.
inline constexpr int kHighestExpression = 400;
inline constexpr int kDeepestNesting = 256;
/// Elements of an array; floats in one, and in all of a shader's with its functions in place of their calls.
inline constexpr int kLongestArray = 65536;
inline constexpr int kMostArrayFloats = 65536;
inline constexpr int kMostArrayFloatsTogether = 4 * kMostArrayFloats;
/// Floats that an array of no length of its own counts for, so that there are not too many of them.
inline constexpr int kFloatsOfUnsized = 64;
/// Members of a struct with those of structs in it, and how deep these may nest.
inline constexpr int kMostMembers = 1024;
inline constexpr int kDeepestStruct = 16;
/// Code generation recurses through statements, expressions and calls alike; this many fit on any thread's
/// stack.
inline constexpr int kDeepestInlined = 1500;
/// Operations of one shader with its functions written out: functions that call functions multiply.
inline constexpr int kMostInlined = 1000000;

/// A value. Which of the fields mean something depends on the kind; `type` is what the analysis decided on.
struct Expression {
    enum class Kind : uint8_t {
        Number,
        Text,         ///< a string
        Variable,     ///< `variable`
        Element,      ///< children: array, index. On a texture function's name: its channel
        Unary,        ///< `op` of child 0
        Binary,       ///< `op`
        Conditional,  ///< children: condition, then, else
        Triple,       ///< (a, b, c); its base type comes from where it stands
        Sixteen,      ///< a matrix of 16 floats
        List,         ///< {a, b, ...}: an array's initial value
        Cast,         ///< child 0 to `type`, from the space `text` when it is not empty
        Call,         ///< children are the arguments, in order, named optional ones included. Of a method
               ///< "->name", behind the struct; "struct::name" in methods of those that have it as base
        Assignment,  ///< child 0 becomes child 1, or (`op`) child 0 op child 1
        Member,      ///< child 0 -> `text`: of a struct, none are left for the analysis
    };
    Kind kind = Kind::Number;
    Operator op = Operator::None;
    bool implicit = false;  ///< a conversion that the source does not name; of a Call: its arguments have
                            ///< been put in order
    bool repeats = false;   ///< of a List: "..." ends it, and its last value is that of all elements behind
    float number = 0;
    std::string text;  ///< a Text's value, a name as written, a Cast's space
    std::vector<ExpressionPtr> children;
    SourceLocation at;
    uint16_t height = 1;  ///< of this tree, at most kHighestExpression

    // Set by the analysis.
    Type type;
    Variable* variable = nullptr;        ///< of a Variable
    const Builtin* builtin = nullptr;    ///< of a Call: the chosen overload...
    const Function* function = nullptr;  ///< ... or the user's function
};

/// Something to do. Children are statements within it, expressions those of its head, in the order given
/// here.
struct Statement {
    enum class Kind : uint8_t {
        Block,        ///< children
        Declare,      ///< variables
        Evaluate,     ///< expression 0
        If,           ///< expression 0; children: then, else (if there is one)
        While,        ///< expression 0; child 0
        For,          ///< expressions: initial, condition, step (each may be null), further steps; child 0
        Illuminance,  ///< expressions: [category,] position [, axis, angle], `named` ones; child 0
        Illuminate,   ///< expressions: position [, axis, angle]; child 0
        Solar,        ///< expressions: [axis, angle]; child 0
        Gather,       ///< expressions: the arguments; children: body, else (if there is one)
        Break,        ///< out of `levels` loops
        Continue,     ///< on with the `levels`-th loop out
        Return,       ///< expression 0, if there is one
        Empty,        ///< nothing; or where the function `defines` was written
    };
    Kind kind = Kind::Empty;
    int levels = 1;
    bool open = false;  ///< of a Block: no braces, and no scope, of its own
    size_t named = 0;   ///< of an Illuminance: expressions at the end that are names and values in turn
    std::vector<ExpressionPtr> expressions;
    std::vector<StatementPtr> children;
    std::vector<std::unique_ptr<Variable>> variables;
    const Function* defines = nullptr;  ///< of an Empty: the nested function that was written here
    SourceLocation at;
};

/// What stands in front of a parameter's name where illuminance gives lights a value for it.
inline constexpr std::string_view kSendToLight = "send:light:";

/// Whether gather() sets the variable that follows a name: "surface:Ci" and its like bring something back.
/// "send:..." goes to the shaders that rays hit.
inline bool is_gather_output(const Expression& name) {
    return name.kind == Expression::Kind::Text && name.text.find(':') != std::string::npos &&
           !name.text.starts_with("send:");
}

/// A struct of RSL 2. Values of its members are defaults; members that are structs have been defined before.
struct Struct {
    std::string name;
    const Struct* base = nullptr;  ///< its members are the first of this one's
    std::vector<std::unique_ptr<Variable>> members;
    /// Names of its own; the functions are the file's, by the name "struct->method".
    std::vector<std::string> methods;
    int pieces = 0;  ///< members with those of structs in it
    int depth = 1;   ///< of structs in structs
    SourceLocation at;

    const Variable* find(std::string_view member) const {
        for (const auto& variable : members)
            if (variable->name == member) return variable.get();
        return nullptr;
    }
};

/// A function of the source's own. Its parameters are references to the caller's variables (RISpec 3.2,
/// section 16.1).
struct Function {
    std::string name;
    Type result;
    const Struct* result_structure = nullptr;  ///< it returns a struct: `result` says nothing
    const Struct* method_of = nullptr;         ///< its members are known by their names alone
    std::vector<std::unique_ptr<Variable>> parameters;
    size_t hidden = 0;  ///< parameters in front that the source does not name: members of structs
    StatementPtr body;
    SourceLocation at;
    /// The nested functions of a shader's or function's body are listed with the file's, by the parser;
    /// this one's variables named by `extern` are the enclosing ones: those of this shader (or function).
    std::string inside;
    bool typed = true;  ///< the source names the result's type, or says void
};

/// One shader of the file. Its parameters are what the scene may set.
struct Shader {
    ShaderKind kind = ShaderKind::Surface;
    std::string name;
    std::vector<std::unique_ptr<Variable>> parameters;
    StatementPtr body;
    /// The predefined variables that it names (P, N, Ci, ...), made by the analysis.
    std::vector<std::unique_ptr<Variable>> globals;
    bool of_class = false;   ///< of RSL 2, which may make two shaders of one name
    bool displaces = false;  ///< its class is a displacement shader of the same name, too
    SourceLocation at;
};

/// A file after preprocessing. Calls never recurse (the analysis reports it), and so may be inlined: nesting
/// of statements, expressions and calls together stays below kDeepestInlined, and the operations of a shader
/// with its functions in place of their calls below kMostInlined. After the analysis `functions` has one copy
/// for each shader that calls them, since what they name outside differs; those never called are gone.
struct TranslationUnit {
    std::vector<std::unique_ptr<Struct>> structs;
    std::vector<std::unique_ptr<Function>> functions;
    std::vector<std::unique_ptr<Shader>> shaders;
};

}  // namespace trapeze::rsl
