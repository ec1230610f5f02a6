#include "composite/layers/seen_layers.h"

#include <algorithm>

#include "composite/layers/walk_layers.h"

namespace trapeze {

void see_layers(const AxisRay& ray, std::span<const Hit> hits, const Grids& grids, V3f& transmission,
                std::vector<SeenLayer>& layers) {
    walk_layers(ray, hits, grids, transmission,
                [&](const Hit& hit, const MicropolygonId&, const Grid& grid, const Layer& layer) {
                    SeenLayer seen{hit.depth, grid.primitive};
                    V3f alpha(0);
                    for (int c = 0; c < 3; ++c) {
                        if (!grid.matte) seen.rgba[c] = transmission[c] * layer.color[c];
                        if (grid.matte != 1) alpha[c] = transmission[c] * hiding(layer, c);
                    }
                    seen.rgba[3] = mean_of_channels(alpha);
                    const bool shows = std::ranges::any_of(seen.rgba, [](float v) { return v != 0; });
                    if (shows) layers.push_back(seen);
                });
}

}  // namespace trapeze
