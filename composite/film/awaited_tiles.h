/// Where a film still waits for samples: what a frame that goes on has left to do.
#pragma once

#include <cstdint>
#include <vector>

#include "core/pixel_rect.h"

namespace trapeze {

class FilmTiles;

/// A set of tiles, with sums over all of its corners, so that a rectangle is asked about in no time.
class AwaitedTiles {
  public:
    /// The tiles that have not been added.
    explicit AwaitedTiles(const FilmTiles& tiles);

    /// Whether a rectangle has pixels of such a tile.
    bool meet(const PixelRect& pixels) const;
    /// The smallest part of a rectangle that has all that it shares with such tiles; empty: nothing.
    PixelRect bound(const PixelRect& pixels) const;

  private:
    /// Tiles by columns and rows, in place of pixels.
    PixelRect tiles_in(const PixelRect& pixels) const;
    uint32_t count_in(const PixelRect& tiles) const;
    uint32_t sum(int column, int row) const {
        return sums_[static_cast<size_t>(row) * (columns_ + 1) + static_cast<size_t>(column)];
    }

    PixelRect pixels_;  ///< of all tiles
    size_t columns_ = 0;
    std::vector<uint32_t> sums_;  ///< of awaited tiles left of a column and above a row
};

}  // namespace trapeze
