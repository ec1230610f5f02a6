#include "accel/moving/spatial_topology.h"

#include <tbb/parallel_for.h>
#include <tbb/parallel_invoke.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <memory>
#include <span>

#include "accel/builders/box_sum.h"
#include "accel/builders/build_clock.h"
#include "accel/builders/sah_bins.h"
#include "accel/builders/sah_sweep.h"

namespace trapeze {
namespace {

/// Planes are tried between so many slabs along an axis; of small nodes between fewer, for there are few
/// places where it matters.
constexpr size_t kMostSlabs = 16, kLeastSlabs = 4;

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

/// A plane that cuts a node, what the node costs then, and the boxes and numbers of references on its sides.
struct Cut {
    double cost = sah::kInfinite;
    int axis = 0;
    float at = 0;
    Box3f low, high;
    size_t low_count = 0, high_count = 0;
    /// No plane of the same slabs costs less, whatever is in the boxes that it cuts: sides hold what they
    /// hold whole. But for parts whose boxes are larger than their polygons: some cuts of such are not found.
    double least = sah::kInfinite;
};

/// References on the sides of a cut.
struct Sides {
    std::vector<SahItem> low, high;
};

/// A node while the tree is built. References lie in the caller's array, or in that of the nearest ancestor
/// that was cut.
struct SpatialNode {
    std::unique_ptr<SpatialNode> low, high;  ///< none of a leaf
    std::span<const SahItem> references;     ///< of a leaf
    std::vector<SahItem> of_cut;  ///< what is below a node that was cut: more than there was before
};

/// Builds from the root down. Parting sorts references where they are; only a cut makes more of them, and
/// takes memory for both of its sides.
class SpatialBuilder {
  public:
    SpatialBuilder(const Grids& grids, std::span<const MicropolygonId> ids, const SpatialOptions& options)
        : grids_(grids), ids_(ids), options_(options) {}

    /// Sorts the items.
    SpatialTopology build(std::span<SahItem> items) {
        SpatialTopology result;
        if (!items.empty()) {
            BoxSum all;
            for (const SahItem& item : items) all.add(item.box);
            root_area_ = half_area(all.box());
            if (options_.budget > 0) pose_all();
            const std::unique_ptr<SpatialNode> root = build_task(items, options_.budget, 0);
            result.references.reserve(items.size());
            result.tree.root = number(*root, result);
        }
        result.leaf_first.push_back(static_cast<uint32_t>(result.references.size()));
        result.splits = splits_, result.lacked_budget = lacked_budget_;
        result.work = work_.seconds(), result.cut_work = cut_work_.seconds();
        return result;
    }

  private:
    /// References are sorted where they are; those of a side come one after another.
    using References = std::span<SahItem>;

    /// A subtree whose two sides are tasks of their own where it is large.
    std::unique_ptr<SpatialNode> build_task(References references, size_t budget, int depth) {
        if (references.size() >= kNodeIsTaskFrom) return build_node(references, budget, depth);
        const WorkSum::Span span(work_);
        return build_node(references, budget, depth);
    }

    /// Divides a node of a task; large ones are in none, and say what they take themselves.
    bool divide_in_task(References references, size_t budget, int depth, SpatialNode& node, References& low,
                        References& high) {
        if (references.size() < kNodeIsTaskFrom) return divide(references, budget, depth, node, low, high);
        const WorkSum::Span span(work_);
        return divide(references, budget, depth, node, low, high);
    }

    std::unique_ptr<SpatialNode> build_node(References references, size_t budget, int depth) {
        auto node = std::make_unique<SpatialNode>();
        const size_t count = references.size();
        References low, high;
        if (count < 2 || !divide_in_task(references, budget, depth, *node, low, high)) {
            node->references = references;
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
        const auto middle =
            std::stable_partition(references.begin(), references.end(), [&](const SahItem& item) {
                return static_cast<size_t>(best.binning.bin_of(item, best.split.axis)) < best.split.place;
            });
        return static_cast<size_t>(middle - references.begin());
    }

    /// Divides a node's references onto two sides, neither of which is empty; false: it is a leaf.
    bool divide(References references, size_t budget, int depth, SpatialNode& node, References& low,
                References& high) {
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
            if (cut(references, box, parting, to_beat, budget, node, low, high)) return true;
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
             size_t budget, SpatialNode& node, References& low, References& high) {
        if (options_.budget == 0 || !sides_overlap(parting)) return false;
        const WorkSum::Span span(cut_work_);
        const Cut best = best_cut(references, box, to_beat);
        if (!(best.cost < to_beat)) return false;
        if (budget == 0) {
            lacked_budget_.store(true, std::memory_order_relaxed);
            return false;
        }
        Sides sides;
        cut_by(best, references, budget, sides);
        if (sides.low.empty() || sides.high.empty()) return false;
        splits_.fetch_add(1, std::memory_order_relaxed);
        node.of_cut = std::move(sides.low);
        const size_t middle = node.of_cut.size();
        node.of_cut.insert(node.of_cut.end(), sides.high.begin(), sides.high.end());
        low = References(node.of_cut).first(middle), high = References(node.of_cut).subspan(middle);
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
        middle_.resize(ids_.size());
        tbb::parallel_for(size_t{0}, ids_.size(),
                          [&](size_t i) { middle_[i] = pose_of(grids_.grids[ids_[i].grid], ids_[i], 0.5f); });
    }
    const QuadPose& pose_at_middle(uint32_t id) const { return middle_[PartId::index(id)]; }
    /// The two parts of a reference's box: those of its polygon (tight), or of the box alone.
    Chopped divided(const QuadPose& pose, const Box3f& box, int axis, float at) const {
        return options_.tight ? chop(pose, box, axis, at) : cut_box(box, axis, at);
    }
    static Chopped cut_box(const Box3f& box, int axis, float at) {
        Chopped parts{box, box};
        parts.low.max[axis] = parts.high.min[axis] = at;
        return parts;
    }

    /// The planes between slabs of a node's box along an axis; none where coordinates are as coarse as slabs,
    /// or slabs too thin to be counted.
    struct Slabs {
        int axis;
        size_t count = 0;
        std::array<float, kMostSlabs + 1> planes;

        Slabs(const Box3f& box, int along, size_t references) : axis(along) {
            const size_t wanted = std::clamp(references / 4, kLeastSlabs, kMostSlabs);
            for (size_t i = 0; i <= wanted; ++i)
                planes[i] = box.min[axis] + (box.max[axis] - box.min[axis]) *
                                                (static_cast<float>(i) / static_cast<float>(wanted));
            const auto end = planes.begin() + static_cast<std::ptrdiff_t>(wanted) + 1;
            if (std::adjacent_find(planes.begin(), end, std::greater_equal<>()) == end) count = wanted;
            if (count == 0) return;
            per_unit_ = static_cast<float>(count) / (planes[count] - planes[0]);
            if (!std::isfinite(per_unit_)) count = 0;
            last_ = static_cast<float>(count - 1);
        }
        size_t of(float x) const {
            const float along_slabs = (x - planes[0]) * per_unit_;
            auto slab = static_cast<size_t>(static_cast<int>(std::clamp(along_slabs, 0.0f, last_)));
            while (slab > 0 && x < planes[slab]) --slab;  // what was rounded
            while (slab + 1 < count && x >= planes[slab + 1]) ++slab;
            return slab;
        }

      private:
        float per_unit_ = 0, last_ = 0;
    };

    /// What lies in a slab: boxes, and how many references begin and end there; whole boxes of these.
    struct InSlab {
        BoxSum boxes, of_begin, of_end;
        uint32_t begin = 0, end = 0;

        void begins(const Box3f& whole) { of_begin.add(whole), ++begin; }
        void ends(const Box3f& whole) { of_end.add(whole), ++end; }
    };
    using InSlabs = std::array<InSlab, kMostSlabs>;

    /// The cheapest of the planes between slabs along that axis which is best if boxes are cut without
    /// looking at what is in them: that tells the axis, and spares two thirds of the work. What is in them is
    /// not looked at either where no plane can cost less than `to_beat`.
    Cut best_cut(std::span<const SahItem> references, const Box3f& box, double to_beat) const {
        Cut rough;
        for (int axis = 0; axis < 3; ++axis)
            consider_planes(references, Slabs(box, axis, references.size()), half_area(box), false, rough);
        if (!options_.tight || !(rough.cost < sah::kInfinite)) return rough;
        Cut best;
        if (!(rough.least < to_beat)) return best;
        consider_planes(references, Slabs(box, rough.axis, references.size()), half_area(box), true, best);
        return best;
    }

    /// A reference counts below a plane if it begins below, and above if it ends above: what the plane cuts
    /// counts on both sides [Stich09].
    void consider_planes(std::span<const SahItem> references, const Slabs& slabs, double node_area,
                         bool tight, Cut& best) const {
        if (slabs.count == 0) return;
        InSlabs in;
        if (tight)
            add_polygons(references, slabs, in);
        else
            add_boxes(references, slabs, in);
        const double visit = node_area * kTraversalCost;
        std::array<BoxSum, kMostSlabs + 1> above;
        std::array<double, kMostSlabs> area_above, whole_area_above;
        BoxSum whole_above;
        for (size_t i = slabs.count; i-- > 1;) {
            above[i] = above[i + 1], above[i].add(in[i].boxes);
            whole_above.add(in[i].of_begin);
            area_above[i] = half_area(above[i].box()), whole_area_above[i] = half_area(whole_above.box());
        }
        Cut here;
        BoxSum below, whole_below;
        size_t low = 0, high = references.size();
        for (size_t i = 1; i < slabs.count; ++i) {
            below.add(in[i - 1].boxes), whole_below.add(in[i - 1].of_end);
            low += in[i - 1].begin, high -= in[i - 1].end;
            if (low == 0 || high == 0) continue;
            here.least =
                std::min(here.least, visit + half_area(whole_below.box()) * static_cast<double>(low) +
                                         whole_area_above[i] * static_cast<double>(high));
            const Box3f low_box = below.box();
            const double cost = visit + half_area(low_box) * static_cast<double>(low) +
                                area_above[i] * static_cast<double>(high);
            if (cost < here.cost)
                here = {cost, slabs.axis, slabs.planes[i], low_box, above[i].box(), low, high, here.least};
        }
        if (here.cost < best.cost) best = here;
    }

    static void add_boxes(std::span<const SahItem> references, const Slabs& slabs, InSlabs& in) {
        for (const SahItem& item : references) {
            const size_t first = slabs.of(item.box.min[slabs.axis]);
            const size_t last = std::max(first, slabs.of(item.box.max[slabs.axis]));
            in[first].begins(item.box), in[last].ends(item.box);
            for (size_t slab = first; slab <= last; ++slab) in[slab].boxes.add(item.box);
        }
        // What planes cut off is the same for all boxes in a slab.
        for (size_t slab = 0; slab < slabs.count; ++slab) {
            if (slab > 0) in[slab].boxes.cut_below(slabs.axis, slabs.planes[slab]);
            if (slab + 1 < slabs.count) in[slab].boxes.cut_above(slabs.axis, slabs.planes[slab + 1]);
        }
    }

    /// Cuts polygons slab by slab from below: what is left above a plane goes on to the next one.
    void add_polygons(std::span<const SahItem> references, const Slabs& slabs, InSlabs& in) const {
        for (const SahItem& item : references) {
            const size_t first = slabs.of(item.box.min[slabs.axis]);
            const size_t last = std::max(first, slabs.of(item.box.max[slabs.axis]));
            in[first].begins(item.box), in[last].ends(item.box);
            Box3f rest = item.box;
            if (first < last) {
                const QuadPose& pose = pose_at_middle(item.id);
                for (size_t slab = first; slab < last && !rest.isEmpty(); ++slab) {
                    const Chopped parts = chop(pose, rest, slabs.axis, slabs.planes[slab + 1]);
                    if (!parts.low.isEmpty()) in[slab].boxes.add(parts.low);
                    rest = parts.high;
                }
            }
            if (!rest.isEmpty()) in[last].boxes.add(rest);
        }
    }

    /// Puts references on the sides of a plane: on both where it cuts them, but for those that cost less
    /// whole on one side [Stich09 sec. 4.4], and when the budget is used up.
    void cut_by(Cut cut, std::span<const SahItem> references, size_t budget, Sides& sides) {
        for (const SahItem& item : references) {
            if (item.box.max[cut.axis] <= cut.at)
                sides.low.push_back(item);
            else if (item.box.min[cut.axis] >= cut.at)
                sides.high.push_back(item);
            else
                cut_reference(item, cut, budget, sides);
        }
    }

    /// One that the plane goes through: cut, or whole on the side where that costs least. A side that takes
    /// it whole grows, and the other counts one less, so that those which follow are judged by that.
    void cut_reference(const SahItem& item, Cut& cut, size_t& budget, Sides& sides) {
        const Chopped parts = divided(pose_at_middle(item.id), item.box, cut.axis, cut.at);
        if (parts.low.isEmpty() || parts.high.isEmpty()) {
            // Its polygon is on one side but for rounding.
            (parts.low.isEmpty() ? sides.high : sides.low).push_back(item);
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
            sides.low.push_back({parts.low, 1, item.id | PartId::kPart});
            sides.high.push_back({parts.high, 1, item.id | PartId::kPart});
        } else if (in_low <= in_high) {
            sides.low.push_back(item);
            cut.low = low_with, --cut.high_count;
        } else {
            sides.high.push_back(item);
            cut.high = high_with, --cut.low_count;
        }
    }

    /// Inner nodes in preorder, leaves from left to right.
    static TopLink number(const SpatialNode& node, SpatialTopology& result) {
        if (!node.low) {
            result.leaf_first.push_back(static_cast<uint32_t>(result.references.size()));
            result.references.insert(result.references.end(), node.references.begin(), node.references.end());
            return TopLink::leaf(static_cast<uint32_t>(result.leaf_first.size() - 1));
        }
        const auto index = static_cast<uint32_t>(result.tree.inner.size());
        result.tree.inner.emplace_back();
        const TopLink low = number(*node.low, result), high = number(*node.high, result);
        result.tree.inner[index] = {low, high};
        return TopLink::inner(index);
    }

    const Grids& grids_;
    std::span<const MicropolygonId> ids_;
    const SpatialOptions& options_;
    UnsetVector<QuadPose> middle_;  ///< micropolygon -> where it is at mid-shutter; none without a budget
    double root_area_ = 0;
    std::atomic<uint64_t> splits_{0};
    std::atomic<bool> lacked_budget_{false};
    WorkSum work_, cut_work_;
};

}  // namespace

SpatialTopology build_spatial_topology(std::span<SahItem> items, const Grids& grids,
                                       std::span<const MicropolygonId> ids, const SpatialOptions& options) {
    return SpatialBuilder(grids, ids, options).build(items);
}

}  // namespace trapeze
