#include "pipeline/rays/ray_bricks.h"

#include <tbb/task_arena.h>

#include <algorithm>

#include "accel/builders/morton_order.h"
#include "accel/hit_policies.h"
#include "pipeline/rays/whole_ray_grids.h"

namespace trapeze {
namespace {

/// A brick ends at so many bytes of grids, and sooner where the budget holds few such bricks, but hardly at
/// less than what a brick itself takes.
constexpr size_t kMostBytes = size_t{1} << 18, kFewBytes = size_t{1} << 14, kBricksInBudget = 64;

/// Along a curve through space, so that neighbours are near each other.
std::vector<uint32_t> in_space_order(const std::vector<SubpatchExtent>& subpatches) {
    std::vector<SahItem> items(subpatches.size());
    for (uint32_t i = 0; i < items.size(); ++i) {
        const GridExtent& extent = subpatches[i].extent;
        items[i].id = i;
        if (!std::isfinite(extent.absolute_max)) continue;
        for (int k = 0; k < 3; ++k)
            items[i].box.min[k] = extent.box.at[0].low[k], items[i].box.max[k] = extent.box.at[0].high[k];
    }
    sort_by_orientation(items, [](uint32_t) { return V3f(0, 0, 1); });
    std::vector<uint32_t> order;
    order.reserve(items.size());
    for (const SahItem& item : items) order.push_back(item.id);
    return order;
}

}  // namespace

struct RayBricks::Brick {
    Grids grids;
    std::unique_ptr<WideTree> tree;

    size_t bytes() const { return grids.bytes() + tree->stats().tree_bytes; }
};

struct RayBricks::Slot {
    std::mutex lock;  ///< of `brick`; held while it is made, so that it is made once
    std::shared_ptr<const Brick> brick;
    std::atomic<bool> used{false};  ///< since the hand came by
};

RayBricks::RayBricks(const RayDicer& dicer, std::vector<SubpatchExtent> subpatches, size_t most_bytes)
    : dicer_(dicer), most_bytes_(most_bytes) {
    std::vector<GridExtent> extents;
    divide(subpatches, extents);
    tree_ = std::make_unique<ExtentTree>(extents);
    slots_ = std::vector<Slot>(extents.size());
}

RayBricks::~RayBricks() = default;

/// Cuts the subpatches, in the order of space, into bricks.
void RayBricks::divide(std::vector<SubpatchExtent>& subpatches, std::vector<GridExtent>& extents) {
    const size_t most = std::clamp(most_bytes_ / kBricksInBudget, kFewBytes, kMostBytes);
    size_t bytes = 0;
    for (const uint32_t i : in_space_order(subpatches)) {
        const SubpatchExtent& next = subpatches[i];
        const bool begins =
            first_.empty() || bytes + next.bytes > most ||
            std::isfinite(extents.back().absolute_max) != std::isfinite(next.extent.absolute_max);
        if (begins) {
            first_.push_back(static_cast<uint32_t>(subpatches_.size()));
            extents.push_back(next.extent);
            bytes = 0;
        } else {
            extents.back() = united(extents.back(), next.extent);
        }
        subpatches_.push_back(next.subpatch);
        bytes += next.bytes;
    }
    first_.push_back(static_cast<uint32_t>(subpatches_.size()));
    for (size_t b = 0; b + 1 < first_.size(); ++b)
        std::sort(subpatches_.begin() + first_[b], subpatches_.begin() + first_[b + 1]);
}

std::shared_ptr<const RayBricks::Brick> RayBricks::brick(uint32_t number) const {
    Slot& slot = slots_[number];
    std::shared_ptr<const Brick> made;
    {
        const std::lock_guard hold(slot.lock);
        slot.used.store(true, std::memory_order_relaxed);
        if (slot.brick) return slot.brick;
        // Isolated: a thread that makes a brick must not take up other work, which might want this one.
        tbb::this_task_arena::isolate([&] { made = make(number); });
        slot.brick = made;
        bytes_.fetch_add(made->bytes());
    }
    made_.fetch_add(made->grids.micropolygon_count(), std::memory_order_relaxed);
    if (bytes_.load() > most_bytes_) make_room();
    return made;
}

std::shared_ptr<const RayBricks::Brick> RayBricks::make(uint32_t number) const {
    auto brick = std::make_shared<Brick>();
    GridArena arena(1);  // no more than grids need
    for (uint32_t i = first_[number]; i < first_[number + 1]; ++i)
        brick->grids.grids.push_back(dicer_.make(subpatches_[i], arena));
    brick->grids.arenas.push_back(std::move(arena));
    brick->tree = std::make_unique<WideTree>(brick->grids, RayReach());
    return brick;
}

/// Goes around the bricks and forgets those that no ray has met since last time, until the rest is within the
/// budget; twice around at most. Those whose slots are held are left alone.
void RayBricks::make_room() const {
    const std::unique_lock hold(making_room_, std::try_to_lock);
    if (!hold.owns_lock()) return;
    for (size_t seen = 0; seen < 2 * slots_.size() && bytes_.load() > most_bytes_; ++seen) {
        Slot& slot = slots_[hand_];
        hand_ = (hand_ + 1) % slots_.size();
        const std::unique_lock slot_hold(slot.lock, std::try_to_lock);
        if (!slot_hold.owns_lock() || !slot.brick || slot.used.exchange(false)) continue;
        bytes_.fetch_sub(slot.brick->bytes());
        slot.brick.reset();
    }
}

std::optional<RayGridHit> RayBricks::closest(const SpaceRay& ray, DepthRange range) const {
    TraceRay trace_ray = TraceRay::turned(axis_ray(ray), range);
    RayGridHit nearest{kNoHit, nullptr, nullptr};
    tree_->visit(trace_ray, [&](uint32_t number) {
        const std::shared_ptr<const Brick> met = brick(number);
        const std::optional<Hit> hit = met->tree->closest(ray, {range.min, trace_ray.t_max});
        if (!hit) return;
        const Hit global = with_ordinal(*hit, met->grids);
        if (!in_front(global, nearest.hit)) return;
        nearest = {global, &met->grids.grids[MicropolygonId::unpack(hit->id).grid], met};
        trace_ray.t_max = global.depth;
    });
    if (!nearest.grid) return {};
    return nearest;
}

InTheWay RayBricks::in_the_way(const SpaceRay& ray, DepthRange range) const {
    TraceRay trace_ray = TraceRay::turned(axis_ray(ray), range);
    InTheWay most = InTheWay::Nothing;
    tree_->visit(trace_ray, [&](uint32_t number) {
        if (most == InTheWay::Opaque) return;
        most = std::max(most, brick(number)->tree->in_the_way(ray, range));
        if (most == InTheWay::Opaque) trace_ray.t_max = -std::numeric_limits<float>::infinity();
    });
    return most;
}

size_t RayBricks::bytes() const {
    return sizeof(*this) + (subpatches_.capacity() + first_.capacity()) * sizeof(uint32_t) + tree_->bytes() +
           slots_.capacity() * sizeof(Slot) + bytes_.load();
}

}  // namespace trapeze
