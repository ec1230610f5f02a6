#include "accel/moving/linear_topology.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <bit>

#include "accel/builders/interleaved_bits.h"
#include "accel/builders/sort_by_code.h"

namespace trapeze {
namespace {

/// With the halves of what has one code, of at most 2^31 references, no deeper than kTopDepthLimit.
constexpr int kMortonBits = 18;
static_assert(3 * kMortonBits + 31 <= kTopDepthLimit);

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

/// Items that one task divides: few enough for caches.
constexpr size_t kItemsOfSubtree = 1 << 14;

/// A part of the tree; links within it count its own nodes and leaves.
struct Subtree {
    size_t first, last;  ///< its items in the order
    std::vector<std::array<TopLink, 2>> inner;
    std::vector<uint32_t> leaf_first;
    TopLink root{};
};

/// Divides sorted codes from the root down. A node is a range of them, and what its codes have in common
/// above their highest differing bit is its cell of space [Lauterbach09].
class LinearBuilder {
  public:
    LinearBuilder(std::span<const CodedItem> order, size_t leaf_below, std::span<uint32_t> items)
        : order_(order), leaf_below_(leaf_below), items_(items) {}

    /// The nodes above subtrees, which are divided in parallel; then all in one, from left to right.
    void build(LinearTopology& result) {
        Subtree top{0, order_.size(), {}, {}};
        top.root = divide_into_subtrees(top, 0, order_.size());
        tbb::parallel_for(size_t{0}, subtrees_.size(), [&](size_t i) {
            Subtree& subtree = subtrees_[i];
            // Most leaves are half full.
            subtree.inner.reserve(2 * (subtree.last - subtree.first) / leaf_below_);
            subtree.leaf_first.reserve(subtree.inner.capacity());
            subtree.root = build(subtree, subtree.first, subtree.last);
        });
        join(top, result);
    }

  private:
    /// Leaf links of `top` are indices of subtrees.
    TopLink divide_into_subtrees(Subtree& top, size_t first, size_t last) {
        if (last - first <= kItemsOfSubtree) {
            subtrees_.push_back({first, last, {}, {}});
            return TopLink::leaf(static_cast<uint32_t>(subtrees_.size() - 1));
        }
        const size_t index = top.inner.size(), middle = divide(first, last);
        top.inner.emplace_back();
        const TopLink low = divide_into_subtrees(top, first, middle),
                      high = divide_into_subtrees(top, middle, last);
        top.inner[index] = {low, high};
        return TopLink::inner(static_cast<uint32_t>(index));
    }

    /// What is below a node of items [first, last); inner nodes in preorder.
    TopLink build(Subtree& tree, size_t first, size_t last) const {
        if (last - first < leaf_below_) {
            tree.leaf_first.push_back(static_cast<uint32_t>(first));
            set_items(first, last);
            return TopLink::leaf(static_cast<uint32_t>(tree.leaf_first.size() - 1));
        }
        const size_t index = tree.inner.size(), middle = divide(first, last);
        tree.inner.emplace_back();
        const TopLink low = build(tree, first, middle), high = build(tree, middle, last);
        tree.inner[index] = {low, high};
        return TopLink::inner(static_cast<uint32_t>(index));
    }

    /// The items of a leaf, in their own order: few enough to count for each those that come before it, which
    /// has no branches to foresee.
    void set_items(size_t first, size_t last) const {
        for (size_t i = first; i < last; ++i) {
            size_t place = first;
            for (size_t other = first; other < last; ++other) place += order_[other].item < order_[i].item;
            items_[place] = order_[i].item;
        }
    }

    /// The first item that has the highest bit in which the range's codes differ.
    size_t divide(size_t first, size_t last) const {
        const uint64_t differing = order_[first].code ^ order_[last - 1].code;
        if (differing == 0) return first + (last - first) / 2;
        const uint64_t bit = std::bit_floor(differing);
        // The first has it not, and the last has: halved without branches, which nobody could foresee.
        size_t before = first;
        for (size_t count = last - 1 - first; count > 1; count -= count / 2)
            before += order_[before + count / 2].code & bit ? 0 : count / 2;
        return before + 1;
    }

    /// Inner nodes of the top come first, then those of the subtrees in turn. Links within a subtree count
    /// from 0: they move on by what comes before it.
    void join(const Subtree& top, LinearTopology& result) const {
        std::vector<size_t> first_inner{top.inner.size()}, first_leaf{0};
        for (const Subtree& tree : subtrees_) {
            first_inner.push_back(first_inner.back() + tree.inner.size());
            first_leaf.push_back(first_leaf.back() + tree.leaf_first.size());
        }
        const auto moved = [&](const TopLink& link, size_t tree) {
            return link.is_leaf() ? TopLink::leaf(static_cast<uint32_t>(first_leaf[tree] + link.index()))
                                  : TopLink::inner(static_cast<uint32_t>(first_inner[tree] + link.index()));
        };
        const auto of_top = [&](const TopLink& link) {
            return link.is_leaf() ? moved(subtrees_[link.index()].root, link.index()) : link;
        };
        result.tree.root = of_top(top.root);
        result.tree.inner.resize(first_inner.back());
        result.leaf_first.resize(first_leaf.back());
        for (size_t i = 0; i < top.inner.size(); ++i)
            result.tree.inner[i] = {of_top(top.inner[i][0]), of_top(top.inner[i][1])};
        tbb::parallel_for(size_t{0}, subtrees_.size(), [&](size_t t) {
            const Subtree& tree = subtrees_[t];
            for (size_t i = 0; i < tree.inner.size(); ++i)
                result.tree.inner[first_inner[t] + i] = {moved(tree.inner[i][0], t),
                                                         moved(tree.inner[i][1], t)};
            std::ranges::copy(tree.leaf_first,
                              result.leaf_first.begin() + static_cast<std::ptrdiff_t>(first_leaf[t]));
        });
    }

    std::span<const CodedItem> order_;
    size_t leaf_below_;
    std::span<uint32_t> items_;
    std::vector<Subtree> subtrees_;
};

}  // namespace

LinearTopology build_linear_topology(std::span<const V3f> centroids, const Box3f& box, size_t leaf_below,
                                     std::span<const uint32_t> names) {
    LinearTopology result;
    if (!centroids.empty()) {
        UnsetVector<CodedItem> order(centroids.size());
        tbb::parallel_for(tbb::blocked_range<size_t>(0, centroids.size()), [&](const auto& range) {
            for (size_t i = range.begin(); i < range.end(); ++i)
                order[i] = {morton_code(centroids[i], box),
                            names.empty() ? static_cast<uint32_t>(i) : names[i]};
        });
        sort_by_code(order, 3 * kMortonBits);
        result.items.resize(centroids.size());
        LinearBuilder(order, leaf_below, result.items).build(result);
    }
    result.leaf_first.push_back(static_cast<uint32_t>(centroids.size()));
    return result;
}

}  // namespace trapeze
