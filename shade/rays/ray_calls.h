/// The shading language's trace(), transmission(), visibility(), occlusion() and indirectdiffuse(), with
/// optional arguments as PRMan's, and its shadow() of a light that is traced.
#pragma once

#include <unordered_map>
#include <vector>

#include "core/scene/scene.h"
#include "shade/rays/ray_arguments.h"
#include "shade/rays/ray_walk.h"

namespace trapeze {

/// What calls of a grid's shaders ask. All it refers to must outlive the calls.
struct RayService {
    const RayScene* scene = nullptr;
    ShadeHits shade;  ///< shades hits, one bounce farther from the camera
    int depth = 0;    ///< bounces from the camera to the points that are shaded
    int max_depth = 10;
    uint32_t seed = 0;  ///< of the render
    RayWalkScratch* scratch = nullptr;
    RayStats* stats = nullptr;
};

/// Carries out the calls of one grid's shaders, in one thread.
class RayCalls : public vm::Rays {
  public:
    /// `attributes`: of the surface that is shaded.
    RayCalls(const RayService& service, const Attributes& attributes)
        : service_(service), attributes_(attributes) {}

    void trace(vm::Run& run, const vm::Step& step, std::span<const vm::Operand> operands) override;
    int depth() const override { return service_.depth; }

  private:
    /// A lane that asks, with the seed of its random numbers in this call.
    struct Lane {
        size_t lane = 0;
        uint32_t seed = 0;

        /// The seed of what one of its rays hits.
        uint64_t of_ray(int sample) const;
    };
    /// The rays of all lanes, one lane's after another's.
    struct LaneRays {
        std::vector<WalkedRay> rays;
        std::vector<size_t> ends;  ///< behind each lane's last
    };

    std::vector<Lane> lanes_of(vm::Run& run, const vm::Step& step, bool uniform);
    LaneRays rays_of(rsl::Op op, std::span<const Lane> lanes, const RayArguments& arguments) const;
    void add_rays(rsl::Op op, const Lane& lane, const RayArguments& arguments,
                  std::vector<WalkedRay>& rays) const;
    void follow(rsl::Op op, bool colors, const RayArguments& arguments, std::span<WalkedRay> rays) const;
    float bias_at(const V3f& P, const RayArguments& arguments, size_t lane) const;
    bool is_too_deep(RayKind kind) const;

    const RayService& service_;
    const Attributes& attributes_;
    /// How often a call has been made for each lane: calls in loops take other random numbers each time.
    std::unordered_map<const vm::Step*, std::vector<uint32_t>> calls_;
};

}  // namespace trapeze
