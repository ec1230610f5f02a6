/// Grids that are made when a ray comes by and forgotten when memory is short [Christensen03]: neighbours are
/// a brick, with a tree of its own, and a tree over the bricks' extents stays in memory.
#pragma once

#include <atomic>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "accel/wide/extent_tree.h"
#include "accel/wide/wide_tree.h"
#include "core/memory/clock_cache.h"
#include "pipeline/rays/brick_division.h"
#include "pipeline/rays/ray_dicer.h"
#include "pipeline/rays/ray_grids.h"

namespace trapeze {

/// Takes a ray's hit, by the ray's index; each one that it gets is in front of those before. The grid is
/// there during the call.
using TakeHit = std::function<void(size_t, const RayGridHit&)>;

class RayBricks final : public RayGrids {
  public:
    /// `runs` are all that these rays may meet, at least one, in any order. Bricks that are kept take
    /// `most_bytes`; those in use may be more. The dicer outlives this.
    RayBricks(const RayDicer& dicer, const std::vector<RunExtent>& runs, size_t most_bytes);
    ~RayBricks() override;

    std::optional<RayGridHit> closest(const RangedRay& ray) const override;
    /// As those of one ray, for many: each brick is made once for all that want it.
    void closest(std::span<const RangedRay> rays, const TakeHit& take) const;
    void in_the_way(std::span<const RangedRay> rays, std::span<InTheWay> met) const override;
    size_t bytes() const override;
    /// Micropolygons made so far, those that were made again, too.
    uint64_t micropolygons_made() const { return made_.load(std::memory_order_relaxed); }

  private:
    /// Made and traced, never changed.
    struct Brick;

    /// A ray that comes to a brick's bounds at a depth.
    struct Meeting {
        uint32_t brick, ray;
        float depth;
    };

    static bool meet(const Brick& brick, const RangedRay& ranged, Hit& nearest, const Grid*& grid);
    std::vector<Meeting> meetings(std::span<const RangedRay> rays) const;
    template <class Wants, class Meet>
    void for_each_meeting(std::span<const RangedRay> rays, const Wants& wants, const Meet& meet) const;
    std::shared_ptr<const Brick> brick(uint32_t number) const;
    std::shared_ptr<const Brick> make(uint32_t number) const;

    const RayDicer& dicer_;
    std::vector<SubpatchRun> runs_;  ///< brick after brick, each in the order of their numbers
    std::vector<uint32_t> first_;    ///< of a brick's runs; one more than there are bricks
    std::unique_ptr<ExtentTree> tree_;
    mutable std::optional<ClockCache<Brick>> bricks_;  ///< by number
    mutable std::atomic<uint64_t> made_{0};
};

}  // namespace trapeze
