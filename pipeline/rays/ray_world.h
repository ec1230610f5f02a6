/// The geometry that rays of shaders meet [Hou10 sec. 4; decision 0029]: all primitives whose attributes let
/// some kind of ray see them, diced without regard to what the camera sees. What does not fit the memory that
/// it may take is made when rays come by; hits are the same either way.
#pragma once

#include <array>
#include <memory>
#include <optional>
#include <vector>

#include "core/scene/ray_scene.h"
#include "core/scene/render_context.h"
#include "pipeline/rays/ray_bricks.h"
#include "pipeline/rays/ray_dicer.h"
#include "pipeline/rays/ray_grids.h"
#include "pipeline/rays/solid_hits.h"

namespace trapeze {

class RayWorld final : public RayScene {
  public:
    /// Dices and displaces all that rays see, as it is at shutter open, in parallel and alike for any number
    /// of threads, and keeps it where that takes half of `most_bytes` at most. Primitives that take more than
    /// `most_bytes` to list are left out, with an error. The context's scene and `shading` outlive this.
    RayWorld(const RenderContext& context, const Shading& shading, size_t most_bytes);
    ~RayWorld() override;

    bool has(RayKind kind) const override;
    std::optional<RaySurfaceHit> closest(const RaySegment& ray, RayKind kind) const override;
    std::optional<bool> blocked(const RaySegment& ray, RayKind kind) const override;
    int dice(const RaySurfaceHit& hit, ShadingGrid& grid) const override;
    float spacing(const V3f& P) const override;

    /// Memory of grids and trees that is held now.
    size_t bytes() const;
    /// Memory of the lists of subpatches.
    size_t list_bytes() const { return dicer_.tessellation().bytes(); }
    /// Of all that rays may meet, and those made so far, which may be fewer or more.
    uint64_t micropolygon_count() const { return micropolygons_; }
    uint64_t micropolygons_made() const;

  private:
    /// Primitives that the same kinds of rays see.
    struct Group {
        std::unique_ptr<RayGrids> grids;    ///< null: none
        const RayBricks* bricks = nullptr;  ///< `grids`, where they are made as rays come by
    };
    /// A bit for each RayKind.
    static constexpr unsigned kMasks = 8;

    void make_groups(size_t most_bytes);
    std::optional<RaySurfaceHit> closest_of_all(const RaySegment& ray, RayKind kind) const;
    std::optional<RaySurfaceHit> closest_in(const RayGrids& grids, const RaySegment& ray) const;
    RaySurfaceHit hit_of(const RaySegment& ray, float distance, const RayGridHit& found) const;
    bool from_outside(const Grid& grid, const MicropolygonId& id, const RaySegment& ray) const;
    bool shows(const Grid& grid, const MicropolygonId& id, const RaySegment& ray) const;

    RayDicer dicer_;
    std::optional<SolidHits> solids_;  ///< of a scene that has solids
    std::vector<GridArena> arenas_;    ///< of grids that are in memory as a whole
    std::array<Group, kMasks> groups_;
    uint64_t micropolygons_ = 0;
};

/// The ray world of a render whose shaders ask for rays; else null. Tells when they ask and nothing is there
/// for them.
std::unique_ptr<RayWorld> make_ray_world(const RenderContext& context, const Shading& shading,
                                         size_t most_bytes);

}  // namespace trapeze
