/// One call of occlusion() or indirectdiffuse() with "pointbased" 1: discs of a cloud instead of rays
/// [Christensen08].
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "shade/clouds/cloud_library.h"
#include "shade/clouds/scene_surfels.h"
#include "shade/clouds/surfel_raster.h"
#include "shade/clouds/surfel_tree.h"
#include "shade/rays/asking_lanes.h"
#include "shade/rays/ray_arguments.h"
#include "shade/vm/machine.h"

namespace trapeze {

/// A thread's memory for calls.
struct PointBasedScratch {
    std::vector<SurfelPiece> pieces;
    SurfelRaster raster;
    std::vector<V3f> ways;  ///< in which the sky is seen
    std::vector<float> parts;
};

class PointBasedCall {
  public:
    /// Reports, by the run, what is wrong. Without a library no cloud is found. `scene`: whose discs are
    /// asked where the call names no file; null: nobody's. Shaders of these discs are not told their colours.
    PointBasedCall(vm::Run& run, const vm::Step& step, std::span<const vm::Operand> operands,
                   CloudLibrary* library, SceneSurfels* scene, bool of_discs);

    /// False where the call asks for rays, or for a cloud that there is not.
    bool is_answered() const { return tree_ != nullptr; }
    /// Sets the result and the outputs of the lanes that run; only of a call that is answered.
    void run(PointBasedScratch& scratch) const;

  private:
    const SurfelTree* find_cloud(CloudLibrary& library) const;
    const SurfelTree* find_scene(SceneSurfels* scene, bool of_discs) const;
    const SurfelTree* use_rays(const std::string& why) const;
    bool set_space();
    void look(size_t lane, const V3f& aside, PointBasedScratch& scratch) const;
    void add(const SurfelPiece& piece, const SurfelPlace& place, size_t lane, SurfelRaster& raster) const;
    V3f sky_over(size_t lane, PointBasedScratch& scratch) const;
    void put(const AskingLane& lanes, const SurfelRaster& raster, const V3f& sky) const;
    const SkyPart& sky_of(size_t lane) const;

    vm::Run& run_;
    const vm::Step& step_;
    std::span<const vm::Operand> operands_;
    const RayArguments arguments_;
    const SurfelTree* tree_ = nullptr;
    bool moved_ = false;  ///< the cloud's space is another than the current one
    M44f to_space_, normals_to_space_, from_space_;
    float scale_ = 1;  ///< lengths in the cloud's space, of one in the current space
    mutable std::optional<SkyPart> sky_;
    mutable float sky_angle_ = 0;
};

}  // namespace trapeze
