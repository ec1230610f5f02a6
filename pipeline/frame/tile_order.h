/// In which order the tiles of a frame are sampled. It changes no bit of the picture.
#pragma once

#include <span>
#include <vector>

#include "core/pixel_rect.h"

namespace trapeze {

enum class TileOrder {
    Rows,        ///< the least sums wait for their neighbours
    CoarseFirst  ///< tiles far from each other first, then those between, for whoever is watching
};

/// Tiles that follow each other row by row, in coarse order: every eighth of every eighth row, then every
/// fourth, second, all; each once, row by row within such a round.
std::vector<PixelRect> coarse_first(std::span<const PixelRect> tiles);

}  // namespace trapeze
