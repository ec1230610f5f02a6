// Coordinate systems and colour spaces by name.
#include <fmt/format.h>

#include "shade/vm/context_ops.h"

namespace trapeze::vm {
namespace {

using rsl::Op;

void space_matrix(Run& run, const Step& step, std::span<const Operand> operands) {
    const std::string &from = run.frame().text_input(step, 0), &to = run.frame().text_input(step, 1);
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

}  // namespace

ContextOp find_space_op(Op op) {
    return op == Op::SpaceMatrix ? space_matrix : nullptr;
}

}  // namespace trapeze::vm
