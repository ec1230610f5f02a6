/// The footprints of grids' vertices: micropolygons, stretched to a pixel where they are seen thinner than
/// that, or than the shading rate asks for if it is below a pixel. A floor that leads away from the eye has
/// micropolygons that are slivers of a pixel, askew between lines that meet at the horizon: lookups that
/// covered only them would alias.
#pragma once

#include <memory>
#include <span>

#include "core/scene/camera.h"
#include "core/scene/shading_grid.h"
#include "shade/planes/planes.h"
#include "shade/vm/footprint.h"

namespace trapeze {

/// Finds footprints when first asked for them. The grids lie side by side in the lanes, and are to stay as
/// they are meanwhile.
class GridFootprints : public vm::Footprints {
  public:
    /// Not `stretched`: footprints are the micropolygons as they are, which is what displacement shaders
    /// take. What is yet to be moved may lie to the eye in any way.
    GridFootprints(std::span<const ShadingGrid* const> grids, const Camera& camera, bool stretched = true)
        : grids_(grids), camera_(camera), stretched_(stretched) {}

    const vm::Footprint& get() override;

  private:
    void find(const ShadingGrid& grid, size_t first);

    const std::span<const ShadingGrid* const> grids_;
    const Camera& camera_;
    const bool stretched_;
    PlanePool pool_;
    Plane u_, v_, u_of_a_, v_of_a_, u_of_b_, v_of_b_, du_, dv_, widening_, thin_;
    vm::Footprint footprint_;
    bool found_ = false;
};

}  // namespace trapeze
