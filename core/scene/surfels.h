/// Surface as discs: what point-based occlusion looks at instead of the surface itself.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "core/math.h"

namespace trapeze {

/// A piece of surface, corner after corner around it.
using SurfelQuad = std::array<V3f, 4>;

/// Structure of arrays, all of one space and of one length, but for those that may be empty.
struct Surfels {
    std::vector<V3f> positions;
    std::vector<V3f> normals;  ///< of unit length, on the front; zero where a disc faces all sides
    std::vector<float> areas;  ///< above zero; less than they have where light shines through
    /// Of what is seen through them, what they hide; empty: all. A disc has areas / opacities.
    std::vector<float> opacities;
    std::vector<uint64_t> ids;      ///< what RayScene::dice_surfel() finds their places by; may be empty
    std::vector<SurfelQuad> quads;  ///< the surface that they stand for; empty: it is not known
    std::vector<V3f> radiosities;   ///< what they send, as colours of surfaces are; empty: nothing is known

    size_t size() const { return positions.size(); }
    size_t bytes() const {
        return (positions.capacity() + normals.capacity() + radiosities.capacity()) * sizeof(V3f) +
               (areas.capacity() + opacities.capacity()) * sizeof(float) +
               quads.capacity() * sizeof(SurfelQuad) + ids.capacity() * sizeof(uint64_t);
    }
};

}  // namespace trapeze
