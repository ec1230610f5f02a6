/// Colours and opacities of hits, many at a time: what resolve_layers() composites.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "composite/layers/corner_cache.h"
#include "composite/layers/interpolate_hits.h"
#include "composite/layers/ray_planes.h"
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

/// Layers of hits that lie in a row in a HitBuffer, in planes: all samples' first hits, then their second
/// ones, and so on, since neighbours see the same micropolygons layer by layer. One serves for many rows, and
/// keeps its memory; all are of the same grids, until forget().
class HitLayers {
  public:
    void forget() { corners_.forget(); }

    /// Finds the layers of samples `begin` to `end`, to the bit as layer_at() gives them. A hit on a grid
    /// that is not there gets an undefined layer.
    void interpolate(const SampleTile& samples, const HitBuffer& hits, size_t begin, size_t end,
                     const Grids& grids);

    /// The layer of hit `index` of the buffer.
    Layer operator[](size_t index) const {
        const size_t i = one_each_ ? index - first_ : place_of_[index - first_];
        return {{planes_[0][i], planes_[1][i], planes_[2][i]}, {planes_[3][i], planes_[4][i], planes_[5][i]}};
    }

    /// Whether each of the samples has one hit alone, which hides all behind it whatever its colour. The
    /// planes are then those of the samples.
    bool all_cover() const { return kinds_.all_cover; }
    bool all_plain() const { return kinds_.all_plain; }
    /// Ci or Oi of all hits: plane 0 to kLayerPlanes. kLayerPadding further numbers may be read.
    const float* plane(size_t n) const { return planes_[n].data(); }
    /// Where in the planes each hit is, counted from the first one; empty: in their order, one a sample.
    std::span<const uint32_t> places() const {
        return one_each_ ? std::span<const uint32_t>() : std::span<const uint32_t>(place_of_);
    }

  private:
    void order_by_layer(const Hit* hits, std::span<const uint32_t> first_hits);

    size_t first_ = 0;      ///< number of the first hit whose layer is here
    bool one_each_ = true;  ///< each sample has one hit
    HitKinds kinds_;
    std::vector<float> planes_[kLayerPlanes];
    RayPlanes rays_;
    std::vector<uint32_t> sample_at_;  ///< at each place of the planes
    std::vector<uint64_t> id_at_;      ///< Hit::id
    std::vector<uint32_t> place_of_;   ///< of each hit
    std::vector<uint32_t> next_of_;    ///< places for the next hits of each layer
    CornerCache corners_;
};

}  // namespace trapeze
