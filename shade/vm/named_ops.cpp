// Operations that a text chooses: coordinate systems, colour spaces, bases of splines.
#include <fmt/format.h>

#include "shade/vm/context_ops.h"
#include "shade/vm/kernels/color.h"
#include "shade/vm/kernels/spline.h"

namespace trapeze::vm {
namespace {

using rsl::Op;

/// Transforms by name are a matrix, found once for the batch, and an operation of matrices. An unknown name
/// is said once and transforms nothing, as it is mostly a misspelt one.
void space_matrix(Run& run, const Step& step, std::span<const Operand> operands) {
    const std::string &from = run.registers().text_input(step, 0), &to = run.registers().text_input(step, 1);
    std::optional<M44f> matrix;
    if (run.context().spaces) matrix = run.context().spaces->matrix(from, to);
    if (!matrix) {
        run.warn(
            step,
            fmt::format("there is no coordinate system \"{}\" or \"{}\"; nothing is transformed", from, to),
            fmt::format("rsl-unknown-space {} {}", from, to));
        matrix.emplace();
    }
    fill_operand(run, operands[0], std::span<const float>(&(*matrix)[0][0], 16));
}

/// ctransform(), and casts of colours from a space. Operand 0 is the result, 1 and 2 the names, 3 the colour.
/// Names are texts, uniform in a run, so one kernel serves all lanes; which is known only here, as they may
/// be computed.
void convert_color(Run& run, const Step& step, std::span<const Operand> operands) {
    const std::string &from = run.registers().text_input(step, 0), &to = run.registers().text_input(step, 1);
    Kernel kernel = find_color_conversion(from, to);
    if (!kernel) {
        run.warn(
            step,
            fmt::format("there is no colour space \"{}\" or \"{}\"; the colour is taken as it is", from, to),
            fmt::format("rsl-unknown-color-space {} {}", from, to));
        kernel = find_color_conversion("rgb", "rgb");
    }
    const std::array both{operands[0], operands[3]};
    kernel(step.varying ? run.lanes() : kLanes, both);
}

}  // namespace

Kernel spline_or_usual(Run& run, const Step& step, const std::string& name, int width) {
    if (const Kernel kernel = find_named_spline(name, width)) return kernel;
    run.warn(step, fmt::format("there is no spline basis \"{}\"; catmull-rom is used", name),
             fmt::format("rsl-unknown-basis {}", name));
    return find_spline_kernel(SplineBasis::CatmullRom, width);
}

namespace {

/// spline() with a basis; without one it is a kernel. The kernel has no operand for the name, so the list is
/// passed on without it.
void spline(Run& run, const Step& step, std::span<const Operand> operands) {
    const std::string& name = run.registers().text_input(step, 0);
    std::vector<Operand> others(operands.begin(), operands.end());
    others.erase(others.begin() + step.outputs);
    const int width = rsl::width_of(run.registers().reg(run.registers().register_of(step, 0)).type.base);
    if (const Kernel kernel = spline_or_usual(run, step, name, width))
        kernel(step.varying ? run.lanes() : kLanes, others);
}

constexpr ContextRow kNamedRows[] = {
    {Op::SpaceMatrix, space_matrix},
    {Op::ConvertColor, convert_color},
    {Op::Spline, spline},
};

}  // namespace

ContextOp find_named_op(Op op) {
    return context_op_in(kNamedRows, op);
}

}  // namespace trapeze::vm
