#include "pipeline/compare/frame_parts.h"

#include <algorithm>
#include <utility>

#include "pipeline/frame/regions.h"

namespace trapeze {
namespace {

/// The frame's grids of some subpatches. Both are in the order of ordinals; a subpatch may have no grid.
std::shared_ptr<const Grids> grids_of(const Grids& all, const std::vector<uint32_t>& subpatches) {
    auto grids = std::make_shared<Grids>();
    auto at = all.grids.begin();
    for (const uint32_t subpatch : subpatches) {
        while (at != all.grids.end() && at->ordinal < subpatch) ++at;
        if (at != all.grids.end() && at->ordinal == subpatch) grids->grids.push_back(*at);
    }
    return grids;
}

}  // namespace

std::vector<FramePart> parts_of(const SharedFrame& frame, const BuildMemory& memory) {
    const size_t there = frame.grids.bytes(), whole = memory.bytes(frame.grids);
    const size_t left = frame.memory_budget - std::min(there, frame.memory_budget);
    if (whole <= left)
        return {
            {frame.pixels, std::shared_ptr<const Grids>(std::shared_ptr<const void>(), &frame.grids), whole}};
    RegionLimits limits;
    limits.bytes = left, limits.build = memory, limits.with_grids = false;
    std::vector<FramePart> parts;
    for (const Region& region : split_into_regions(frame.pixels, frame.subpatches, limits)) {
        std::shared_ptr<const Grids> grids = grids_of(frame.grids, region.subpatches);
        const size_t bytes = memory.bytes(*grids);
        parts.push_back({region.pixels, std::move(grids), bytes});
    }
    return parts;
}

}  // namespace trapeze
