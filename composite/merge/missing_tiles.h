/// What of a picture is in none of its tiles.
#pragma once

#include <string>
#include <vector>

#include "core/math.h"
#include "core/picture_tile.h"

namespace trapeze {

/// The numbers that the grid has and `tiles`, of one grid, lack; in order.
std::vector<int> missing_numbers(const std::vector<PictureTile>& tiles);

/// Parts of the smallest window around all windows that are in none of them, from the top and the left; at
/// most `most` of them. None overlap.
std::vector<Box2i> gaps_between(const std::vector<Box2i>& windows, size_t most);

/// "3, 5 to 8 and 11".
std::string listed(const std::vector<int>& numbers);

}  // namespace trapeze
