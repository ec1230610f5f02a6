#include "composite/film/seen_layers.h"

#include <algorithm>

#include "composite/film/hit_layers.h"

namespace trapeze {

void see_layers(const AxisRay& ray, std::span<const Hit> hits, const Grids& grids, V3f& transmission,
                std::vector<SeenLayer>& layers) {
    for (const Hit& hit : hits) {
        if (transmission == V3f(0)) return;
        const MicropolygonId id = MicropolygonId::unpack(hit.id);
        if (id.grid >= grids.grids.size()) continue;
        const Grid& grid = grids.grids[id.grid];
        const Layer layer = layer_at(ray, grid, id);
        SeenLayer seen{hit.depth, grid.primitive};
        V3f alpha(0);
        for (int c = 0; c < 3; ++c) {
            const float opacity = std::clamp(layer.opacity[c], 0.0f, 1.0f);
            if (!grid.matte) seen.rgba[c] = transmission[c] * layer.color[c];
            if (grid.matte != 1) alpha[c] = transmission[c] * opacity;
            transmission[c] *= 1 - opacity;
        }
        const bool gray = alpha.x == alpha.y && alpha.y == alpha.z;
        seen.rgba[3] = gray ? alpha.x : (alpha.x + alpha.y + alpha.z) / 3;
        if (std::ranges::any_of(seen.rgba, [](float value) { return value != 0; })) layers.push_back(seen);
    }
}

}  // namespace trapeze
