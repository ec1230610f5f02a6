/// What the rasterizers have in common: grids sorted into tiles of pixels, bounds of their micropolygons, and
/// hits collected in the scratch.
#pragma once

#include "sample/rasterize/grid_bounds.h"
#include "sample/rasterize/tile_bins.h"
#include "sample/visibility.h"

namespace trapeze {

/// What a thread needs for any rasterizer.
struct RasterizerScratch {
    std::vector<uint32_t> grids;  ///< that the tile may see
};

/// The base of the rasterizers: finds the grids that a tile may see, lets the method put them into samples,
/// and makes the hit buffer of what it found. Refers to the context and the grids, which outlive it.
class Rasterizer : public Visibility {
  public:
    void resolve(const SampleTile& samples, HitBuffer& hits, SampleScratch& scratch,
                 SampleStats& stats) const final;
    BuildStats build_stats() const final;
    int tile_side() const final { return tile_side_; }

  protected:
    /// Tiles of `tile_side` pixels are fastest. With option "cull" on, grids come front to back.
    Rasterizer(const VisibilityInput& input, int tile_side);

    /// Puts what samples see in some grids into scratch.nearest, where every grid is opaque, and else into
    /// scratch.found, too.
    virtual void raster(const SampleTile& samples, const std::vector<uint32_t>& grids, SampleScratch& scratch,
                        SampleStats& stats) const = 0;

    const RenderContext& context() const { return context_; }
    const Camera& camera() const { return context_.camera; }
    const Grid& grid(uint32_t index) const { return grids_.grids[index]; }
    const GridBounds& bounds() const { return bounds_; }
    bool cull() const { return cull_; }
    /// Then the nearest hit of a sample is all of its list.
    bool all_opaque() const { return all_opaque_; }

  private:
    const RenderContext& context_;
    const Grids& grids_;
    int tile_side_;
    bool cull_, all_opaque_;
    TileBins bins_;
    GridBounds bounds_;
};

}  // namespace trapeze
