#include "accel/moving/linear_topology.h"

#include <tbb/parallel_for.h>
#include <tbb/parallel_sort.h>

#include <algorithm>
#include <array>
#include <bit>

#include "accel/builders/interleaved_bits.h"
#include "accel/builders/sah_bins.h"

namespace trapeze {
namespace {

/// With the halves of what has one code, of at most 2^31 references, no deeper than kTopDepthLimit.
constexpr int kMortonBits = 18;
static_assert(3 * kMortonBits + 31 <= kTopDepthLimit);

/// A code and the place of its item: what is sorted, for items are four times as large.
struct CodedItem {
    uint64_t code;
    uint32_t item;

    bool operator<(const CodedItem& o) const { return code != o.code ? code < o.code : item < o.item; }
};

uint64_t morton_code(const V3f& at, const Box3f& box) {
    constexpr float kSteps = 1 << kMortonBits;
    std::array<uint64_t, 3> step;
    for (int k = 0; k < 3; ++k) {
        const float scaled = (at[k] - box.min[k]) / (box.max[k] - box.min[k]) * kSteps;
        // What is no number goes to the lower end.
        step[static_cast<size_t>(k)] = scaled > 0 ? static_cast<uint64_t>(std::min(scaled, kSteps - 1)) : 0u;
    }
    return interleaved(step[0], step[1], step[2]);
}

class LinearBuilder {
  public:
    LinearBuilder(std::span<const CodedItem> order, size_t leaf_below, SpatialTopology& result)
        : order_(order), leaf_below_(leaf_below), result_(result) {}

    /// The subtree of items [first, last) of the order; inner nodes in preorder.
    TopLink build(size_t first, size_t last) {
        if (last - first < leaf_below_) {
            result_.leaf_first.push_back(static_cast<uint32_t>(first));
            return TopLink::leaf(static_cast<uint32_t>(result_.leaf_first.size() - 1));
        }
        const auto index = static_cast<uint32_t>(result_.tree.inner.size());
        result_.tree.inner.emplace_back();
        const size_t middle = divide(first, last);
        const TopLink low = build(first, middle), high = build(middle, last);
        result_.tree.inner[index] = {low, high};
        return TopLink::inner(index);
    }

  private:
    /// The first item that has the highest bit in which the range's codes differ.
    size_t divide(size_t first, size_t last) const {
        const uint64_t differing = order_[first].code ^ order_[last - 1].code;
        if (differing == 0) return first + (last - first) / 2;
        const uint64_t bit = std::bit_floor(differing);
        const auto begin = order_.begin() + static_cast<std::ptrdiff_t>(first);
        const auto end = order_.begin() + static_cast<std::ptrdiff_t>(last);
        const auto middle =
            std::partition_point(begin, end, [bit](const CodedItem& o) { return !(o.code & bit); });
        return static_cast<size_t>(middle - order_.begin());
    }

    std::span<const CodedItem> order_;
    size_t leaf_below_;
    SpatialTopology& result_;
};

}  // namespace

SpatialTopology build_linear_topology(std::span<const SahItem> items, size_t leaf_below) {
    SpatialTopology result;
    if (!items.empty()) {
        const Box3f centroids = sah::sum_of(items, sah::Extent{}).centroids;
        std::vector<CodedItem> order(items.size());
        tbb::parallel_for(size_t{0}, items.size(), [&](size_t i) {
            order[i] = {morton_code(items[i].centroid(), centroids), static_cast<uint32_t>(i)};
        });
        tbb::parallel_sort(order.begin(), order.end());
        result.tree.root = LinearBuilder(order, leaf_below, result).build(0, items.size());
        result.references.resize(items.size());
        tbb::parallel_for(size_t{0}, items.size(),
                          [&](size_t i) { result.references[i] = items[order[i].item]; });
    }
    result.leaf_first.push_back(static_cast<uint32_t>(items.size()));
    return result;
}

}  // namespace trapeze
