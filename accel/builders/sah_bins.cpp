#include "accel/builders/sah_bins.h"

namespace trapeze::sah {

Split best_of_bins(const Bins& bins, const Extent& extent) {
    Split best;
    const double visit = half_area(extent.all.box()) * kTraversalCost;
    for (int axis = 0; axis < 3; ++axis) {
        // Along an axis without extent all centroids are in one bin, and no plane divides them.
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
            const double cost = visit + below.cost() + cost_above[b];
            if (cost < best.cost) best = {cost, axis, static_cast<size_t>(b)};
        }
    }
    return best;
}

}  // namespace trapeze::sah
