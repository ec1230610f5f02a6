/// A halberd of subdivision surfaces, upright along y, the grip about the origin: from kHalberdButt to
/// kHalberdTip. The axe's blade is on the side of x, flat to z.
#pragma once

#include "pipeline/study/scenes/rib_writer.h"

namespace trapeze::scenes {

/// Both ends along y, in the model's units.
inline constexpr double kHalberdButt = -3.3, kHalberdTip = 6.7;

void write_halberd(RibWriter& rib);

}  // namespace trapeze::scenes
