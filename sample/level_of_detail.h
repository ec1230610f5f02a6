/// What samples see of levels of detail in transition (core/scene/level_of_detail.h): hits on levels that are
/// not theirs are taken out of finished lists, alike for all methods.
#pragma once

#include <memory>

#include "core/scene/level_of_detail.h"
#include "sample/visibility.h"

namespace trapeze {

/// In [0, 1): spread evenly over a pixel's samples, and apart from what pixels nearby have. Of the pixel and
/// the sample's place in it alone.
float detail_number(uint32_t seed, int px, int py, int sample);

/// A method whose samples see their own levels; the method itself when the scene has none in transition.
/// Grids of those are to be packed as not opaque: what is behind them must be found too.
std::unique_ptr<Visibility> with_levels_of_detail(std::unique_ptr<Visibility> method,
                                                  const RenderContext& context, const Grids& grids);

}  // namespace trapeze
