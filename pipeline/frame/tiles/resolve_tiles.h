/// The second half of a frame: from grids and samples to the film.
#pragma once

#include <functional>
#include <vector>

#include "composite/film/film.h"
#include "core/scene/render_context.h"
#include "pipeline/frame/cost/frame_stats.h"
#include "pipeline/frame/tiles/layer_passes.h"
#include "pipeline/frame/tiles/tile_order.h"
#include "sample/visibility.h"

namespace trapeze {

/// What the samples of each pixel cost a method, means over the pixel's samples, all zero for a method that
/// does not say, or has adaptive samples; and how many samples there were.
struct HeatMap {
    PixelRect pixels;
    std::vector<float> tests, nodes;  ///< row by row; see SampleHeat
    std::vector<float> samples;

    HeatMap() = default;
    explicit HeatMap(const PixelRect& of)
        : pixels(of),
          tests(static_cast<size_t>(of.width()) * of.height()),
          nodes(tests.size()),
          samples(tests.size()) {}
    size_t index(int x, int y) const {
        return static_cast<size_t>(y - pixels.y0) * pixels.width() + static_cast<size_t>(x - pixels.x0);
    }
};

/// How resolve_tiles() goes about it.
struct ResolveOptions {
    LayerLimits limits;  ///< of the layers that samples see
    TileOrder order = TileOrder::Rows;
    HeatMap* heat = nullptr;  ///< of those pixels, to fill; null: none is wanted
};

/// Finds what every sample of some pixels sees and adds it to the film, with the threads of the calling task
/// arena; what the film does not await is left out. Adds to the stats; calls `on_step` once for each
/// rectangle of tiles_of(pixels, side of a tile). A pattern with levels is sampled adaptively, by a method
/// that takes lists.
void resolve_tiles(const RenderContext& context, const PixelRect& pixels, const Grids& grids,
                   const Visibility& visibility, const SamplePattern& pattern, Film& film, FrameStats& stats,
                   const std::function<void()>& on_step, const ResolveOptions& options);

}  // namespace trapeze
