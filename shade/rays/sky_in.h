/// What is behind everything that rays and discs may meet: a map of the sky ("environmentmap").
#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "shade/vm/machine.h"

namespace trapeze {

/// Colours of a map in directions of the current space, each averaged over a width (radians): its own, or one
/// for all. `space`: the map's; none: the current one. Black where there is no map.
std::vector<V3f> sky_in(vm::Run& run, const vm::Step& step, std::string_view map, const std::string& space,
                        std::vector<V3f> directions, std::span<const float> widths);

}  // namespace trapeze
