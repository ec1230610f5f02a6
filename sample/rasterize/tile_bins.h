/// Which grids may be seen in which part of the picture: what rasterizers begin with.
#pragma once

#include <cstdint>
#include <vector>

#include "core/grid.h"
#include "core/scene/camera.h"
#include "sample/swept_bound.h"

namespace trapeze {

/// Square tiles over the camera's crop, anchored at multiples of their side, each with the grids whose swept,
/// lens-grown box reaches it. The tiles at the border take what lies beyond it, so that no part of the raster
/// is left out.
class TileBins {
  public:
    /// In parallel; the same for any number of threads. `tile_side` in pixels.
    TileBins(const Camera& camera, const Grids& grids, int tile_side);

    /// Sets `found` to the indices of the grids that samples of some pixels may see, ascending.
    void find(const PixelRect& pixels, std::vector<uint32_t>& found) const;

    const RasterBox& box(uint32_t grid) const { return boxes_[grid]; }
    size_t bytes() const;

  private:
    /// From the first to the last, both included.
    struct Span {
        int first, last;  ///< tiles along an axis, inclusive; empty when first > last
    };
    /// The tiles along an axis that a range of the raster reaches, those at the border for what lies beyond.
    static Span span(double min, double max, int origin, int side, int count);
    Span columns(double min, double max) const { return span(min, max, area_.x0, side_, columns_); }
    Span rows(double min, double max) const { return span(min, max, area_.y0, side_, rows_); }
    /// Looks at all grids for one row of bins; rows are filled in parallel.
    void fill_row(int row);

    PixelRect area_;  ///< the crop, from its first tile's corner
    int side_, columns_, rows_;
    std::vector<RasterBox> boxes_;
    std::vector<std::vector<uint32_t>> tiles_;  ///< row by row; indices of grids, ascending
};

}  // namespace trapeze
