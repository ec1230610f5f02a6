/// One level of the geometry that rays of shaders meet: all primitives that some kind of ray sees, diced with
/// sides of one length, and trees over them [decision 0033].
#pragma once

#include <array>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "core/scene/ray_scene.h"
#include "core/scene/render_context.h"
#include "pipeline/rays/ray_bricks.h"
#include "pipeline/rays/ray_dicer.h"
#include "pipeline/rays/ray_grids.h"

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
    std::optional<bool> blocked(const RaySegment& ray, RayKind kind) const;
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
    /// Primitives that the same kinds of rays see.
    struct Group {
        std::unique_ptr<RayGrids> grids;    ///< null: none
        const RayBricks* bricks = nullptr;  ///< `grids`, where they are made as rays come by
    };
    /// A bit for each RayKind.
    static constexpr unsigned kMasks = 8;

    std::optional<RaySurfaceHit> closest_in(const RayGrids& grids, const RaySegment& ray) const;
    void closest_in(const RayBricks& bricks, std::span<const RaySegment> rays,
                    std::span<std::optional<RaySurfaceHit>> hits) const;
    RaySurfaceHit hit_of(const RaySegment& ray, float distance, const RayGridHit& found) const;
    bool from_outside(const Grid& grid, const MicropolygonId& id, const RaySegment& ray) const;
    bool counts(const RaySegment& ray, const RayGridHit& found) const;
    bool shows(const Grid& grid, const MicropolygonId& id, const RaySegment& ray) const;

    const uint8_t level_ = 0;
    RayDicer dicer_;
    std::vector<GridArena> arenas_;  ///< of grids that are in memory as a whole
    std::array<Group, kMasks> groups_;
};

}  // namespace trapeze
