/// The layers of what a sample sees, one by one, as far as they reach the eye: what mattes and deep pictures
/// are made of, while the picture has their sum.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/grid.h"
#include "core/hit_buffer.h"
#include "core/math.h"
#include "core/rays.h"

namespace trapeze {

/// What a layer adds to its sample: colour and alpha, by what the layers before it let through. The sums over
/// a sample's layers are its resolve_layers(), but for rounding.
struct SeenLayer {
    float depth = 0;
    uint32_t primitive = 0;
    float rgba[4] = {0, 0, 0, 0};
};

/// Appends the layers of a sample's next hits, front to back; those that add nothing are left out.
/// `transmission` is what reaches the hits, 1 at first.
void see_layers(const AxisRay& ray, std::span<const Hit> hits, const Grids& grids, V3f& transmission,
                std::vector<SeenLayer>& layers);

}  // namespace trapeze
