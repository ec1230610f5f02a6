/// The tiles of a rectangle of pixels, and in which order they are sampled. It changes no bit of the picture.
#pragma once

#include <span>
#include <vector>

#include "core/pixel_rect.h"
#include "core/samples.h"

namespace trapeze {

/// The next multiple of a tile's `side` at or below a pixel, which may be negative.
int tile_begin(int pixel, int side);

/// The tiles of a rectangle: `side` pixels wide, anchored at multiples of it (negative ones too), cut by the
/// rectangle.
std::vector<PixelRect> tiles_of(const PixelRect& pixels, int side = kTileSide);

enum class TileOrder {
    Rows,        ///< the least sums wait for their neighbours
    CoarseFirst  ///< tiles far from each other first, then those between, for whoever is watching
};

/// Tiles that follow each other row by row, in coarse order: every eighth of every eighth row, then every
/// fourth, second, all; each once, row by row within such a round.
std::vector<PixelRect> coarse_first(std::span<const PixelRect> tiles);

}  // namespace trapeze
