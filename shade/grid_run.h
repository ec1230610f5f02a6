/// The shaders of a material over a batch of grids: displacement, surface, atmosphere.
#pragma once

#include <span>
#include <vector>

#include "core/scene/aov.h"
#include "shade/displace.h"
#include "shade/grid_messages.h"
#include "shade/maps/map_service.h"
#include "shade/materials/material.h"
#include "shade/weld.h"

namespace trapeze {

/// A thread's memory for runs.
struct GridRunScratch {
    PlanePool pool;
    vm::Machine machine;
    LightRig lights;
};

/// Whether shaders may run over both grids at once: their uniform variables, which a run has one value of,
/// are the same, and so is the primitive, as far as the material asks.
bool can_share_run(const Material& material, const ShadingGrid& a, const ShadingGrid& b);

class GridRun {
  public:
    /// The grids can share a run, each with each. All must outlive this.
    GridRun(const RenderContext& context, Textures& textures, const Material& material,
            std::span<ShadingGrid* const> grids, GridRunScratch& scratch);

    /// `aovs` are those that the grids are to carry.
    void run(const AovLayout& aovs);

  private:
    using LayerRegisters = std::vector<vm::Registers*>;

    /// Shades points, which are those of `grids`; returns the layer's registers.
    vm::Registers& run_layer(const LayeredShader& shader, size_t layer,
                             std::span<const ShadingGrid* const> grids, const vm::Batch& batch, bool shaded,
                             LayerRegisters& layers);
    // These return the layers' layers.
    LayerRegisters displace();
    LayerRegisters color(const LayeredShader& shader, bool shaded, const vm::Registers*& announced);
    void move_borders(const LayeredShader& shader);
    void move_grids(const vm::Registers& registers);
    void note_moves(const vm::Registers& registers);

    const RenderContext& context_;
    const Material& material_;
    const std::span<ShadingGrid* const> grids_;
    const std::vector<const ShadingGrid*> read_;  ///< the same, to be read
    GridRunScratch& scratch_;
    MapService maps_;
    GridMessages messages_;
    const vm::Batch batch_;
};

}  // namespace trapeze
