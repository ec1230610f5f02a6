/// The footprints of grids' vertices: micropolygons, stretched to a pixel where they are seen thinner than
/// that, or than the shading rate asks for if it is below a pixel. A floor that leads away from the eye has
/// micropolygons that are slivers of a pixel, askew between lines that meet at the horizon: lookups that
/// covered only them would alias. Of what a ray has hit they are as large as the ray is there, up to where
/// the rays beside it meet the surface [Igehy99].
#pragma once

#include <memory>
#include <span>

#include "core/scene/camera.h"
#include "core/scene/shading_grid.h"
#include "shade/footprint_stretch.h"
#include "shade/planes/planes.h"
#include "shade/vm/footprint.h"

namespace trapeze {

/// How far the parameters (u, v) go from a vertex to the next along each of a grid's axes.
struct ParameterSteps {
    V2f along_u, along_v;
};

/// Finds footprints when first asked for them. The grids lie side by side in the lanes, and are to stay as
/// they are meanwhile.
class GridFootprints : public vm::Footprints {
  public:
    /// Not `stretched`: footprints are the micropolygons as they are, which is what displacement shaders
    /// take. What is yet to be moved may lie to the eye in any way, and is the same to all rays.
    GridFootprints(std::span<const ShadingGrid* const> grids, const Camera& camera, bool stretched = true)
        : grids_(grids), camera_(camera), stretched_(stretched) {}

    const vm::Footprint& get() override;

  private:
    void find(const ShadingGrid& grid, size_t first);
    void stretch_to_pixels(const ShadingGrid& grid, size_t piece, size_t lane, const ParameterSteps& step);
    void stretch_to_ray(const ShadingGrid& grid, size_t piece, size_t lane, const ParameterSteps& step);
    void put(size_t lane, const ParameterSteps& step, const Stretch& stretch);

    const std::span<const ShadingGrid* const> grids_;
    const Camera& camera_;
    const bool stretched_;
    PlanePool pool_;
    Plane u_, v_, u_of_a_, v_of_a_, u_of_b_, v_of_b_, du_, dv_, uu_, uv_, vv_, widening_, thin_;
    vm::Footprint footprint_;
    bool found_ = false;
};

}  // namespace trapeze
