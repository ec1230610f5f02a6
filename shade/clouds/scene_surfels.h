/// The scene itself as discs, for occlusion() and indirectdiffuse() with "pointbased" 1 that name no file
/// [Christensen08].
#pragma once

#include <functional>
#include <memory>
#include <mutex>
#include <span>
#include <string>

#include "shade/clouds/cloud_library.h"
#include "shade/clouds/surfel_tree.h"
#include "shade/rays/ray_walk.h"

namespace trapeze {

/// Shades grids of discs: sets Ci. Of one thread.
using ShadeSurfels = std::function<void(std::span<ShadingGrid* const>, const HitVisit&)>;
using MakeSurfelShader = std::function<ShadeSurfels()>;

/// What diffuse rays meet. Discs are made when they are first asked for, and get colours when these are. All
/// that ask meanwhile help. Thread-safe.
class SceneSurfels {
  public:
    /// Memory is the library's, which outlives this.
    explicit SceneSurfels(CloudLibrary& library);
    ~SceneSurfels();

    /// To be called before anything is asked.
    void set_scene(const RayScene* scene, MakeSurfelShader make_shader);
    bool has_scene() const { return scene_ != nullptr; }

    /// Null, and why, where they take too much memory; what is found lives as long as this.
    const SurfelTree* find(std::string* problem);
    /// The same tree, of which radiosity() may be asked: what either side sends towards its normal, by direct
    /// light. Never to be called by the shaders of discs.
    const SurfelTree* find_colored(std::string* problem);

    /// Discs are shaded anew when they are next asked for. To be called while nobody asks.
    void forget_colors();

  private:
    struct Coloring;
    void take_colors(Coloring& coloring);

    CloudLibrary& library_;
    const RayScene* scene_ = nullptr;
    MakeSurfelShader make_shader_;
    std::mutex tree_mutex_, color_mutex_;
    std::unique_ptr<SurfelTree> tree_;
    std::shared_ptr<Coloring> coloring_;  ///< null until colours are asked for
    std::string tree_problem_, color_problem_;
};

}  // namespace trapeze
