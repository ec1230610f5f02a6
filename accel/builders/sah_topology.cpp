#include "accel/builders/sah_topology.h"

#include <tbb/parallel_invoke.h>

#include <algorithm>
#include <limits>

#include "accel/builders/sah_bins.h"
#include "accel/builders/sah_sweep.h"
#include "core/memory/large_pages.h"

namespace trapeze {
namespace {

constexpr size_t kParallelFrom = 1024;  ///< items below which a subtree is one task

/// Builds the tree over items, which it sorts in place: a subtree is a range of them.
class Builder {
  public:
    Builder(std::span<SahItem> items, const SahOptions& options) : items_(items), options_(options) {
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
    std::span<SahItem> part(size_t first, size_t last) const { return items_.subspan(first, last - first); }

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
    bool is_good(const sah::Split& best, const sah::Bin& all) const {
        return options_.split_anyway ? best.cost < sah::kInfinite : best.cost < all.cost();
    }

    /// Reads the items three times: for the box of their centroids, which bins divide, for the sums of bins,
    /// and to part them.
    size_t split_by_bins(std::span<SahItem> part) const {
        const sah::Extent extent = sah::sum_of(part, sah::Extent{});
        const sah::Binning binning(extent.centroids.box());
        const sah::Split best = sah::best_of_bins(sah::sum_of(part, sah::Bins{&binning, {}}), extent);
        if (!is_good(best, extent.all)) return 0;
        // Stable: the order of items, hence of leaves, is the same on every machine.
        const auto middle = std::stable_partition(part.begin(), part.end(), [&](const SahItem& item) {
            return static_cast<size_t>(binning.bin_of(item, best.axis)) < best.place;
        });
        return static_cast<size_t>(middle - part.begin());
    }

    /// Sorts along each axis in turn and keeps only the best place found; its order is made once more at the
    /// end.
    size_t split_by_sweep(std::span<SahItem> part) const {
        sah::Extent extent;
        for (const SahItem& item : part) extent.add(item);
        const Box3f centroids = extent.centroids.box();
        const double visit = half_area(extent.all.box()) * kTraversalCost;
        sah::Split best;
        for (int axis = 0; axis < 3; ++axis)
            if (centroids.max[axis] > centroids.min[axis])
                sah::AxisOrder(part, axis).consider(axis, visit, best);
        if (!is_good(best, extent.all)) return 0;
        // The order reads the part that is to be written.
        std::vector<SahItem> sorted;
        sorted.reserve(part.size());
        const sah::AxisOrder order(part, best.axis);
        for (size_t i = 0; i < part.size(); ++i) sorted.push_back(order[i]);
        std::copy(sorted.begin(), sorted.end(), part.begin());
        return best.place;
    }

    /// Gives the nodes below a link their final numbers, inner ones in preorder and leaves from left to
    /// right; adds each leaf's first item to leaf_first. The recursion is as deep as the tree:
    /// kTopDepthLimit.
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

    std::span<SahItem> items_;
    const SahOptions& options_;
    /// The children of every inner node, at the first item of its upper side less one: one place for each gap
    /// between two items, so that threads write to places of their own.
    UnsetVector<std::array<TopLink, 2>> split_at_;
};

}  // namespace

SahTopology build_sah_topology(std::span<SahItem> items, const SahOptions& options) {
    return Builder(items, options).build();
}

}  // namespace trapeze
