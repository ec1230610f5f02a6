// random(): other numbers at each vertex and in each call, the same in each render.
#include "core/random.h"
#include "shade/operations/op_table.h"
#include "shade/vm/context_ops.h"
#include "shade/vm/kernels/random.h"

namespace trapeze::vm {
namespace {

/// The word of a lane in a turn of a loop, of the `depth`-th around the call: a first turn is what it would
/// be without the loop.
uint32_t in_turn(uint32_t word, float turn, size_t depth) {
    constexpr float kMost = 1 << 24;  // lanes that do not run may hold anything
    return turn > 0 && turn < kMost ? hash(word, static_cast<uint32_t>(turn), static_cast<uint32_t>(depth))
                                    : word;
}

/// The first lane of a grid that runs: its turns are the grid's.
size_t first_running(Run& run, const GridSpan& span) {
    const uint32_t* const running = run.masks().current();
    const size_t end = span.first + static_cast<size_t>(span.shape.vertex_count());
    for (size_t lane = span.first; lane < end; ++lane)
        if (running[lane]) return lane;
    return span.first;
}

/// A vertex' number is hashed from its grid's seed, its place in the grid, the call's number in the program
/// (Step::immediate), the turns of loops around it, and in illuminance the light. None of them depends on
/// which thread shades the grid, which grids share a batch or which other lights are run. Lanes behind the
/// last vertex get the seed 0; nobody reads what comes of it.
void random(Run& run, const Step& step, std::span<const Operand> operands) {
    float* seeds = run.scratch(1);
    std::memset(seeds, 0, run.lanes() * sizeof(float));
    const bool is_of_grid = (step.immediate & rsl::random_call::kOfGrid) != 0;
    const Lights::Arriving* const light = run.light_of_turn();
    if (const Batch* batch = run.context().batch)
        for (const GridSpan& span : batch->spans) {
            const size_t one = is_of_grid ? first_running(run, span) : 0;
            for (size_t i = 0; i < static_cast<size_t>(span.shape.vertex_count()); ++i) {
                const size_t lane = is_of_grid ? one : span.first + i;
                uint32_t word = span.word(is_of_grid ? 0 : static_cast<uint32_t>(i));
                if (light) word = hash(word, light->word);
                for (size_t k = 1; k < operands.size(); ++k)
                    word = in_turn(word, operands[k].data[lane & operands[k].lane_mask], k);
                std::memcpy(seeds + span.first + i, &word, sizeof word);
            }
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
