/// Sums of boxes by bin along each axis, and the plane between bins where a node of a tree is split at the
/// least cost of the surface area heuristic [Wald07]: what all builders over boxes share.
#pragma once

#include <tbb/blocked_range.h>
#include <tbb/parallel_reduce.h>

#include <algorithm>
#include <array>
#include <limits>
#include <span>

#include "accel/builders/box_sum.h"
#include "accel/builders/sah_topology.h"

namespace trapeze::sah {

/// Bins along each axis, hence 31 planes to split at.
inline constexpr int kBins = 32;
inline constexpr size_t kParallelBinningFrom =
    1 << 16;  ///< items from which one node's bins are filled in parallel
/// The cost where no split has been found.
inline constexpr double kInfinite = std::numeric_limits<double>::infinity();

/// Some items together: their box, the tests they stand for, their number.
struct Bin {
    BoxSum boxes;
    uint64_t weight = 0;
    size_t count = 0;

    void add(const Bin& o) {
        boxes.add(o.boxes);
        weight += o.weight, count += o.count;
    }
    void add(const SahItem& item) {
        boxes.add(item.box);
        weight += item.weight, ++count;
    }
    Box3f box() const { return boxes.box(); }
    /// The SAH's term for one side: half its area times its tests. 0 where there is nothing.
    double cost() const { return half_area(box()) * static_cast<double>(weight); }
};

/// What a node's choice of a split needs of its items: their sum, and the box of their centroids, which bins
/// divide.
struct Extent {
    Bin all;
    BoxSum centroids;

    void add(const SahItem& item) {
        all.add(item);
        centroids.add(item.centroid());
    }
    void add(const Extent& o) {
        all.add(o.all);
        centroids.add(o.centroids);
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
Split best_of_bins(const Bins& bins, const Extent& extent);

}  // namespace trapeze::sah
