// random(): other numbers at each vertex and in each call, the same in each render.
#include "core/random.h"
#include "shade/vm/context_ops.h"
#include "shade/vm/kernels/random.h"

namespace trapeze::vm {
namespace {

/// A vertex' number is hashed from its grid's seed, its place in the grid, and the call's number in the
/// program (Step::immediate). None of them depends on which thread shades the grid or which grids share a
/// batch. Lanes behind the last vertex get the seed 0; nobody reads what comes of it.
void random(Run& run, const Step& step, std::span<const Operand> operands) {
    float* seeds = run.scratch(1);
    std::memset(seeds, 0, run.lanes() * sizeof(float));
    if (const Batch* batch = run.context().batch)
        for (const GridSpan& span : batch->spans)
            for (size_t i = 0; i < static_cast<size_t>(span.shape.vertex_count()); ++i) {
                const uint32_t word = span.word(static_cast<uint32_t>(i));
                std::memcpy(seeds + span.first + i, &word, sizeof word);
            }
    Operand lanes;
    lanes.data = seeds;
    lanes.lane_mask = ~size_t{0};
    random_numbers(run.lanes(), operands[0].stride ? 3 : 1, lanes, static_cast<uint32_t>(step.immediate),
                   operands[0]);
}

constexpr ContextRow kRandomRows[] = {
    {rsl::Op::Random, random},
};

}  // namespace

ContextOp find_random_op(rsl::Op op) {
    return context_op_in(kRandomRows, op);
}

}  // namespace trapeze::vm
