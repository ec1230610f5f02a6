// Loops over rays: gather blocks. Lanes whose ray of a turn hits something run the first half, the others the
// second. All live lanes take a turn together, though each has rays of its own.
#include <algorithm>
#include <cstring>

#include "shade/operations/op_table.h"
#include "shade/vm/context_ops.h"
#include "shade/vm/machine.h"

namespace trapeze::vm {
namespace {

using rsl::Op;

/// Where there is no scene to send rays into: all of them miss.
class RaysIntoNothing final : public GatherTurns {
  public:
    RaysIntoNothing(size_t lanes, float samples) : hits_(lanes, 0.0f), misses_(lanes) {
        constexpr float kMostSamples = 65536;
        turns_ = samples >= 1 ? static_cast<int>(std::min(samples, kMostSamples)) : 0;
        std::memset(misses_.data(), 0xff, lanes * sizeof(float));
    }
    Task<bool> next(Run&, const uint32_t*) override { co_return turns_-- > 0; }
    const float* hits() const override { return hits_.data(); }
    const float* misses() const override { return misses_.data(); }

  private:
    std::vector<float> hits_, misses_;
    int turns_ = 0;
};

}  // namespace

/// The turns of a block: of rays, or of an environment map. Where that is not there is no turn.
std::unique_ptr<GatherTurns> Run::gather_turns(const Step& step) {
    constexpr size_t kSamples = 4;
    const std::string_view category = registers_.text_input(step, 0);
    const std::span<const Operand> operands = registers_.operands_of(step);
    if (category.starts_with(rsl::kOfEnvironment)) {
        std::unique_ptr<GatherTurns> turns;
        if (context_.maps)
            turns =
                context_.maps->gather_sky(category.substr(rsl::kOfEnvironment.size()), *this, step, operands);
        if (turns) return turns;
        return std::make_unique<RaysIntoNothing>(lanes(), 0.0f);
    }
    if (context_.rays) return context_.rays->gather(*this, step, operands);
    warn_of_no_rays(*this, step);
    return std::make_unique<RaysIntoNothing>(lanes(), at(registers_.input(step, kSamples), 0, 0));
}

/// Gather and EndGather. Gather opens the block and starts its first turn. EndGather starts the next one; it
/// also counts the steps of the turn that has ended, for a gather of very many samples is a loop like any
/// other (LoopLimits).
Task<size_t> Run::gather_step(const std::vector<Step>& steps, size_t at_step) {
    const Step& step = steps[at_step];
    switch (step.op) {
        case Op::Gather:
            masks_.enter_loop();
            gathers_.push_back(gather_turns(step));
            co_return co_await next_rays(steps, at_step);
        default:
            if (!steps_are_spent(steps[step.target], at_step - step.target))
                co_return co_await next_rays(steps, step.target);
            gathers_.pop_back();
            masks_.leave_block();
            co_return at_step + 1;
    }
}

/// GatherElse. The lanes whose rays hit nothing; the block's live lanes decide who is left, so that a lane
/// which has jumped out in the first half does not come back here.
size_t Run::turn_to_misses(const Step& step, size_t at_step) {
    masks_.start_turn(gathers_.back()->misses());
    return masks_.none() ? step.target : at_step + 1;
}

/// Begins a turn with the lanes whose rays hit something; goes past the block when there are no more rays, or
/// all lanes have left it.
Task<size_t> Run::next_rays(const std::vector<Step>& steps, size_t opening) {
    const size_t otherwise = steps[opening].target;
    masks_.next_turn();
    bool takes_turn = !masks_.none();
    if (takes_turn) takes_turn = co_await gathers_.back()->next(*this, masks_.current());
    if (takes_turn) {
        masks_.start_turn(gathers_.back()->hits());
        co_return masks_.none() ? otherwise : opening + 1;
    }
    gathers_.pop_back();
    masks_.leave_block();
    co_return steps[otherwise].target + 1;
}

}  // namespace trapeze::vm
