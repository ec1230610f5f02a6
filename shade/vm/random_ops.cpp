// random(): other numbers at each vertex and in each call, the same in each render.
#include "core/random.h"
#include "shade/vm/context_ops.h"
#include "shade/vm/kernels/random.h"

namespace trapeze::vm {
namespace {

/// The word of a lane in the call's turn of a loop: a first turn is what it would be without the loop.
uint32_t in_turn(uint32_t word, float turn) {
    constexpr float kMost = 1 << 24;  // lanes that do not run may hold anything
    return turn > 0 && turn < kMost ? hash(word, static_cast<uint32_t>(turn)) : word;
}

/// A vertex' number is hashed from its grid's seed, its place in the grid, the call's number in the program
/// (Step::immediate) and how often the vertex has come by in a loop. None of them depends on which thread
/// shades the grid or which grids share a batch. Lanes behind the last vertex get the seed 0; nobody reads
/// what comes of it.
void random(Run& run, const Step& step, std::span<const Operand> operands) {
    float* seeds = run.scratch(1);
    std::memset(seeds, 0, run.lanes() * sizeof(float));
    const bool is_of_grid = (step.immediate & rsl::random_call::kOfGrid) != 0;
    const Operand* const turns = operands.size() > 1 ? &operands[1] : nullptr;
    if (const Batch* batch = run.context().batch)
        for (const GridSpan& span : batch->spans)
            for (size_t i = 0; i < static_cast<size_t>(span.shape.vertex_count()); ++i) {
                const size_t lane = span.first + i;
                uint32_t word = span.word(is_of_grid ? 0 : static_cast<uint32_t>(i));
                if (turns) word = in_turn(word, turns->data[lane & turns->lane_mask]);
                std::memcpy(seeds + lane, &word, sizeof word);
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
