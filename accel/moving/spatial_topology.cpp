#include "accel/moving/spatial_topology.h"

#include <tbb/concurrent_vector.h>
#include <tbb/enumerable_thread_specific.h>
#include <tbb/parallel_for.h>
#include <tbb/parallel_invoke.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <memory>
#include <span>

#include "accel/builders/build_clock.h"
#include "accel/builders/grid_pose.h"
#include "accel/builders/sah_bins.h"
#include "accel/builders/sah_sweep.h"
#include "accel/moving/cut_planes.h"

namespace trapeze {
namespace {

/// Nodes of up to this many references are parted at the best of all places, larger ones at the best of bins'
/// planes.
constexpr size_t kSortUpTo = 16;

/// Nodes whose sides overlap by less than this of the root's surface are not cut: little is to be gained
/// [Stich09 sec. 4.5].
constexpr double kLeastOverlap = 1e-5;

/// Visiting a node, two boxes between keys, takes as long as so many tests of a micropolygon: measured on
/// hair, where a tree of leaves twice as small visits a fifth more nodes and is as fast.
constexpr double kVisitCost = 2;

constexpr size_t kNodeIsTaskFrom = 1024;  ///< references below which a subtree is one task

/// Parts of up to this many references are parted with room that each thread keeps.
constexpr size_t kPartHereUpTo = 4096;

/// References on the sides of a cut, in one room: those of the low side come first, those of the high side
/// last, from the end on while they are added.
struct Sides {
    std::span<SahItem> room;
    size_t low = 0, high = 0;  ///< so many of each

    void add_low(const SahItem& item) { std::construct_at(&room[low++], item); }
    void add_high(const SahItem& item) { std::construct_at(&room[room.size() - ++high], item); }
};

/// What is below a node.
struct Counts {
    uint32_t inner = 0, leaves = 0, references = 0;

    Counts operator+(const Counts& o) const {
        return {inner + o.inner, leaves + o.leaves, references + o.references};
    }
};

/// A node while the tree is built. References lie in the caller's array, or in the room of the nearest
/// ancestor that was cut.
struct SpatialNode {
    SpatialNode *low = nullptr, *high = nullptr;  ///< none of a leaf
    std::span<const SahItem> references;          ///< of a leaf
    Counts counts;                                ///< of the node and what is below it
};

/// Nodes of one thread, given back together.
class NodePool {
  public:
    SpatialNode* make() {
        if (used_ == (chunks_.empty() ? 0 : chunks_.back().size())) {
            chunks_.emplace_back(kLeast << std::min(chunks_.size(), kDoublings));
            used_ = 0;
        }
        return std::construct_at(&chunks_.back()[used_++]);
    }

  private:
    static constexpr size_t kLeast = 256, kDoublings = 8;  ///< of the first chunk; of those after it
    std::vector<UnsetVector<SpatialNode>> chunks_;
    size_t used_ = 0;  ///< of the last chunk
};

/// std::stable_partition() that keeps its room, but for large parts.
template <class IsLow>
size_t part_in_order(std::span<SahItem> items, const IsLow& is_low) {
    static thread_local UnsetVector<SahItem> kept(kPartHereUpTo);
    UnsetVector<SahItem> of_large(items.size() > kPartHereUpTo ? items.size() : 0);
    SahItem* const high = of_large.empty() ? kept.data() : of_large.data();
    size_t low_count = 0, high_count = 0;
    for (const SahItem& item : items) {
        if (is_low(item))
            items[low_count++] = item;
        else
            high[high_count++] = item;
    }
    std::copy_n(high, high_count, items.begin() + static_cast<std::ptrdiff_t>(low_count));
    return low_count;
}

/// Builds from the root down. Parting sorts references where they are; only a cut makes more of them, and
/// takes memory for both of its sides.
class SpatialBuilder {
  public:
    SpatialBuilder(const Grids& grids, const SpatialOptions& options) : grids_(grids), options_(options) {}

    /// Sorts the items.
    SpatialTopology build(std::span<SahItem> items) {
        SpatialTopology result;
        if (!items.empty()) {
            root_area_ = half_area(sah::sum_of(std::span<const SahItem>(items), sah::Bin{}).box());
            if (options_.budget > 0) pose_all();
            const SpatialNode* const root = build_task(items, options_.budget, 0);
            result.tree.inner.resize(root->counts.inner);
            result.leaf_first.resize(root->counts.leaves);
            result.references.resize(root->counts.references);
            result.tree.root = number(*root, {}, result);
        }
        result.leaf_first.push_back(static_cast<uint32_t>(result.references.size()));
        result.poses = std::move(middle_);
        result.splits = splits_, result.lacked_budget = lacked_budget_;
        result.work = work_.seconds(), result.cut_work = cut_work_.seconds();
        return result;
    }

  private:
    /// References are sorted where they are; those of a side come one after another.
    using References = std::span<SahItem>;

    /// A subtree whose two sides are tasks of their own where it is large.
    SpatialNode* build_task(References references, size_t budget, int depth) {
        if (references.size() >= kNodeIsTaskFrom) return build_node(references, budget, depth);
        const WorkSum::Span span(work_);
        return build_node(references, budget, depth);
    }

    /// Divides a node of a task; large ones are in none, and say what they take themselves.
    bool divide_in_task(References references, size_t budget, int depth, References& low, References& high) {
        if (references.size() < kNodeIsTaskFrom) return divide(references, budget, depth, low, high);
        const WorkSum::Span span(work_);
        return divide(references, budget, depth, low, high);
    }

    SpatialNode* build_node(References references, size_t budget, int depth) {
        SpatialNode* const node = pools_.local().make();
        const size_t count = references.size();
        References low, high;
        if (count < 2 || !divide_in_task(references, budget, depth, low, high)) {
            node->references = references;
            node->counts = {0, 1, static_cast<uint32_t>(count)};
            return node;
        }
        // What is left of the budget goes with the references.
        const size_t left = budget - (low.size() + high.size() - count);
        const auto low_budget =
            static_cast<size_t>(static_cast<double>(left) * static_cast<double>(low.size()) /
                                static_cast<double>(low.size() + high.size()));
        if (count < kNodeIsTaskFrom) {
            node->low = build_node(low, low_budget, depth + 1);
            node->high = build_node(high, left - low_budget, depth + 1);
        } else {
            tbb::parallel_invoke([&] { node->low = build_task(low, low_budget, depth + 1); },
                                 [&] { node->high = build_task(high, left - low_budget, depth + 1); });
        }
        node->counts = Counts{1, 0, 0} + node->low->counts + node->high->counts;
        return node;
    }

    /// The best way to part references by their middles.
    struct Parting {
        sah::Split split;
        Box3f low, high;      ///< of the sides
        bool sorted = false;  ///< split.place is of the order along the axis, not of bins
        sah::Binning binning{Box3f()};
    };

    /// By a sweep of few references, by bins of many. Cost infinite where all middles coincide.
    static Parting best_parting(std::span<const SahItem> all, const sah::Extent& extent) {
        Parting best;
        sah::Bin low, high;
        if (all.size() <= kSortUpTo) {
            best.sorted = true;
            const Box3f centroids = extent.centroids.box();
            const double visit = half_area(extent.all.box()) * kTraversalCost;
            for (int axis = 0; axis < 3; ++axis)
                if (centroids.max[axis] > centroids.min[axis])
                    sah::AxisOrder(all, axis).consider(axis, visit, best.split);
            if (!(best.split.cost < sah::kInfinite)) return best;
            const sah::AxisOrder order(all, best.split.axis);
            for (size_t i = 0; i < all.size(); ++i) (i < best.split.place ? low : high).add(order[i]);
        } else {
            best.binning = sah::Binning(extent.centroids.box());
            const sah::Bins bins = sah::sum_of(all, sah::Bins{&best.binning, {}});
            best.split = sah::best_of_bins(bins, extent);
            if (!(best.split.cost < sah::kInfinite)) return best;
            for (size_t b = 0; b < sah::kBins; ++b)
                (b < best.split.place ? low : high)
                    .add(bins.of_axis[static_cast<size_t>(best.split.axis)][b]);
        }
        best.low = low.box(), best.high = high.box();
        return best;
    }

    /// How many references come to the lower side, and so first.
    static size_t part(const Parting& best, References references) {
        if (best.sorted) {
            const sah::AxisOrder order(references, best.split.axis);
            std::array<SahItem, kSortUpTo> sorted;
            for (size_t i = 0; i < references.size(); ++i) sorted[i] = order[i];
            std::copy_n(sorted.begin(), references.size(), references.begin());
            return best.split.place;
        }
        const auto is_low = [&](const SahItem& item) {
            return static_cast<size_t>(best.binning.bin_of(item, best.split.axis)) < best.split.place;
        };
        return part_in_order(references, is_low);
    }

    /// Divides a node's references onto two sides, neither of which is empty; false: it is a leaf.
    bool divide(References references, size_t budget, int depth, References& low, References& high) {
        const bool may_be_leaf = references.size() < options_.leaf_below;
        size_t middle = references.size() / 2;
        if (depth < kSahDepthLimit) {
            const sah::Extent extent = sah::sum_of(std::span<const SahItem>(references), sah::Extent{});
            const Parting parting = best_parting(references, extent);
            // Costs of splits have kTraversalCost in them.
            const Box3f box = extent.all.box();
            const double visit = half_area(box) * (kVisitCost - kTraversalCost);
            const double leaf_cost = may_be_leaf ? extent.all.cost() - visit : sah::kInfinite;
            const double to_beat = std::min(parting.split.cost, leaf_cost);
            if (cut(references, box, parting, to_beat, budget, low, high)) return true;
            if (may_be_leaf && !(parting.split.cost < leaf_cost)) return false;
            if (parting.split.cost < sah::kInfinite) middle = part(parting, references);
        } else if (may_be_leaf) {
            return false;
        }
        low = references.first(middle), high = references.subspan(middle);
        return true;
    }

    /// Cuts a node by a plane where that costs less than `to_beat`; false: nothing was done.
    bool cut(std::span<const SahItem> references, const Box3f& box, const Parting& parting, double to_beat,
             size_t budget, References& low, References& high) {
        if (options_.budget == 0 || !sides_overlap(parting)) return false;
        const WorkSum::Span span(cut_work_);
        const CutPlanes planes(middle_, options_.tight);
        const Cut best = planes.best(references, box, to_beat);
        if (!(best.cost < to_beat)) return false;
        if (budget == 0) {
            lacked_budget_.store(true, std::memory_order_relaxed);
            return false;
        }
        UnsetVector<SahItem> room(references.size() + std::min(references.size(), budget));
        Sides sides{room};
        cut_by(best, references, budget, sides);
        if (sides.low == 0 || sides.high == 0) return false;
        splits_.fetch_add(1, std::memory_order_relaxed);
        low = sides.room.first(sides.low), high = sides.room.last(sides.high);
        rooms_.push_back(std::move(room));
        std::ranges::reverse(high);  // into the order in which they come
        return true;
    }

    /// Whether the sides of a parting overlap by so much that a cut may be better; so it is where there is
    /// none.
    bool sides_overlap(const Parting& parting) const {
        if (!(parting.split.cost < sah::kInfinite)) return true;
        Box3f both;
        for (int k = 0; k < 3; ++k) {
            both.min[k] = std::max(parting.low.min[k], parting.high.min[k]);
            both.max[k] = std::min(parting.low.max[k], parting.high.max[k]);
        }
        return half_area(both) > kLeastOverlap * root_area_;
    }

    /// Every level of the tree asks for poses: interpolating them anew was a fifth of the build.
    void pose_all() {
        std::vector<uint32_t> first(grids_.grids.size());
        uint32_t count = 0;
        for (size_t g = 0; g < first.size(); ++g)
            first[g] = count, count += static_cast<uint32_t>(grids_.grids[g].shape.micropolygon_count());
        middle_.resize(count);
        tbb::parallel_for(size_t{0}, first.size(), [&](size_t g) {
            const Grid& grid = grids_.grids[g];
            GridPose pose;
            pose.set(grid.shape, [&](int i, int j) { return grid.vertex(i, j, 0.5f); });
            LanePose* to = middle_.data() + first[g];
            for (int v = 0; v < grid.shape.nv; ++v)
                for (int u = 0; u < grid.shape.nu; ++u, ++to)
                    std::construct_at(to, pose.vertex(u, v), pose.vertex(u + 1, v), pose.vertex(u, v + 1),
                                      pose.vertex(u + 1, v + 1));
        });
    }

    /// Puts references on the sides of a plane: on both where it cuts them, but for those that cost less
    /// whole on one side [Stich09 sec. 4.4], and when the budget is used up.
    void cut_by(Cut cut, std::span<const SahItem> references, size_t budget, Sides& sides) {
        for (const SahItem& item : references) {
            if (item.box.max[cut.axis] <= cut.at)
                sides.add_low(item);
            else if (item.box.min[cut.axis] >= cut.at)
                sides.add_high(item);
            else
                cut_reference(item, cut, budget, sides);
        }
    }

    /// One that the plane goes through: cut, or whole on the side where that costs least. A side that takes
    /// it whole grows, and the other counts one less, so that those which follow are judged by that.
    void cut_reference(const SahItem& item, Cut& cut, size_t& budget, Sides& sides) {
        const LaneChopped parts = CutPlanes(middle_, options_.tight).divided(item, cut.axis, cut.at);
        if (parts.low.is_empty() || parts.high.is_empty()) {
            // Its polygon is on one side but for rounding.
            parts.low.is_empty() ? sides.add_high(item) : sides.add_low(item);
            return;
        }
        Box3f low_with = cut.low, high_with = cut.high;
        low_with.extendBy(item.box), high_with.extendBy(item.box);
        const auto low_count = static_cast<double>(cut.low_count),
                   high_count = static_cast<double>(cut.high_count);
        const double low_area = half_area(cut.low), high_area = half_area(cut.high);
        const double both = low_area * low_count + high_area * high_count;
        const double in_low = half_area(low_with) * low_count + high_area * (high_count - 1);
        const double in_high = low_area * (low_count - 1) + half_area(high_with) * high_count;
        if (budget == 0) lacked_budget_.store(true, std::memory_order_relaxed);
        if (budget > 0 && both <= std::min(in_low, in_high)) {
            --budget;
            sides.add_low({parts.low.box(), 1, item.id | PartId::kPart});
            sides.add_high({parts.high.box(), 1, item.id | PartId::kPart});
        } else if (in_low <= in_high) {
            sides.add_low(item);
            cut.low = low_with, --cut.high_count;
        } else {
            sides.add_high(item);
            cut.high = high_with, --cut.low_count;
        }
    }

    /// Inner nodes in preorder, leaves from left to right, each from `first` on.
    static TopLink number(const SpatialNode& node, const Counts& first, SpatialTopology& result) {
        if (!node.low) {
            result.leaf_first[first.leaves] = first.references;
            std::ranges::uninitialized_copy(node.references,
                                            std::span(result.references).subspan(first.references));
            return TopLink::leaf(first.leaves);
        }
        const Counts first_low = first + Counts{1, 0, 0}, first_high = first_low + node.low->counts;
        std::array<TopLink, 2>& links = result.tree.inner[first.inner];
        const auto number_low = [&] { links[0] = number(*node.low, first_low, result); };
        const auto number_high = [&] { links[1] = number(*node.high, first_high, result); };
        if (node.counts.references >= kNodeIsTaskFrom)
            tbb::parallel_invoke(number_low, number_high);
        else
            number_low(), number_high();
        return TopLink::inner(first.inner);
    }

    const Grids& grids_;
    const SpatialOptions& options_;
    UnsetVector<LanePose> middle_;  ///< micropolygon -> where it is at mid-shutter; none without a budget
    tbb::enumerable_thread_specific<NodePool> pools_;
    tbb::concurrent_vector<UnsetVector<SahItem>> rooms_;  ///< of references below nodes that were cut
    double root_area_ = 0;
    std::atomic<uint64_t> splits_{0};
    std::atomic<bool> lacked_budget_{false};
    WorkSum work_, cut_work_;
};

}  // namespace

SpatialTopology build_spatial_topology(std::span<SahItem> items, const Grids& grids,
                                       const SpatialOptions& options) {
    return SpatialBuilder(grids, options).build(items);
}

}  // namespace trapeze
