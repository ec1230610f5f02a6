/// The tiles of a film: where they lie, and which of them wait for which.
#pragma once

#include <algorithm>
#include <atomic>
#include <memory>

#include "composite/film/tile_sums.h"
#include "core/samples.h"

namespace trapeze {

/// Squares of kTileSide pixels over those whose samples count, numbered row by row.
class FilmTiles {
  public:
    struct Tile {
        /// Set by the thread that adds the tile, before it lowers the neighbours' `missing`.
        std::unique_ptr<TileSums> sums;
        /// Tiles that this one's pixels wait for; at 0 they are developed. It falls below where an earlier
        /// run has finished the pixels. 0 from the start: none of them is in the window.
        std::atomic<int> missing{0};
        /// Tiles that have yet to read `sums`; the last one frees them.
        std::atomic<int> readers{0};
        std::atomic<bool> added{false};
        /// inner_pixels() are developed, and never written again but by mattes and deep samples.
        std::atomic<bool> has_inner{false};
        /// The pixels are finished, and never written again; whoever reads this (acquire) may read them.
        std::atomic<bool> finished{false};
    };

    FilmTiles() = default;
    /// `sampled`: the pixels whose samples count; `window`: those that are kept. Samples have a part in
    /// pixels up to (reach_x, reach_y) away from theirs.
    FilmTiles(const PixelRect& sampled, const PixelRect& window, int reach_x, int reach_y);

    int count() const { return columns_ * rows_; }
    Tile& operator[](int tile) { return tiles_[tile]; }
    const Tile& operator[](int tile) const { return tiles_[tile]; }

    /// The tile of a pixel that is in one.
    int of_pixel(int x, int y) const {
        return (tile_of(y) - first_row_) * columns_ + tile_of(x) - first_column_;
    }
    /// All pixels of a tile; those whose samples count; those that are kept.
    PixelRect square(int tile) const;
    PixelRect sampled_pixels(int tile) const { return intersection(square(tile), sampled_); }
    PixelRect kept_pixels(int tile) const { return intersection(sampled_pixels(tile), window_); }
    /// The kept pixels that no other tile's samples have a part in; may be none.
    PixelRect inner_pixels(int tile) const;
    /// Whether samples of tile `from` have a part in pixels of tile `to` that are kept.
    bool reaches(int from, int to) const;

    /// Calls visit(tile) for the tiles that a rectangle has pixels of.
    template <class Visit>
    void for_each_in(const PixelRect& pixels, Visit&& visit) const {
        if (pixels.empty()) return;
        const int last_row = std::min(rows_ - 1, tile_of(pixels.y1 - 1) - first_row_),
                  last_column = std::min(columns_ - 1, tile_of(pixels.x1 - 1) - first_column_);
        for (int row = std::max(0, tile_of(pixels.y0) - first_row_); row <= last_row; ++row)
            for (int column = std::max(0, tile_of(pixels.x0) - first_column_); column <= last_column;
                 ++column)
                visit(row * columns_ + column);
    }
    /// Calls visit(tile) for the tiles around a tile, itself included, in the order of tiles.
    template <class Visit>
    void for_each_neighbour(int tile, Visit&& visit) const {
        const int column = tile % columns_, row = tile / columns_;
        for (int y = std::max(0, row - reach_y_); y <= std::min(rows_ - 1, row + reach_y_); ++y)
            for (int x = std::max(0, column - reach_x_); x <= std::min(columns_ - 1, column + reach_x_); ++x)
                visit(y * columns_ + x);
    }

  private:
    /// Rounds towards minus infinity: samples may lie left of and above the image, as far as the filter
    /// reaches.
    static int tile_of(int pixel) {
        return pixel >= 0 ? pixel / kTileSide : -((kTileSide - 1 - pixel) / kTileSide);
    }

    PixelRect sampled_, window_;
    int reach_pixels_x_ = 0, reach_pixels_y_ = 0;
    int first_column_ = 0, first_row_ = 0, columns_ = 0, rows_ = 0;
    int reach_x_ = 0, reach_y_ = 0;  ///< in tiles
    std::unique_ptr<Tile[]> tiles_;
};

}  // namespace trapeze
