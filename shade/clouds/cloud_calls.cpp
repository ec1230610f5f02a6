#include "shade/clouds/cloud_calls.h"

#include <fmt/format.h>

#include <array>
#include <cmath>

#include "shade/clouds/bake_call.h"
#include "shade/clouds/look_up_call.h"
#include "shade/vm/context_ops.h"

namespace trapeze {

using vm::Operand;
using vm::Run;
using vm::Step;

void CloudCalls::look_up(Run& run, const Step& step, std::span<const Operand> operands) {
    LookUpCall(run, step, operands, places_.clouds).run(shares_);
}

/// Gives 1 where points are baked, also at hits of rays, whose points nobody wants.
void CloudCalls::bake(Run& run, const Step& step, std::span<const Operand> operands) {
    const bool of_light = run.registers().program().kind == rsl::ShaderKind::Light;
    vm::fill_operand(run, operands[0], std::array{of_light ? 0.0f : 1.0f});
    if (of_light)
        return run.warn(step, "bake3d: light shaders bake nothing: they run more often than surfaces",
                        "bake3d-light");
    const vm::Batch* const batch = run.context().batch;
    if (!places_.bakes || grids_.empty() || !batch) return;
    const BakeCall call(run, step, operands);
    baked_.resize(grids_.size());
    for (size_t g = 0; g < grids_.size(); ++g) {
        baked_[g].ordinal = grids_[g]->ordinal;
        BakedCall points = call.points_of(batch->spans[g]);
        if (points.points.empty() && points.not_finite == 0) continue;
        if (places_.bakes->reserve(points)) baked_[g].calls.push_back(std::move(points));
    }
}

bool CloudCalls::over_discs(Run& run, const Step& step, std::span<const Operand> operands) {
    const PointBasedCall call(run, step, operands, places_.clouds, places_.scene, places_.of_discs);
    if (!call.is_answered()) return false;
    if (!discs_) discs_ = std::make_unique<PointBasedScratch>();
    call.run(*discs_);
    return true;
}

void CloudCalls::finish() {
    if (places_.bakes && !baked_.empty()) places_.bakes->add(std::move(baked_));
    baked_.clear();
}

}  // namespace trapeze
