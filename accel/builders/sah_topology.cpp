#include "accel/builders/sah_topology.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_invoke.h>
#include <tbb/parallel_reduce.h>

#include <algorithm>
#include <limits>

namespace trapeze {
namespace {

/// Bins along each axis, hence 31 planes to split at.
constexpr int kBins = 32;
constexpr size_t kParallelFrom = 1024;            ///< items below which a subtree is one task
constexpr size_t kParallelBinningFrom = 1 << 16;  ///< items from which one node's bins are filled in parallel
constexpr double kInfinite = std::numeric_limits<double>::infinity();

/// Some items together: their box, the tests they stand for, their number.
struct Bin {
    Box3f box;
    uint64_t weight = 0;
    size_t count = 0;

    void add(const Bin& o) {
        box.extendBy(o.box);
        weight += o.weight, count += o.count;
    }
    void add(const SahItem& item) { add(Bin{item.box, item.weight, 1}); }
    /// The SAH's term for one side: half its area times its tests. 0 where there is nothing.
    double cost() const { return half_area(box) * static_cast<double>(weight); }
};

/// What a node's choice of a split needs of its items: their sum, and the box of their centroids, which bins
/// divide.
struct Extent {
    Bin all;
    Box3f centroids;

    void add(const SahItem& item) {
        all.add(item);
        centroids.extendBy(item.centroid());
    }
    void add(const Extent& o) {
        all.add(o.all);
        centroids.extendBy(o.centroids);
    }
};

/// The rule that gives an item its bin along each axis: kBins equal parts of the centroids' box.
struct Binning {
    V3f from, scale;  ///< scale 0: an axis without extent

    explicit Binning(const Box3f& centroids) : from(centroids.min) {
        const V3f extent = centroids.max - centroids.min;
        for (int k = 0; k < 3; ++k) scale[k] = extent[k] > 0 ? kBins / extent[k] : 0;
    }
    int bin_of(const SahItem& item, int axis) const {
        const float at = (item.centroid()[axis] - from[axis]) * scale[axis];
        return at > 0 ? static_cast<int>(std::min(at, kBins - 1.0f)) : 0;  // NaN too
    }
};

/// Sums of items by bin, for all three axes in one pass over the items.
struct Bins {
    const Binning* binning;
    std::array<std::array<Bin, kBins>, 3> of_axis;

    void add(const SahItem& item) {
        for (int axis = 0; axis < 3; ++axis)
            if (binning->scale[axis] > 0) of_axis[axis][binning->bin_of(item, axis)].add(item);
    }
    void add(const Bins& o) {
        for (int axis = 0; axis < 3; ++axis)
            for (int b = 0; b < kBins; ++b) of_axis[axis][b].add(o.of_axis[axis][b]);
    }
};

/// The sum of items. The same in whatever order threads make it: boxes join exactly, weights and counts are
/// integers.
template <class Sum>
Sum sum_of(std::span<const SahItem> part, const Sum& zero) {
    const auto add = [&](size_t first, size_t last, Sum sum) {
        for (size_t i = first; i < last; ++i) sum.add(part[i]);
        return sum;
    };
    if (part.size() < kParallelBinningFrom) return add(0, part.size(), zero);
    return tbb::parallel_reduce(
        tbb::blocked_range<size_t>(0, part.size(), kParallelBinningFrom / 4), zero,
        [&](const auto& range, const Sum& sum) { return add(range.begin(), range.end(), sum); },
        [](Sum a, const Sum& b) {
            a.add(b);
            return a;
        });
}

/// A place to divide a node, and what the node costs then (kTraversalCost and tests, times half areas);
/// infinite: none found.
struct Split {
    double cost = kInfinite;
    int axis = 0;
    size_t place = 0;  ///< the first bin, or item of the axis's order, of the upper side
};

/// The cheapest of kBins - 1 planes along each axis that leaves something on both sides; the first one of
/// equals. Two sweeps over the bins: costs of all upper sides from above, then lower sides from below.
Split best_of_bins(const Bins& bins, const Extent& extent) {
    Split best;
    for (int axis = 0; axis < 3; ++axis) {
        if (!(bins.binning->scale[axis] > 0)) continue;
        const std::array<Bin, kBins>& bin = bins.of_axis[axis];
        std::array<double, kBins> cost_above{};  // of bins [b, kBins)
        Bin above;
        for (int b = kBins - 1; b > 0; --b) {
            above.add(bin[b]);
            cost_above[b] = above.cost();
        }
        Bin below;
        for (int b = 1; b < kBins; ++b) {
            below.add(bin[b - 1]);
            if (below.count == 0 || below.count == extent.all.count) continue;
            const double cost = half_area(extent.all.box) * kTraversalCost + below.cost() + cost_above[b];
            if (cost < best.cost) best = {cost, axis, static_cast<size_t>(b)};
        }
    }
    return best;
}

/// Items of a small part in the order of their centroids along an axis; equal ones keep the order that they
/// came in, so that the order is total. At most kMostSwept, so that nothing is allocated.
class AxisOrder {
  public:
    AxisOrder(std::span<const SahItem> part, int axis) : part_(part) {
        for (size_t i = 0; i < part.size(); ++i) {
            const float at = part[i].centroid()[axis];
            place_[i].at = at >= kLeast ? at : kLeast;  // NaN has a place too
            place_[i].item = static_cast<uint32_t>(i);
        }
        std::sort(place_.begin(), place_.begin() + static_cast<std::ptrdiff_t>(part.size()));
    }
    const SahItem& operator[](size_t i) const { return part_[place_[i].item]; }

    /// Tries a split between each two neighbours, where bins try only at planes. node_cost: of visiting the
    /// node.
    void consider(int axis, double node_cost, Split& best) const {
        std::array<double, SahOptions::kMostSwept> cost_above;
        Bin above;
        for (size_t i = part_.size() - 1; i > 0; --i) {
            above.add((*this)[i]);
            cost_above[i] = above.cost();
        }
        Bin below;
        for (size_t i = 1; i < part_.size(); ++i) {
            below.add((*this)[i - 1]);
            const double cost = node_cost + below.cost() + cost_above[i];
            if (cost < best.cost) best = {cost, axis, i};
        }
    }

  private:
    static constexpr float kLeast = std::numeric_limits<float>::lowest();
    std::span<const SahItem> part_;
    struct Place {
        float at;
        uint32_t item;
        auto operator<=>(const Place&) const = default;
    };
    std::array<Place, SahOptions::kMostSwept> place_;
};

/// Builds the tree over items, which it sorts in place: a subtree is a range of them.
class Builder {
  public:
    Builder(std::vector<SahItem>& items, const SahOptions& options) : items_(items), options_(options) {
        if (items.size() > 1) split_at_.resize(items.size() - 1);
    }

    SahTopology build() {
        SahTopology result;
        if (!items_.empty()) {
            const TopLink root = build_sah(0, items_.size(), 0);
            result.tree.root = number(root, result);
        }
        result.leaf_first.push_back(static_cast<uint32_t>(items_.size()));
        return result;
    }

  private:
    std::span<SahItem> part(size_t first, size_t last) const {
        return std::span(items_).subspan(first, last - first);
    }

    /// The subtree of items [first, last). While building, a leaf is named by its first item and an inner
    /// node by the first item of its upper side, less one: names that do not depend on who builds first.
    TopLink build_sah(size_t first, size_t last, int depth) {
        if (last - first < options_.leaf_below) return TopLink::leaf(static_cast<uint32_t>(first));
        const size_t middle = depth < kSahDepthLimit ? split(part(first, last)) : 0;
        if (middle == 0) {
            options_.fallback_order(part(first, last));
            return build_medians(first, last);
        }
        return join(first, first + middle, last,
                    [this, depth](size_t from, size_t to) { return build_sah(from, to, depth + 1); });
    }

    /// The subtree of items in the fallback's order, halved in the middle until leaves are small. At most 32
    /// levels.
    TopLink build_medians(size_t first, size_t last) {
        if (last - first < options_.leaf_below) return TopLink::leaf(static_cast<uint32_t>(first));
        return join(first, first + (last - first) / 2, last,
                    [this](size_t from, size_t to) { return build_medians(from, to); });
    }

    /// The node over items [first, last) that is divided at `middle`; both halves are built by build(first,
    /// last), as tasks where there are enough items.
    template <class Build>
    TopLink join(size_t first, size_t middle, size_t last, Build&& build) {
        std::array<TopLink, 2>& node = split_at_[middle - 1];
        if (last - first < kParallelFrom) {
            node = {build(first, middle), build(middle, last)};
        } else {
            tbb::parallel_invoke([&] { node[0] = build(first, middle); },
                                 [&] { node[1] = build(middle, last); });
        }
        return TopLink::inner(static_cast<uint32_t>(middle - 1));
    }

    /// Parts the items in place by the best split; the size of the lower part, 0 where no split is good
    /// enough.
    size_t split(std::span<SahItem> part) const {
        return part.size() <= options_.sweep_up_to ? split_by_sweep(part) : split_by_bins(part);
    }
    /// A split is good when it costs less than testing all items of the node, unless any split will do.
    bool is_good(const Split& best, const Bin& all) const {
        return options_.split_anyway ? best.cost < kInfinite : best.cost < all.cost();
    }

    size_t split_by_bins(std::span<SahItem> part) const {
        const Extent extent = sum_of(part, Extent{});
        const Binning binning(extent.centroids);
        const Split best = best_of_bins(sum_of(part, Bins{&binning, {}}), extent);
        if (!is_good(best, extent.all)) return 0;
        // Stable: the order of items, hence of leaves, is the same on every machine.
        const auto middle = std::stable_partition(part.begin(), part.end(), [&](const SahItem& item) {
            return static_cast<size_t>(binning.bin_of(item, best.axis)) < best.place;
        });
        return static_cast<size_t>(middle - part.begin());
    }

    size_t split_by_sweep(std::span<SahItem> part) const {
        Extent extent;
        for (const SahItem& item : part) extent.add(item);
        Split best;
        for (int axis = 0; axis < 3; ++axis)
            if (extent.centroids.max[axis] > extent.centroids.min[axis])
                AxisOrder(part, axis).consider(axis, half_area(extent.all.box) * kTraversalCost, best);
        if (!is_good(best, extent.all)) return 0;
        // The order reads the part that is to be written.
        std::vector<SahItem> sorted;
        sorted.reserve(part.size());
        const AxisOrder order(part, best.axis);
        for (size_t i = 0; i < part.size(); ++i) sorted.push_back(order[i]);
        std::copy(sorted.begin(), sorted.end(), part.begin());
        return best.place;
    }

    /// Gives the nodes below a link their final numbers, inner ones in preorder and leaves from left to
    /// right; adds each leaf's first item to leaf_first.
    TopLink number(TopLink built, SahTopology& result) const {
        if (built.is_leaf()) {
            result.leaf_first.push_back(built.index());
            return TopLink::leaf(static_cast<uint32_t>(result.leaf_first.size() - 1));
        }
        const auto index = static_cast<uint32_t>(result.tree.inner.size());
        result.tree.inner.emplace_back();
        for (const int side : {0, 1}) {
            const TopLink link = number(split_at_[built.index()][side], result);
            result.tree.inner[index][side] = link;
        }
        return TopLink::inner(index);
    }

    std::vector<SahItem>& items_;
    const SahOptions& options_;
    /// The children of every inner node, at the first item of its upper side less one: one place for each gap
    /// between two items, so that threads write to places of their own.
    std::vector<std::array<TopLink, 2>> split_at_;
};

}  // namespace

double half_area(const Box3f& box) {
    if (box.isEmpty()) return 0;
    const V3d size = V3d(box.max) - V3d(box.min);
    return size.x * size.y + size.y * size.z + size.z * size.x;
}

SahTopology build_sah_topology(std::vector<SahItem>& items, const SahOptions& options) {
    return Builder(items, options).build();
}

}  // namespace trapeze
