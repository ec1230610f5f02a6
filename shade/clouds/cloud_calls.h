/// The shading language's bake3d() and texture3d(), and its occlusion() and indirectdiffuse() by clouds.
#pragma once

#include <memory>
#include <span>
#include <vector>

#include "core/scene/shading_grid.h"
#include "shade/clouds/cloud_bakes.h"
#include "shade/clouds/cloud_library.h"
#include "shade/clouds/point_based_call.h"
#include "shade/vm/context.h"

namespace trapeze {

/// Where calls look and bake; null: nowhere.
struct CloudPlaces {
    CloudLibrary* clouds = nullptr;
    CloudBakes* bakes = nullptr;  ///< null for what rays hit
    SceneSurfels* scene = nullptr;
    bool of_discs = false;  ///< calls are of the shaders of the scene's discs
};

/// Carries out the calls of the shaders of one batch of grids, in one thread. All it refers to must outlive
/// it.
class CloudCalls : public vm::Clouds {
  public:
    explicit CloudCalls(const CloudPlaces& places) : places_(places) {}

    /// The grids of the run that begins; those of a run that does not bake have none.
    void set_grids(std::span<const ShadingGrid* const> grids) { grids_ = grids; }

    void look_up(vm::Run& run, const vm::Step& step, std::span<const vm::Operand> operands) override;
    void bake(vm::Run& run, const vm::Step& step, std::span<const vm::Operand> operands) override;
    bool over_discs(vm::Run& run, const vm::Step& step, std::span<const vm::Operand> operands) override;

    /// Hands on what has been baked.
    void finish();

  private:
    CloudPlaces places_;
    std::span<const ShadingGrid* const> grids_;
    std::vector<BakedGrid> baked_;  ///< in the order of grids_
    std::vector<CloudShare> shares_;
    std::unique_ptr<PointBasedScratch> discs_;  ///< null until it is needed
};

}  // namespace trapeze
