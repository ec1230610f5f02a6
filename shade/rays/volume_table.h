/// Which primitives have volume shaders for rays.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/scene/scene.h"
#include "core/scene/shading_grid.h"

namespace trapeze {

/// Empty where no primitive has any: rays then need not know what they go through.
class VolumeTable {
  public:
    /// `primitives`: the scene's, which must outlive it.
    explicit VolumeTable(std::span<const Primitive> primitives) : primitives_(primitives) {}

    bool empty() const { return of_primitive_.empty(); }
    /// Whether there is a shader for what a ray goes through.
    bool has(const RayMedium& medium) const {
        return medium.primitive < of_primitive_.size() &&
               (of_primitive_[medium.primitive] & (medium.inside ? kInterior : kExterior)) != 0;
    }
    /// Whether any thing has a shader of its inside.
    bool has_insides() const { return has_insides_; }
    const Primitive& primitive(uint32_t number) const { return primitives_[number]; }
    void add(uint32_t primitive, bool interior, bool exterior) {
        if (!interior && !exterior) return;
        has_insides_ = has_insides_ || interior;
        if (of_primitive_.size() <= primitive) of_primitive_.resize(primitive + size_t{1});
        of_primitive_[primitive] =
            static_cast<uint8_t>((interior ? kInterior : 0) | (exterior ? kExterior : 0));
    }

  private:
    static constexpr uint8_t kInterior = 1, kExterior = 2;
    std::span<const Primitive> primitives_;
    std::vector<uint8_t> of_primitive_;
    bool has_insides_ = false;
};

}  // namespace trapeze
