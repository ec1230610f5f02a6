/// Walks over what a sample sees, layer by layer, front to back, as far as something reaches the next one.
#pragma once

#include <algorithm>
#include <span>

#include "composite/layers/hit_layers.h"
#include "core/grid.h"
#include "core/hit_buffer.h"
#include "core/math.h"
#include "core/rays.h"

namespace trapeze {

/// How much of what is behind a layer its opacity hides, in one channel: 0 to 1.
inline float hiding(const Layer& layer, int channel) {
    return std::clamp(layer.opacity[channel], 0.0f, 1.0f);
}

/// Calls visit(hit, id, grid, layer) for a sample's next hits; `transmission` is what reaches them, 1 at
/// first, and during a call what reaches its hit.
template <class Visit>
void walk_layers(const AxisRay& ray, std::span<const Hit> hits, const Grids& grids, V3f& transmission,
                 const Visit& visit) {
    for (const Hit& hit : hits) {
        if (transmission == V3f(0)) return;
        const MicropolygonId id = MicropolygonId::unpack(hit.id);
        if (id.grid >= grids.grids.size()) continue;
        const Grid& grid = grids.grids[id.grid];
        const Layer layer = layer_at(ray, grid, id);
        visit(hit, id, grid, layer);
        for (int c = 0; c < 3; ++c) transmission[c] *= 1 - hiding(layer, c);
    }
}

}  // namespace trapeze
