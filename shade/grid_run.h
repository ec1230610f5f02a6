/// The shaders of a material over a batch of grids: displacement, surface, atmosphere.
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "core/scene/aov.h"
#include "shade/clouds/cloud_calls.h"
#include "shade/displace.h"
#include "shade/grid_messages.h"
#include "shade/maps/map_service.h"
#include "shade/materials/material.h"
#include "shade/rays/ray_calls.h"
#include "shade/weld.h"

namespace trapeze {

/// A thread's memory for runs.
struct GridRunScratch {
    PlanePool pool;
    vm::Machine machine;
    LightRig lights;
};

/// Whether shaders may run over both grids at once: what a run has one value of, their uniform variables and
/// what rays bring along, is the same, and so is the primitive, as far as the material asks. `left`: as of
/// GridRun.
bool can_share_run(const Material& material, const Material* left, const ShadingGrid& a,
                   const ShadingGrid& b);

/// One run of a material's shaders over a batch of grids: what the machine's lanes, the lights and the
/// messages are set up for.
class GridRun {
  public:
    /// The grids can share a run (can_share_run()), each with each. All must outlive this.
    /// Without `rays` shaders that trace find nothing; without `clouds` they neither look up nor bake.
    /// `left`: of the surface that rays have left to hit the grids, through a medium that it has a shader for
    /// (ShadingGrid::medium); else null.
    GridRun(const RenderContext& context, Textures& textures, const Material& material,
            std::span<ShadingGrid* const> grids, GridRunScratch& scratch, const RayService* rays = nullptr,
            const CloudPlaces& clouds = {}, const Material* left = nullptr);

    /// Displaces the grids at all keys, sets Ci and Oi, fills the output variables `aovs`, and answers what
    /// is asked of hits.
    Task<> run(const AovLayout& aovs, const HitOutputs* asked = nullptr);
    /// Displaces the grids alone.
    Task<> run_displacement();

  private:
    using Layers = std::vector<vm::Registers*>;

    /// Runs one layer on `grids`, whose lanes `batch` describes; `shaded`: Ci and Oi begin as the grids have
    /// them. Adds the layer's registers to `layers` and returns them.
    /// How much of a layer is run.
    enum class Part : uint8_t { All, Parameters };
    Task<> announce_volume(const LayeredShader& shader);
    Task<vm::Registers*> run_layer(const LayeredShader& shader, size_t layer,
                                   std::span<const ShadingGrid* const> grids, const vm::Batch& batch,
                                   bool shaded, Layers& layers, Part part = Part::All);
    // These return the registers of all layers of their shader.
    Task<Layers> displace();
    Task<Layers> run_surface();
    Task<Layers> displace_seen();
    Task<Layers> color(const LayeredShader& shader, bool shaded, const vm::Registers*& announced);
    Task<> move_borders(const LayeredShader& shader);
    void move_grids(const vm::Registers& registers);
    const LayeredShader* volume() const;
    void set_own_colors();
    Task<> split_light(const AovLayout& aovs);
    void note_moves(const vm::Registers& registers);

    const RenderContext& context_;
    const Material& material_;
    const Material* const left_;
    const std::span<ShadingGrid* const> grids_;
    const std::vector<const ShadingGrid*> read_;  ///< grids_ again, as functions that only read want them
    GridRunScratch& scratch_;
    MapService maps_;
    CloudCalls clouds_;
    GridMessages messages_;
    std::optional<RayCalls> rays_;
    const vm::Batch batch_;
    /// The lights that shine while light is split, and nothing is baked; else null.
    const std::vector<const Lamp*>* group_lamps_ = nullptr;
};

}  // namespace trapeze
