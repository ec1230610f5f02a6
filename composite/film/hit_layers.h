/// Colours and opacities of hits, many at a time: what resolve_layers() composites.
#pragma once

#include <vector>

#include "core/grid.h"
#include "core/hit_buffer.h"
#include "core/math.h"
#include "core/samples.h"

namespace trapeze {

/// What a hit's micropolygon shows at the point that the ray meets. The colour is premultiplied by the
/// opacity.
struct Layer {
    V3f color, opacity;
};

/// The layer of one hit, by Reyes shading interpolation (RISpec, ShadingInterpolation): a constant
/// micropolygon has its vertex 00's colour; a smooth one interpolates on the triangle that the predicate
/// found.
Layer layer_at(const AxisRay& ray, const Grid& grid, const MicropolygonId& id);

/// Layers of hits that lie in a row in a HitBuffer, in planes. One serves for many rows, and keeps its
/// memory.
class HitLayers {
  public:
    /// Finds the layers of samples `begin` to `end`, to the bit as layer_at() gives them. A hit on a grid
    /// that is not there gets an undefined layer.
    void interpolate(const SampleTile& samples, const HitBuffer& hits, size_t begin, size_t end,
                     const Grids& grids);

    /// The layer of hit `index` of the buffer.
    Layer operator[](size_t index) const {
        const size_t i = index - first_;
        return {{planes_[0][i], planes_[1][i], planes_[2][i]}, {planes_[3][i], planes_[4][i], planes_[5][i]}};
    }

    V3f color(size_t index) const {
        const size_t i = index - first_;
        return {planes_[0][i], planes_[1][i], planes_[2][i]};
    }

  private:
    void put(size_t place, const Layer& layer) {
        for (int c = 0; c < 3; ++c) {
            planes_[c][place] = layer.color[c];
            planes_[3 + c][place] = layer.opacity[c];
        }
    }

    size_t first_ = 0;              ///< number of the first hit whose layer is here
    std::vector<float> planes_[6];  ///< Ci, Oi; whole vectors can be written
};

}  // namespace trapeze
