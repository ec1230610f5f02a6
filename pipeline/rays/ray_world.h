/// The geometry that rays of shaders meet [Hou10 sec. 4; decision 0029]: all primitives whose attributes let
/// some kind of ray see them, diced without regard to what the camera sees. What does not fit the memory that
/// it may take is made when rays come by; hits are the same either way.
#pragma once

#include <array>
#include <memory>
#include <mutex>
#include <optional>
#include <vector>

#include "core/scene/ray_scene.h"
#include "core/scene/render_context.h"
#include "pipeline/rays/level_spans.h"
#include "pipeline/rays/ray_level.h"
#include "pipeline/rays/solid_hits.h"

namespace trapeze {

class RayWorld final : public RayScene {
  public:
    /// Dices and displaces all that rays see, as it is at shutter open, in parallel and alike for any number
    /// of threads, and keeps it where that takes half of `most_bytes` at most. Lists of subpatches take as
    /// many bytes again; what is more is listed again when it is asked for. The context's scene and `shading`
    /// outlive this.
    RayWorld(const RenderContext& context, const Shading& shading, size_t most_bytes);
    ~RayWorld() override;

    bool has(RayKind kind) const override;
    void closest(std::span<const RaySegment* const> rays, RayKind kind,
                 std::span<std::optional<RaySurfaceHit>> hits) const override;
    std::unique_ptr<RayAhead> look_ahead() const override;
    void blocked(std::span<const RaySegment* const> rays, RayKind kind,
                 std::span<std::optional<bool>> blocked) const override;
    /// Of one ray.
    std::optional<RaySurfaceHit> closest(const RaySegment& ray, RayKind kind) const;
    std::optional<bool> blocked(const RaySegment& ray, RayKind kind) const;
    size_t rays_at_once() const override;
    int dice(const RaySurfaceHit& hit, ShadingGrid& grid) const override;
    float spacing(const V3f& P) const override;
    std::optional<Surfels> surfels(RayKind kind, size_t most_bytes) const override;
    int dice_surfel(uint64_t id, ShadingGrid& grid) const override;
    void in_parallel(const std::function<void()>& work) const override;

    /// Memory of grids and trees that is held now.
    size_t bytes() const;
    /// Memory of the lists of subpatches.
    size_t list_bytes() const;
    /// Of all that rays may meet, and those made so far, which may be fewer or more.
    uint64_t micropolygon_count() const;
    uint64_t micropolygons_made() const;

  private:
    const RenderContext& context() const { return levels_[0]->dicer().context(); }
    std::vector<int> make_levels(size_t most_bytes);
    const RayDicer& dicer_of_surfels() const { return surfel_dicer_ ? *surfel_dicer_ : levels_[0]->dicer(); }
    std::optional<RaySurfaceHit> closest_of_all(const RaySegment& ray, RayKind kind) const;
    template <class Ends, class Ask>
    void for_each_level(std::span<const RaySegment* const> rays, const Ends& ends, const Ask& ask) const;
    template <class Of>
    auto sum_of(const Of& of) const {
        decltype(of(*levels_[0])) sum = 0;
        for (const std::unique_ptr<RayLevel>& level : levels_)
            if (level) sum += of(*level);
        return sum;
    }

    std::array<std::unique_ptr<RayLevel>, kMostRayLevels>
        levels_;  ///< null: not worth while; never the finest
    LevelRule rule_;
    bool makes_bricks_ = false;
    size_t rays_at_once_ = 0;          ///< where bricks are made
    std::optional<SolidHits> solids_;  ///< of a scene that has solids
    size_t most_bytes_;
    /// Surfels are as large whether they are flat or not: a second tessellation, made with the first of them.
    mutable std::once_flag surfels_wanted_;
    mutable std::unique_ptr<RayDicer> surfel_dicer_;  ///< null: the finest level's
};

/// The ray world of a render whose shaders ask for rays; else null. Tells when they ask and nothing is there
/// for them.
std::unique_ptr<RayWorld> make_ray_world(const RenderContext& context, const Shading& shading,
                                         size_t most_bytes);

}  // namespace trapeze
