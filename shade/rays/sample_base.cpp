#include "shade/rays/sample_base.h"

#include <algorithm>
#include <cmath>

#include "core/random.h"

namespace trapeze {

V3f SampleBase::origin(const V3f& P, const RayArguments& arguments, const RayLane& lane, int sample) const {
    const float part = arguments.sample_base.at(lane.lane);
    if (!(part > 0) || !batch_) return P;
    const auto span = std::ranges::find_if(batch_->spans, [&](const vm::GridSpan& s) {
        return lane.lane >= s.first && lane.lane < s.first + static_cast<size_t>(s.shape.vertex_count());
    });
    if (span == batch_->spans.end()) return P;
    // To the next vertex of a row or column, or from the one before.
    const size_t across = static_cast<size_t>(span->shape.nu) + 1, at = lane.lane - span->first;
    const V3f here = arguments.from_at(lane.lane);
    const auto side = [&](size_t step, bool last) {
        const V3f there = arguments.from_at(last ? lane.lane - step : lane.lane + step);
        const V3f way = last ? here - there : there - here;
        return std::isfinite(way.x) && std::isfinite(way.y) && std::isfinite(way.z) ? way : V3f(0, 0, 0);
    };
    const V3f along_u = side(1, at % across == across - 1);
    const V3f along_v = side(across, at / across == static_cast<size_t>(span->shape.nv));
    const auto number = static_cast<uint32_t>(sample);
    const float most = std::min(part, 1.0f);
    return P + along_u * (most * (unit_float(hash(lane.seed, number, 5)) - 0.5f)) +
           along_v * (most * (unit_float(hash(lane.seed, number, 6)) - 0.5f));
}

}  // namespace trapeze
