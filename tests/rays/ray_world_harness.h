/// Scenes whose rays are asked without a picture.
#pragma once

#include <optional>
#include <random>
#include <string>

#include "core/scene/ray_scene.h"
#include "pipeline/rays/ray_world.h"
#include "shade/shading.h"
#include "tests/rays/rays_harness.h"

namespace trapeze::testing {

/// Of levels there are the more the finer the picture is: with this one up to 2.
inline const std::string kLevels = "Option \"trace\" \"int levels\" 4 Format 256 256 1 ";

/// What rays meet in a scene of one world.
class RayWorldScene {
  public:
    explicit RayWorldScene(const std::string& things, const std::string& options = kLevels,
                           size_t bytes = size_t{1} << 30) {
        const WorkFolder folder;
        folder.write("asks.sl", "surface asks() { Ci = occlusion(P, N, 1); Oi = Os; }");
        folder.write("a.rib", kPicture + options + "Option \"searchpath\" \"string shader\" [\"" +
                                  folder.path().string() + "\"] WorldBegin " + kSeen + "Surface \"asks\" " +
                                  things + "\nWorldEnd\n");
        const std::vector<std::string> files{(folder / "a.rib").string()};
        read_rib(files, ReadOptions{}, diagnostics_, [&](Scene&& scene) { scene_ = std::move(scene); });
        context_ = make_context(*scene_, settings_, diagnostics_);
        shading_.emplace(context_, *settings_.access);
        world_.emplace(context_, *shading_, bytes);
        shading_->set_rays(&*world_);
        EXPECT_EQ(diagnostics_.count(Severity::Error), 0);
    }

    const RayWorld& world() const { return *world_; }
    const Scene& scene() const { return *scene_; }
    const RenderContext& context() const { return context_; }
    const Shading& shading() const { return *shading_; }

  private:
    Diagnostics diagnostics_;
    RenderSettings settings_;
    std::optional<Scene> scene_;
    RenderContext context_;
    std::optional<Shading> shading_;
    std::optional<RayWorld> world_;
};

/// RayNumbers that are the same on each run.
class RayNumbers {
  public:
    float operator()(float low, float high) {
        return std::uniform_real_distribution<float>(low, high)(bits_);
    }
    /// Braces: drawn in the same order whatever the compiler.
    V3f in_cube(float side) { return V3f{(*this)(-1, 1), (*this)(-1, 1), (*this)(-1, 1)} * side; }

  private:
    std::minstd_rand bits_;
};

inline RaySegment ray_to(const V3f& from, const V3f& way, float spread) {
    RaySegment ray;
    ray.origin = from, ray.direction = way.normalized(), ray.spread = spread;
    return ray;
}

}  // namespace trapeze::testing
