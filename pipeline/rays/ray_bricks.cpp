#include "pipeline/rays/ray_bricks.h"

#include <tbb/task_arena.h>

#include <algorithm>
#include <tuple>

#include "accel/hit_policies.h"
#include "pipeline/rays/whole_ray_grids.h"

namespace trapeze {
namespace {

/// A brick ends at so many bytes of grids, and sooner where the budget holds few such bricks, but hardly at
/// less than what a brick itself takes.
constexpr size_t kMostBytes = size_t{1} << 18, kFewBytes = size_t{1} << 14, kBricksInBudget = 64;

}  // namespace

struct RayBricks::Brick {
    Grids grids;
    std::unique_ptr<WideTree> tree;

    size_t bytes() const { return grids.bytes() + tree->stats().tree_bytes; }
};

RayBricks::RayBricks(const RayDicer& dicer, const std::vector<RunExtent>& runs, size_t most_bytes)
    : dicer_(dicer) {
    BrickDivision division =
        divide_into_bricks(runs, std::clamp(most_bytes / kBricksInBudget, kFewBytes, kMostBytes));
    runs_ = std::move(division.runs), first_ = std::move(division.first);
    tree_ = std::make_unique<ExtentTree>(division.extents);
    bricks_.emplace(division.extents.size(), most_bytes);
}

RayBricks::~RayBricks() = default;

std::shared_ptr<const RayBricks::Brick> RayBricks::brick(uint32_t number) const {
    return bricks_->get(number, [&] {
        std::shared_ptr<const Brick> made;
        // Isolated: a thread that makes a brick must not take up other work, which might want this one.
        tbb::this_task_arena::isolate([&] { made = make(number); });
        made_.fetch_add(made->grids.micropolygon_count(), std::memory_order_relaxed);
        return made;
    });
}

std::shared_ptr<const RayBricks::Brick> RayBricks::make(uint32_t number) const {
    auto brick = std::make_shared<Brick>();
    GridArena arena(1);  // no more than grids need
    for (uint32_t i = first_[number]; i < first_[number + 1]; ++i)
        for (uint32_t k = 0; k < runs_[i].count; ++k)
            brick->grids.grids.push_back(dicer_.make(runs_[i].first + k, arena));
    brick->grids.arenas.push_back(std::move(arena));
    brick->tree = std::make_unique<WideTree>(brick->grids, RayReach());
    return brick;
}

/// Meets a brick's grids: their nearest hit, if it is nearer than the one before.
bool RayBricks::meet(const Brick& brick, const RangedRay& ranged, Hit& nearest, const Grid*& grid) {
    RangedRay ray = ranged;
    ray.range.max = std::min(ray.range.max, nearest.depth);
    const std::optional<Hit> hit = closest_in(*brick.tree, brick.grids, ray);
    if (!hit) return false;
    const Hit global = with_ordinal(*hit, brick.grids);
    if (!in_front(global, nearest)) return false;
    nearest = global;
    grid = &brick.grids.grids[MicropolygonId::unpack(hit->id).grid];
    return true;
}

std::optional<RayGridHit> RayBricks::closest(const RangedRay& ray) const {
    TraceRay trace_ray = TraceRay::turned(axis_ray(ray.ray), ray.range);
    RayGridHit nearest{kNoHit, nullptr, nullptr};
    tree_->visit(trace_ray, [&](uint32_t number, float) {
        const std::shared_ptr<const Brick> met = brick(number);
        if (!meet(*met, ray, nearest.hit, nearest.grid)) return;
        nearest.keeps = met;
        trace_ray.t_max = nearest.hit.depth;
    });
    if (!nearest.grid) return {};
    return nearest;
}

/// All meetings of rays and bricks' bounds, brick by brick; bricks that are there come first, which may spare
/// others.
std::vector<RayBricks::Meeting> RayBricks::meetings(std::span<const RangedRay> rays) const {
    std::vector<Meeting> meetings;
    for (uint32_t r = 0; r < rays.size(); ++r) {
        TraceRay ray = TraceRay::turned(axis_ray(rays[r].ray), rays[r].range);
        tree_->visit(ray, [&](uint32_t number, float depth) { meetings.push_back({number, r, depth}); });
    }
    std::vector<bool> is_there(bricks_->size());
    for (size_t i = 0; i < is_there.size(); ++i) is_there[i] = bricks_->has(i);
    std::ranges::sort(meetings, {}, [&](const Meeting& meeting) {
        return std::tuple(!is_there[meeting.brick], meeting.brick, meeting.ray);
    });
    return meetings;
}

/// Calls meet(brick, ray) where wants(meeting) says so; a brick is only made where some ray wants it.
template <class Wants, class Meet>
void RayBricks::for_each_meeting(std::span<const RangedRay> rays, const Wants& wants,
                                 const Meet& meet) const {
    std::shared_ptr<const Brick> held;
    uint32_t held_number = 0;
    for (const Meeting& meeting : meetings(rays)) {
        if (!wants(meeting)) continue;
        if (!held || held_number != meeting.brick) {
            held.reset();
            held = brick(meeting.brick), held_number = meeting.brick;
        }
        meet(*held, meeting.ray);
    }
}

void RayBricks::closest(std::span<const RangedRay> rays, const TakeHit& take) const {
    std::vector<Hit> nearest(rays.size(), kNoHit);
    for_each_meeting(
        rays, [&](const Meeting& meeting) { return meeting.depth <= nearest[meeting.ray].depth; },
        [&](const Brick& brick, uint32_t ray) {
            const Grid* grid = nullptr;
            if (meet(brick, rays[ray], nearest[ray], grid)) take(ray, {nearest[ray], grid, nullptr});
        });
}

void RayBricks::in_the_way(std::span<const RangedRay> rays, std::span<InTheWay> met) const {
    std::ranges::fill(met, InTheWay::Nothing);
    for_each_meeting(
        rays, [&](const Meeting& meeting) { return met[meeting.ray] != InTheWay::Opaque; },
        [&](const Brick& brick, uint32_t ray) {
            const RangedRay& asked = rays[ray];
            met[ray] = std::max(met[ray], brick.tree->in_the_way(asked.ray, asked.range, asked.sure));
        });
}

size_t RayBricks::bytes() const {
    return sizeof(*this) + runs_.capacity() * sizeof(SubpatchRun) + first_.capacity() * sizeof(uint32_t) +
           tree_->bytes() + bricks_->bytes();
}

}  // namespace trapeze
