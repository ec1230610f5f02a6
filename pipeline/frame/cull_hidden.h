/// Culling before shading [Hou10 sec. 4]: which grids samples see is found before they are shaded, so that
/// shaders run on these alone.
#pragma once

#include <cstdint>
#include <vector>

#include "core/scene/render_context.h"
#include "pipeline/frame/cost/frame_stats.h"
#include "pipeline/frame/regions.h"
#include "pipeline/frame/tiles/layer_passes.h"
#include "sample/visibility.h"
#include "shade/shading.h"
#include "tessellate/tessellate.h"

namespace trapeze {

/// When grids that no sample sees are left out before they are shaded.
enum class CullHidden : uint8_t {
    Auto,  ///< where shaders trace rays, which take longer than to find out, and enough is opaque
    On,
    Off,
};

/// Leaves in a region the subpatches whose grids are to be shaded, in order: those that any of its samples
/// sees, and those that must be shaded in any case (Shading::may_stay_unshaded()). Of those that are seen in
/// part, vertices that no sample sees are not wanted, where shaders allow it (Shading::may_ask_for_some()).
/// Takes the samples through the region once more, but composites nothing; where their layers take more than
/// the limits allow, nothing is left out; nor where `always` is false and so little hides what is behind, or
/// lies behind anything, that to find out takes longer. The picture is the same bits. Adds to the stats'
/// counts of what is left out.
void leave_out_hidden(const RenderContext& context, Region& region, const Tessellation& tessellation,
                      const Shading& shading, const Sampler& sampler, const SamplePattern& pattern,
                      const LayerLimits& limits, bool always, FrameStats& stats);

}  // namespace trapeze
