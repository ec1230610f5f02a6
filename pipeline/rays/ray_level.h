/// One level of the geometry that rays of shaders meet: all primitives that some kind of ray sees, diced with
/// sides of one length, and trees over them [decision 0033]. Objects whose instances share grids have theirs
/// apart, each in its own space [decision 0042].
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "core/scene/ray_scene.h"
#include "core/scene/render_context.h"
#include "pipeline/rays/grouped_ray_grids.h"
#include "pipeline/rays/ray_dicer.h"
#include "pipeline/rays/ray_hits.h"
#include "pipeline/rays/ray_places.h"

namespace trapeze {

/// The share of their memory that bricks get where grids are made as rays come by; the rest is for rays that
/// wait for them.
inline constexpr double kBrickShare = 0.6;

class RayLevel {
  public:
    /// The finest one. It has no grids yet. Arguments as RayDicer's.
    RayLevel(const RenderContext& context, const Shading& shading, size_t most_bytes);
    /// A coarser one.
    RayLevel(const RayLevel& finest, int level, size_t most_bytes);

    /// Dices and displaces all, in parallel and alike for any number of threads, and keeps it where grids and
    /// trees take `most_bytes` at most. Else they are made when rays come by.
    void make_grids(size_t most_bytes);

    bool has(RayKind kind) const;
    /// Whether rays of a kind see a primitive.
    bool is_seen(uint32_t primitive, RayKind kind) const;
    /// RayScene's, of this level, without regard to solids.
    std::optional<RaySurfaceHit> closest(const RaySegment& ray, RayKind kind) const;
    /// Of many rays, as RayScene's.
    void closest(std::span<const RaySegment> rays, RayKind kind,
                 std::span<std::optional<RaySurfaceHit>> hits) const;
    void blocked(std::span<const RaySegment> rays, RayKind kind,
                 std::span<std::optional<bool>> blocked) const;
    int dice(const RaySurfaceHit& hit, ShadingGrid& grid) const;

    /// Whether grids are made as rays come by.
    bool makes_bricks() const;
    const RayDicer& dicer() const { return dicer_; }
    uint64_t micropolygon_count() const { return dicer_.tessellation().stats().micropolygons; }
    /// Those made so far: fewer or more than there are.
    uint64_t micropolygons_made() const;
    /// Memory of grids and trees that is held now.
    size_t bytes() const;

  private:
    struct Meeting;
    template <class Wants>
    std::vector<Meeting> meetings(std::span<const RaySegment> rays, const Wants& wants) const;
    template <class Wants, class Meet>
    void for_each_object(std::span<const RaySegment> rays, const Wants& wants, const Meet& meet) const;

    const uint8_t level_ = 0;
    RayDicer dicer_;
    RayHits hits_;
    std::vector<GridArena> arenas_;         ///< of grids that are in memory as a whole
    GroupedRayGrids own_;                   ///< of primitives that share nothing
    std::vector<GroupedRayGrids> objects_;  ///< of shared objects, each in its space
    std::optional<RayPlaces> places_;       ///< of these; nothing where there are none
};

}  // namespace trapeze
