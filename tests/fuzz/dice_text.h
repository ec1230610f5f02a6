/// What the targets that make primitives share.
#pragma once

#include <string>

namespace trapeze::fuzz {

/// Reads what stands in a world, splits and dices its primitives and packs the grids. Aborts when a packed
/// position is not finite.
void dice_world(const std::string& world);

}  // namespace trapeze::fuzz
