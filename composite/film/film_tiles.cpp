#include "composite/film/film_tiles.h"

namespace trapeze {

FilmTiles::FilmTiles(const PixelRect& sampled, const PixelRect& window, int reach_x, int reach_y)
    : sampled_(sampled),
      window_(window),
      reach_pixels_x_(reach_x),
      reach_pixels_y_(reach_y),
      first_column_(tile_of(sampled.x0)),
      first_row_(tile_of(sampled.y0)),
      columns_(tile_of(sampled.x1 - 1) + 1 - first_column_),
      rows_(tile_of(sampled.y1 - 1) + 1 - first_row_),
      reach_x_((reach_x + kTileSide - 1) / kTileSide),
      reach_y_((reach_y + kTileSide - 1) / kTileSide),
      tiles_(std::make_unique<Tile[]>(count())) {
    for (int tile = 0; tile < count(); ++tile)
        for_each_neighbour(tile, [&](int from) {
            if (!reaches(from, tile)) return;
            tiles_[tile].missing.fetch_add(1, std::memory_order_relaxed);
            tiles_[from].readers.fetch_add(1, std::memory_order_relaxed);
        });
}

PixelRect FilmTiles::square(int tile) const {
    const int x = (first_column_ + tile % columns_) * kTileSide,
              y = (first_row_ + tile / columns_) * kTileSide;
    return {x, y, x + kTileSide, y + kTileSide};
}

PixelRect FilmTiles::inner_pixels(int tile) const {
    PixelRect inner = square(tile);
    const int column = tile % columns_, row = tile / columns_;
    if (column > 0) inner.x0 += reach_pixels_x_;
    if (column < columns_ - 1) inner.x1 -= reach_pixels_x_;
    if (row > 0) inner.y0 += reach_pixels_y_;
    if (row < rows_ - 1) inner.y1 -= reach_pixels_y_;
    // A filter wider than a tile reaches past the next one.
    const bool reaches_far = reach_pixels_x_ > kTileSide || reach_pixels_y_ > kTileSide;
    return reaches_far ? PixelRect{} : intersection(inner, kept_pixels(tile));
}

bool FilmTiles::reaches(int from, int to) const {
    const PixelRect p = sampled_pixels(from);
    const PixelRect reached{p.x0 - reach_pixels_x_, p.y0 - reach_pixels_y_, p.x1 + reach_pixels_x_,
                            p.y1 + reach_pixels_y_};
    return !intersection(reached, kept_pixels(to)).empty();
}

}  // namespace trapeze
