/// The first half of a frame: from subpatches to shaded grids.
#pragma once

#include "core/grid.h"
#include "core/scene/render_context.h"
#include "pipeline/frame/cost/frame_stats.h"
#include "pipeline/frame/cost/progress.h"
#include "pipeline/frame/regions.h"
#include "shade/shading.h"
#include "tessellate/tessellate.h"

namespace trapeze {

/// Dices and shades a region's subpatches, with the threads of the calling task arena. The grids are in the
/// order of their ordinals. Adds to the stats; a step of progress a subpatch.
Grids make_grids(const RenderContext& context, const Region& region, const Tessellation& tessellation,
                 const Shading& shading, FrameStats& stats, Progress& progress);

}  // namespace trapeze
