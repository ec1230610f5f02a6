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
    using Lanes = BoxLanes::Lanes;

    Lanes from{}, scale{};  ///< along x, y, z; scale 0: an axis without extent

    explicit Binning(const Box3f& centroids) {
        const V3f extent = centroids.max - centroids.min;
        for (int k = 0; k < 3; ++k)
            from[k] = centroids.min[k], scale[k] = extent[k] > 0 ? kBins / extent[k] : 0;
    }
    /// Along all axes at once.
    std::array<int32_t, 3> bins_of(const BoxLanes& box) const {
        const Lanes high = __builtin_shufflevector(box.high, box.high, 1, 2, 3, 3), none{};
        Lanes at = (box.low * 0.5f + high * 0.5f - from) * scale;
        at = at > none ? at : none;  // NaN too
        at = at < kBins - 1.0f ? at : none + (kBins - 1.0f);
        const auto bins = __builtin_convertvector(at, decltype(at < at));
        return {bins[0], bins[1], bins[2]};
    }
    int bin_of(const SahItem& item, int axis) const {
        return bins_of(BoxLanes(item.box))[static_cast<size_t>(axis)];
    }
};

/// Sums of items by bin, for all three axes in one pass over the items.
struct Bins {
    const Binning* binning;
    std::array<std::array<Bin, kBins>, 3> of_axis;

    void add(const SahItem& item) {
        const BoxLanes box(item.box);
        const std::array<int32_t, 3> bins = binning->bins_of(box);
        for (size_t axis = 0; axis < 3; ++axis) {
            // Along an axis without extent all are in the first bin, which nobody asks for.
            Bin& bin = of_axis[axis][static_cast<size_t>(bins[axis])];
            bin.boxes.add(box);
            bin.weight += item.weight, ++bin.count;
        }
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
    // Sums may be kilobytes: they are copied as little as can be.
    const auto add = [&](size_t first, size_t last, const Sum& to) {
        Sum sum = to;
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
