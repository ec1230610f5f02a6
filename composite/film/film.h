/// The film: filtered sums of samples, and the picture they make.
///
/// The picture is the same bit for bit for any order of tiles, any number of threads, any split into regions,
/// and a crop equals the same pixels of the whole picture. So no two tiles add to the same sum: each has its
/// own, over its pixels and those around that its samples reach, filled in the order of the samples. A pixel
/// is finished by adding the sums of the tiles around it in the order of the tiles, as soon as the last of
/// these has come; then sums that nobody waits for are freed, so that memory holds the picture and a frontier
/// of tiles. Output variables (aov.h) are summed the same way, in a pass of their own over a tile's samples,
/// so that pictures without them pay nothing.
#pragma once

#include <atomic>
#include <memory>
#include <vector>

#include "composite/film/filters.h"
#include "composite/image.h"
#include "core/grid.h"
#include "core/hit_buffer.h"
#include "core/samples.h"
#include "core/scene/aov.h"
#include "core/scene/render_context.h"

namespace trapeze {

/// Hider "depthfilter": what the depths of a pixel's samples make.
enum class DepthFilter { Min, Max, Average, Midpoint };

/// As Hider "depthfilter" says; Min for a name that is not known. Midpoint wants a sample's hits beyond the
/// first opaque one.
DepthFilter depth_filter(const Options& options);

class Film {
  public:
    /// Reads the crop, PixelFilter, Exposure and Hider of the context's scene. Image::id is recorded when
    /// asked for here, or by a Display of mode "id".
    explicit Film(const RenderContext& context, bool record_ids = false);
    ~Film();
    Film(const Film&) = delete;
    Film& operator=(const Film&) = delete;

    /// Adds what the samples of a tile see: a tile of kTileSide pixels anchored at multiples of kTileSide, or
    /// that part of it that lies within sampled_pixels(). Thread-safe; each tile once (a second time it is
    /// ignored).
    void add(const SampleTile& samples, const HitBuffer& hits, const Grids& grids);

    /// The picture. Pixels that still wait for tiles are made of those that came. Call once, after the last
    /// add().
    Image finish();

    /// Bytes of the sums that wait for their neighbours.
    size_t waiting_bytes() const { return waiting_bytes_.load(std::memory_order_relaxed); }

  private:
    struct Sums;
    struct Tile;

    PixelRect tile_pixels(int tile) const;
    /// Calls visit(tile) for the tiles around a tile, itself included, in the order of tiles.
    template <class Visit>
    void for_each_neighbour(int tile, Visit&& visit) const;
    /// Whether samples of a tile reach pixels (of the crop) of another.
    bool reaches(int from, int to) const;

    void accumulate(const SampleTile& samples, const HitBuffer& hits, const Grids& grids, Sums& sums);
    /// kTaps is FilterKernel::weigh()'s.
    template <int kTaps>
    void accumulate_taps(const SampleTile& samples, const HitBuffer& hits, const Grids& grids, Sums& sums);
    template <int kTaps>
    void add_sample(float x, float y, int px, int py, const float* rgba, float* weights, Sums& sums) const;
    void accumulate_aovs(const SampleTile& samples, const HitBuffer& hits, const Grids& grids,
                         Sums& sums) const;
    void record_pixel(int px, int py, float depth, uint32_t primitive);
    void settle(int tile);
    void develop(int tile);
    void develop_aovs(int tile, const std::vector<float>& weights);
    void release(int tile);
    void expose(float* rgba) const;

    AovLayout aovs_;
    FilterKernel kernel_;
    DepthFilter depth_filter_ = DepthFilter::Min;
    float gain_ = 1, inverse_gamma_ = 1;
    PixelRect sampled_;  ///< the pixels whose samples count
    int first_tile_x_ = 0, first_tile_y_ = 0, tiles_x_ = 0, tiles_y_ = 0;
    int tile_reach_x_ = 0, tile_reach_y_ = 0;  ///< in tiles
    std::unique_ptr<Tile[]> tiles_;
    std::atomic<size_t> waiting_bytes_{0};
    Image image_;
};

}  // namespace trapeze
