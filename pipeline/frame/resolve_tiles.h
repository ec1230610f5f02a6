/// The second half of a frame: from grids and samples to the film.
#pragma once

#include <functional>

#include "composite/film.h"
#include "core/render_context.h"
#include "pipeline/frame/frame_stats.h"
#include "sample/visibility_method.h"

namespace trapeze {

/// Finds what every sample of some pixels sees and adds it to the film, with the threads of the calling task
/// arena. Adds to the stats; calls `on_step` once for each rectangle of tiles_of(pixels, side of a tile).
void resolve_tiles(const RenderContext& context, const PixelRect& pixels, const Grids& grids,
                   const Visibility& visibility, const SamplePattern& pattern, Film& film, FrameStats& stats,
                   const std::function<void()>& on_step);

}  // namespace trapeze
