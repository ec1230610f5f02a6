#include "accel/builders/top_topology.h"

#include <tbb/parallel_invoke.h>

#include <algorithm>
#include <array>
#include <limits>
#include <numeric>

#include "accel/builders/morton_order.h"

namespace trapeze {
namespace {

constexpr int kBins = 32;
constexpr size_t kParallelFrom = 1024;  ///< grids below which a subtree is one task
constexpr double kTraversalCost = 1;    ///< of a node, in tests of a micropolygon

double half_area(const Box3f& box) {
    if (box.isEmpty()) return 0;
    const V3d size = V3d(box.max) - V3d(box.min);
    return size.x * size.y + size.y * size.z + size.z * size.x;
}

struct Bin {
    Box3f box;
    uint64_t weight = 0;
    size_t count = 0;

    void add(const Bin& o) {
        box.extendBy(o.box);
        weight += o.weight, count += o.count;
    }
    double cost() const { return half_area(box) * static_cast<double>(weight); }
};

/// Bins of centroids along one axis.
struct Binning {
    int axis = 0;
    float from = 0, scale = 0;

    int bin_of(const GridSummary& grid) const {
        const float at = (grid.centroid()[axis] - from) * scale;
        return at > 0 ? static_cast<int>(std::min(at, kBins - 1.0f)) : 0;  // NaN too
    }
};

struct Split {
    double cost = std::numeric_limits<double>::infinity();
    Binning binning;
    int bin = 0;  ///< the first bin of the upper side
};

class Builder {
  public:
    explicit Builder(std::span<const GridSummary> grids) : grids_(grids), order_(grids.size()) {
        std::iota(order_.begin(), order_.end(), 0u);
        topology_.inner.resize(grids.empty() ? 0 : grids.size() - 1);
    }

    TopTopology build() {
        if (!order_.empty()) topology_.root = build_sah(order_, 0, 0);
        return std::move(topology_);
    }

  private:
    /// The subtree of some grids; its inner nodes are numbered from `first_inner`.
    TopLink build_sah(std::span<uint32_t> part, uint32_t first_inner, int depth) {
        if (part.size() == 1) return TopLink::leaf(part[0]);
        const size_t middle = depth < kSahDepthLimit ? split_by_sah(part) : 0;
        if (middle == 0) {
            sort_by_orientation(part, grids_);
            return build_medians(part, first_inner);
        }
        return join(part, middle, first_inner, [this, depth](std::span<uint32_t> half, uint32_t inner) {
            return build_sah(half, inner, depth + 1);
        });
    }

    /// The subtree of a sorted list, halved again and again.
    TopLink build_medians(std::span<uint32_t> part, uint32_t first_inner) {
        if (part.size() == 1) return TopLink::leaf(part[0]);
        return join(part, part.size() / 2, first_inner,
                    [this](std::span<uint32_t> half, uint32_t inner) { return build_medians(half, inner); });
    }

    template <class Build>
    TopLink join(std::span<uint32_t> part, size_t middle, uint32_t first_inner, Build&& build) {
        const auto low = part.first(middle), high = part.subspan(middle);
        // A subtree of n grids has n - 1 inner nodes, so that numbers do not depend on who builds first.
        const auto low_inner = first_inner + 1, high_inner = first_inner + static_cast<uint32_t>(middle);
        std::array<TopLink, 2>& node = topology_.inner[first_inner];
        if (part.size() < kParallelFrom) {
            node = {build(low, low_inner), build(high, high_inner)};
        } else {
            tbb::parallel_invoke([&] { node[0] = build(low, low_inner); },
                                 [&] { node[1] = build(high, high_inner); });
        }
        return TopLink::inner(first_inner);
    }

    /// Parts the grids by the best split; the size of the lower part, 0 when none reduces the cost.
    size_t split_by_sah(std::span<uint32_t> part) const {
        Bin all;
        Box3f centroids;
        for (const uint32_t i : part) {
            all.add({grids_[i].box, grids_[i].weight, 1});
            centroids.extendBy(grids_[i].centroid());
        }
        Split best;
        for (int axis = 0; axis < 3; ++axis) {
            const float extent = centroids.max[axis] - centroids.min[axis];
            if (extent > 0)
                consider_axis(part, {axis, centroids.min[axis], kBins / extent}, half_area(all.box), best);
        }
        if (!(best.cost < all.cost())) return 0;
        const auto middle = std::stable_partition(
            part.begin(), part.end(), [&](uint32_t i) { return best.binning.bin_of(grids_[i]) < best.bin; });
        return static_cast<size_t>(middle - part.begin());
    }

    void consider_axis(std::span<const uint32_t> part, const Binning& binning, double parent_area,
                       Split& best) const {
        std::array<Bin, kBins> bins;
        for (const uint32_t i : part)
            bins[binning.bin_of(grids_[i])].add({grids_[i].box, grids_[i].weight, 1});
        std::array<double, kBins> cost_above{};  // of bins [b, kBins)
        Bin above;
        for (int b = kBins - 1; b > 0; --b) {
            above.add(bins[b]);
            cost_above[b] = above.cost();
        }
        Bin below;
        for (int b = 1; b < kBins; ++b) {
            below.add(bins[b - 1]);
            if (below.count == 0 || below.count == part.size()) continue;
            const double cost = parent_area * kTraversalCost + below.cost() + cost_above[b];
            if (cost < best.cost) best = {cost, binning, b};
        }
    }

    std::span<const GridSummary> grids_;
    std::vector<uint32_t> order_;
    TopTopology topology_;
};

}  // namespace

TopTopology build_top_topology(std::span<const GridSummary> grids) {
    return Builder(grids).build();
}

}  // namespace trapeze
