#include <fmt/format.h>

#include <cmath>
#include <numbers>

#include "shade/code/generator.h"
#include "shade/operations/op_table.h"
#include "shade/rsl/syntax/printer.h"

namespace trapeze::rsl {
namespace {

/// Inlining recurses on the processor's own stack, a few frames for each call.
constexpr int kMaxCallDepth = 200;

/// Which arguments of a call the function sets; those past the letters are inputs. A letter of a row stands
/// for one argument each; see Builtin for them.
std::vector<bool> outputs_of(const Builtin& builtin, size_t arguments) {
    std::vector<bool> outputs(arguments, false);
    size_t at = 0;
    for (const char letter : builtin.parameters) {
        if (at >= arguments) break;
        if (letter == '[') continue;
        if (letter == '*' || letter == '.' || letter == '+') break;
        outputs[at++] = is_output_letter(letter);
    }
    return outputs;
}

/// Arguments that stand before the named ones.
size_t positional_count(const Builtin& builtin, size_t arguments) {
    size_t count = 0;
    for (const char letter : builtin.parameters)
        if (letter != '[' && letter != '*' && letter != '.' && letter != '+') ++count;
    return std::min(count, arguments);
}

/// A look into a map, whose inputs map_value() puts in order.
bool is_map(Op op) {
    return row_of(op).context == ContextFamily::Maps && op != Op::TextureInfo;
}

/// The operation of a call. What rayinfo() is asked for differs from vertex to vertex, unless it is a text or
/// a name is given that is known to be of all of them.
Op operation_of(const Expression& e) {
    const Op op = e.builtin->op;
    if (op != Op::RayInfo || e.children[1]->type.base == Base::String) return op;
    const Expression& name = *e.children[0];
    const bool may_differ = name.kind != Expression::Kind::Text || name.text == "origin" ||
                            name.text == "direction" || name.text == "length";
    return may_differ ? Op::RayWay : op;
}

/// 0 to 2 for xcomp() to zcomp() and setxcomp() to setzcomp(); -1 for other names.
int axis_of_function(std::string_view name) {
    const size_t at = name.starts_with("set") ? 3 : 0;
    if (name.size() != at + 5 || !name.ends_with("comp")) return -1;
    return name[at] >= 'x' && name[at] <= 'z' ? name[at] - 'x' : -1;
}

}  // namespace

/// A function of the source leaves its value in a register of its own, which is then moved to where it is
/// wanted.
RegisterId Generator::call_value(const Expression& e, std::optional<RegisterId> into) {
    if (e.function) return moved(function_value(e), e.type.base, into);
    return builtin_value(e, into);
}

/// A call of a built-in function. Its operands are the arguments in their order, those that it sets among the
/// outputs, behind the result; what the source left out stands behind them, or in front (add_unnamed_inputs).
RegisterId Generator::builtin_value(const Expression& e, std::optional<RegisterId> into) {
    if (const auto rewritten = rewritten_builtin(e, into)) return *rewritten;
    const Builtin& builtin = *e.builtin;
    std::vector<bool> is_output = outputs_of(builtin, e.children.size());
    Ids outputs, inputs, names;
    // Messages and the like give whether they found anything, and keep the variable if not.
    if (builtin.result != 'w') outputs.push_back(into ? *into : temporary(e.type.base));
    const size_t positional = positional_count(builtin, e.children.size());
    for (size_t i = 0; i < e.children.size(); ++i) {
        const Expression& argument = *e.children[i];
        const size_t pair = i - positional;  // of a name, behind the plain arguments
        if (i >= positional && pair % 2 == 0 && i + 1 < e.children.size() && is_named_output(e, i + 1) &&
            !e.children[i + 1]->type.is_array() && e.children[i + 1]->type.base != Base::String) {
            names.push_back(value(argument));
            is_output[++i] = true;
            outputs.push_back(output_place(*e.children[i], e.children[i]->type.base));
        } else if (builtin.op == Op::Bake3d && i >= positional && pair % 2 == 1) {
            // Its type: a register may be another's of as many numbers.
            inputs.push_back(constant_text(print(argument.type)));
            inputs.push_back(value(argument));
        } else if (is_output[i])
            outputs.push_back(output_place(argument, argument.type.base));
        else
            inputs.push_back(value(argument));
    }
    const Op op = operation_of(e);
    add_unnamed_inputs(op, inputs);
    inputs.insert(inputs.begin() + static_cast<std::ptrdiff_t>(std::min(positional, inputs.size())),
                  names.begin(), names.end());
    const bool is_random = builtin.op == Op::Random;
    if (is_random) add_turns(inputs);
    const int32_t number = is_random ? random_calls_++ | (for_uniform_ ? random_call::kOfGrid : 0) : 0;
    const RegisterId result = outputs.empty() ? constant(0) : outputs.front();
    std::vector<RegisterId> written = outputs;
    emit(op, std::move(outputs), inputs, number);
    size_t at = builtin.result != 'w' ? 1 : 0;
    for (size_t i = 0; i < e.children.size(); ++i)
        if (is_output[i]) write_back(*e.children[i], written[at++]);
    return result;
}

/// The surface's own u or v, which derivatives are by.
RegisterId Generator::surface_parameter(std::string_view name, std::string_view hidden_name) {
    const auto named = by_name_.find(name);
    const bool is_taken =
        named != by_name_.end() && program_->reg(named->second).kind != Register::Kind::Global;
    return global(is_taken || shader_.kind == ShaderKind::Light ? hidden_name : name, Base::Float);
}

/// Predefined variables that a function reads without being given them. In front where the operation's row in
/// op_table.def has P first, otherwise behind the arguments. Lights know no Ng of what they shine on: what
/// they turn to the eye is its own reference.
void Generator::add_unnamed_inputs(Op op, Ids& inputs) {
    if (op_traits::has(op, op_traits::kNeedsNg) && inputs.size() == 2)
        inputs.push_back(shader_.kind == ShaderKind::Light ? inputs.front() : global("Ng", Base::Normal));
    if (op_traits::has(op, op_traits::kNeedsUV)) {
        inputs.push_back(surface_parameter("u", kSurfaceU));
        inputs.push_back(surface_parameter("v", kSurfaceV));
    }
    if (op == Op::RayWay) {
        inputs.push_back(global(kRayOrigin, Base::Point));
        inputs.push_back(global(kRayWay, Base::Vector));
    }
    if (!op_traits::has(op, op_traits::kNeedsP)) return;
    inputs.insert(inputs.begin(), global("P", Base::Point));
    global("N", Base::Normal);  // lights may ask for it
}

/// Functions that are other operations than their table's. The machine has few operations and each a fixed
/// number of operands; what can be said by others costs no kernel of its own.
std::optional<RegisterId> Generator::rewritten_builtin(const Expression& e, std::optional<RegisterId> into) {
    const Builtin& builtin = *e.builtin;
    switch (builtin.op) {
        case Op::Min:
        case Op::Max:
        case Op::Concat:
            if (e.children.size() > 2) return chain_value(e, into);
            return {};
        case Op::LogBase: {
            const RegisterId a = compute(Op::Log, Base::Float, {value(*e.children[0])});
            const RegisterId b = compute(Op::Log, Base::Float, {value(*e.children[1])});
            return compute(Op::Divide, Base::Float, {a, b}, into);
        }
        case Op::Radians:
        case Op::Degrees: {
            const double degree = std::numbers::pi / 180;
            const RegisterId factor =
                constant(static_cast<float>(builtin.op == Op::Radians ? degree : 1 / degree));
            return compute(Op::Multiply, Base::Float, {value(*e.children[0]), factor}, into);
        }
        case Op::TransformPointNamed:
        case Op::TransformVectorNamed:
        case Op::TransformNormalNamed:
        case Op::TransformMatrixNamed:
            return named_transform_value(e, into);
        case Op::ConvertColor: {
            Ids inputs;
            if (e.children.size() == 2) inputs.push_back(constant_text("rgb"));
            for (const ExpressionPtr& child : e.children) inputs.push_back(value(*child));
            // ctransform(to, c) and ctransform(from, to, c).
            return compute(Op::ConvertColor, Base::Color, inputs, into);
        }
        case Op::Component:
            if (const int axis = axis_of_function(builtin.name); axis >= 0)
                return compute(Op::Component, Base::Float,
                               {value(*e.children[0]), constant(static_cast<float>(axis))}, into);
            return {};
        case Op::ArrayLength:
            return moved(count_of(value(*e.children[0])), Base::Float, into);
        case Op::ArrayCapacity:
        case Op::ArrayPush:
        case Op::ArrayPop:
        case Op::ArrayResize:
        case Op::ArrayReserve:
            return array_value(e, into);
        case Op::Spline:
            return array_spline(e, into);
        case Op::IsOutput:
            return moved(constant(1), Base::Float, into);
        case Op::Unavailable: {
            for (const ExpressionPtr& child : e.children) value(*child);
            // A ray that hits nothing comes very far.
            const float nothing = builtin.name == "rayhittest" ? 1e30f : 0.0f;
            return moved(e.type.base == Base::String ? constant_text("") : constant(nothing), e.type.base,
                         into);
        }
        case Op::SetComponent:
        case Op::SetMatrixElement:
            return set_part(e);
        default:
            if (is_map(builtin.op)) return map_value(e, into);
            return {};
    }
}

/// setcomp(c, k, x), setxcomp(p, x), setcomp(m, row, column, x): the output is the first argument. An element
/// of an array is taken out, changed and written back, as operations know no places but registers.
RegisterId Generator::set_part(const Expression& e) {
    const Expression& target = *e.children[0];
    RegisterId place;
    if (target.kind == Expression::Kind::Element)
        place = value(target, temporary(target.type.base));
    else
        place = register_of(*target.variable);
    Ids inputs;
    const int axis = axis_of_function(e.builtin->name);
    if (axis >= 0) inputs.push_back(constant(static_cast<float>(axis)));
    for (size_t i = 1; i < e.children.size(); ++i) inputs.push_back(value(*e.children[i]));
    emit(e.builtin->op, {place}, inputs);
    write_back(target, place);
    return place;
}

/// min(a, b, c, ...) as min(min(a, b), c) ... All arguments are computed before the first step, in the order
/// of the source. The last step alone may write to `into`, which an argument may still be read from before.
RegisterId Generator::chain_value(const Expression& e, std::optional<RegisterId> into) {
    Ids inputs;
    for (const ExpressionPtr& child : e.children) inputs.push_back(value(*child));
    RegisterId result = inputs.front();
    for (size_t i = 1; i < inputs.size(); ++i)
        result = compute(e.builtin->op, e.type.base, {result, inputs[i]},
                         i + 1 == inputs.size() ? into : std::nullopt);
    return result;
}

/// The matrix of transform([from,] to, ...), where `to` is a name or a matrix. Row vectors: the space on the
/// left is left first. A name alone stands for the way from "current" to it.
RegisterId Generator::named_matrix(const Expression* from, const Expression& to) {
    const RegisterId current = constant_text("current");
    if (to.type.base != Base::Matrix)
        return compute(Op::SpaceMatrix, Base::Matrix, {from ? value(*from) : current, value(to)});
    const RegisterId matrix = value(to);
    if (!from) return matrix;
    const RegisterId first = compute(Op::SpaceMatrix, Base::Matrix, {value(*from), current});
    return compute(Op::MatrixMultiply, Base::Matrix, {first, matrix});
}

/// transform(), and those of vectors, normals and matrices, from a space or to one. Two operations, of which
/// the matrix is uniform mostly and made once for the batch.
RegisterId Generator::named_transform_value(const Expression& e, std::optional<RegisterId> into) {
    const size_t last = e.children.size() - 1;
    const RegisterId matrix = named_matrix(last == 2 ? e.children[0].get() : nullptr, *e.children[last - 1]);
    const RegisterId moving = value(*e.children[last]);
    switch (e.builtin->op) {
        case Op::TransformPointNamed:
            return compute(Op::TransformPoint, e.type.base, {matrix, moving}, into);
        case Op::TransformVectorNamed:
            return compute(Op::TransformVector, e.type.base, {matrix, moving}, into);
        case Op::TransformNormalNamed:
            return compute(Op::TransformNormal, e.type.base, {matrix, moving}, into);
        default:
            return compute(Op::MatrixMultiply, e.type.base, {moving, matrix}, into);
    }
}

/// Inputs are the name, the channel, the coordinates (s and t when the call names none), then names and
/// values.
RegisterId Generator::map_value(const Expression& e, std::optional<RegisterId> into) {
    const Expression& name = *e.children[0];
    Ids inputs;
    const bool with_channel = name.kind == Expression::Kind::Element && !name.children[0]->type.is_array();
    inputs.push_back(value(with_channel ? *name.children[0] : name));
    inputs.push_back(with_channel ? value(*name.children[1]) : constant(0));
    const size_t positional = positional_count(*e.builtin, e.children.size());
    int32_t coordinates = 0;
    for (size_t i = 1; i < positional; ++i, ++coordinates) inputs.push_back(value(*e.children[i]));
    const Op op = e.builtin->op;
    if ((op == Op::Texture && coordinates == 0) || (op == Op::Bump && coordinates == 3)) {
        inputs.push_back(global("s", Base::Float));
        inputs.push_back(global("t", Base::Float));
        coordinates += 2;
    }
    for (size_t i = positional; i < e.children.size(); ++i) inputs.push_back(value(*e.children[i]));
    // Rays begin at P, if it turns out that they are asked for.
    const bool may_trace =
        op == Op::Environment && (name.kind != Expression::Kind::Text || name.text == kTracedMap);
    if (may_trace && program_->kind == ShaderKind::Light) global("Ps", Base::Point);
    if (may_trace && program_->kind != ShaderKind::Light && program_->kind != ShaderKind::Imager)
        global("P", Base::Point);
    const RegisterId out = into ? *into : temporary(e.type.base);
    emit(e.builtin->op, {out}, inputs, coordinates);
    return out;
}

/// A register for an argument that a function sets: the variable's own, or for an array's element a local,
/// from which write_back() stores it.
RegisterId Generator::output_place(const Expression& argument, Base base) {
    if (argument.kind == Expression::Kind::Variable) return register_of(*argument.variable);
    const RegisterId place = add_register(Register::Kind::Local, {base, 0});
    // What is not set must be kept.
    if (argument.kind == Expression::Kind::Element) value(argument, place);
    return place;
}

/// Stores what a function set back into the array's element; variables have been set in place.
void Generator::write_back(const Expression& argument, RegisterId result) {
    if (argument.kind != Expression::Kind::Element) return;
    const RegisterId array = value(*argument.children[0]);
    set_element(array, value(*argument.children[1]), result);
}

/// Arguments are passed by reference, as RISpec says (section 16.1); a parameter that the function changes
/// though it is no output is a copy.
RegisterId Generator::function_value(const Expression& e) {
    const Function& function = *e.function;
    if (call_depth_ >= kMaxCallDepth) {
        diagnostics_.error(e.at, fmt::format("functions are called {} deep", kMaxCallDepth));
        throw TooLarge{};
    }
    std::vector<std::pair<const Variable*, RegisterId>> bound;
    std::vector<std::pair<const Expression*, RegisterId>> elements;
    for (size_t i = 0; i < function.parameters.size() && i < e.children.size(); ++i) {
        const Variable& parameter = *function.parameters[i];
        const Expression& argument = *e.children[i];
        if (parameter.output) {
            const RegisterId place = output_place(argument, parameter.type.base);
            if (argument.kind == Expression::Kind::Element) elements.push_back({&argument, place});
            bound.push_back({&parameter, place});
        } else if (parameter.type.is_array()) {
            bound.push_back({&parameter, value(argument)});
        } else {
            const RegisterId given = value(argument);
            if (assigns(*function.body, parameter)) {
                const RegisterId copy = add_register(Register::Kind::Local, parameter.type, parameter.name);
                moved(given, parameter.type.base, copy);
                bound.push_back({&parameter, copy});
            } else {
                bound.push_back({&parameter, given});
            }
        }
    }
    // A function inlined twice has new variables each time.
    auto outer_locals = locals_;
    for (const auto& [parameter, id] : bound) locals_[parameter] = id;
    ++call_depth_;
    const RegisterId result = inline_body(function, e.type.base);
    --call_depth_;
    locals_ = std::move(outer_locals);
    for (const auto& [argument, place] : elements) write_back(*argument, place);
    return result;
}

/// The function's statements where it is called. A return from the middle leaves a Scope around them, so that
/// lanes may return one by one. The parameters have their registers already (function_value()). What the
/// outer body was doing with its own result and scope is put aside meanwhile.
RegisterId Generator::inline_body(const Function& function, Base base) {
    const Body outer = body_;
    body_ = {};
    if (base != Base::Void) body_.result = add_register(Register::Kind::Local, {base, 0});
    body_.in_scope = contains_early_return(*function.body);
    // What falls off the function's end has a value too.
    if (body_.result && !ends_with_return(*function.body)) clear(*body_.result);
    if (body_.in_scope) open(Op::Scope, {}, {});
    statement(*function.body);
    if (body_.in_scope) close(Op::EndScope);
    const RegisterId result = body_.result ? *body_.result : constant(0);
    body_ = outer;
    return result;
}

}  // namespace trapeze::rsl
