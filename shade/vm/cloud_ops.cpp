// Point clouds. Where they are and what they hold is the affair of shade/clouds, on which the machine does
// not depend; without them, as in most tests, nothing is baked and nothing is found.
#include <array>

#include "shade/vm/context_ops.h"

namespace trapeze::vm {
namespace {

using rsl::Op;

/// Without clouds, as when a shader is run alone, the call fails as it would for a file that cannot be
/// written: 0.
void bake3d(Run& run, const Step& step, std::span<const Operand> operands) {
    if (run.context().clouds)
        run.context().clouds->bake(run, step, operands);
    else
        fill_operand(run, operands[0], std::array{0.0f});
}

/// Without clouds 0, and the outputs keep what they hold.
void texture3d(Run& run, const Step& step, std::span<const Operand> operands) {
    if (run.context().clouds)
        run.context().clouds->look_up(run, step, operands);
    else
        fill_operand(run, operands[0], std::array{0.0f});
}

constexpr ContextRow kCloudRows[] = {{Op::Bake3d, bake3d}, {Op::Texture3d, texture3d}};

}  // namespace

ContextOp find_cloud_op(Op op) {
    return context_op_in(kCloudRows, op);
}

}  // namespace trapeze::vm
