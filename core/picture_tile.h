/// Tiles that a picture is rendered in by several runs of the program. (The tiles that a run works through,
/// of kTileSide, are another matter.)
#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "core/pixel_rect.h"

namespace trapeze {

/// Columns and rows that a picture may be divided into, at most: tiles of 16 pixels of the largest picture.
inline constexpr int kMostTilesOfSide = 4096;

/// A cell of a grid laid over the picture's crop.
struct PictureTile {
    int columns = 1, rows = 1;  ///< of the grid, each from 1 to kMostTilesOfSide
    int number = 1;             ///< from 1, row by row from the top, each from the left

    int count() const { return columns * rows; }
    bool operator==(const PictureTile&) const = default;
};

/// "3 of 4x2": as files call their tile.
std::string name_of(const PictureTile& tile);

/// Reads such a name; nothing for any other text.
std::optional<PictureTile> tile_named(std::string_view name);

/// The name of a tile's file. The number, with leading zeros as the last one's, takes the place of "<tile>"
/// in the name, "shot.<tile>.exr"; else it comes before the ending: "shot.exr" becomes "shot.tile03.exr".
std::string with_tile_number(const std::string& name, const PictureTile& tile);

/// Whether the crop has pixels for all tiles of the grid.
bool can_divide(const PixelRect& crop, const PictureTile& tile);

/// The tile's pixels. Every pixel of the crop is in one tile; the widths of two tiles differ by a pixel at
/// most, and so do their heights. Empty only where the crop cannot be divided.
PixelRect part_of(const PixelRect& crop, const PictureTile& tile);

}  // namespace trapeze
