#include "accel/wide/wide_top.h"

#include <tbb/parallel_invoke.h>

#include <algorithm>
#include <array>
#include <limits>
#include <utility>

namespace trapeze {
namespace {

/// Bins along each axis, hence 15 planes to split at.
constexpr int kTopBins = 16;
constexpr size_t kTaskFrom = 512;  ///< grids below which a subtree is one task
/// The depth from which on subtrees are halved without looking: the depth of the tree stays bounded.
constexpr int kSahDepthLimit = 60;
constexpr float kEndless = std::numeric_limits<float>::infinity();

struct Box {
    float low[3] = {kEndless, kEndless, kEndless}, high[3] = {-kEndless, -kEndless, -kEndless};

    void add(const Box& o) {
        for (int k = 0; k < 3; ++k)
            low[k] = std::min(low[k], o.low[k]), high[k] = std::max(high[k], o.high[k]);
    }
    float half_area() const {
        const float x = high[0] - low[0], y = high[1] - low[1], z = high[2] - low[2];
        return x < 0 ? 0.0f : x * y + y * z + z * x;
    }
};

/// A grid at mid-shutter, as splits see it. Every grid weighs the same.
struct Item {
    Box box;
    uint32_t grid;

    /// Twice the centroid.
    float place(int axis) const { return box.low[axis] + box.high[axis]; }
};

/// A node of the binary tree that is built first and then collapsed.
struct BinaryNode {
    EndBoxes box;
    uint32_t child[2];  ///< links
    uint32_t count;     ///< grids below
};

/// The box about two, at both ends of the shutter.
EndBoxes both(const EndBoxes& a, const EndBoxes& b) {
    EndBoxes out;
    for (int end = 0; end < 2; ++end)
        for (int k = 0; k < 3; ++k) {
            out.at[end].low[k] = std::min(a.at[end].low[k], b.at[end].low[k]);
            out.at[end].high[k] = std::max(a.at[end].high[k], b.at[end].high[k]);
        }
    return out;
}

/// The rule that gives a grid its bin along one axis: kTopBins equal parts from `from` on (twice a
/// coordinate).
struct TopBinning {
    int axis = 0;
    float from = 0, scale = 0;

    int of(const Item& item) const {
        const float at = (item.place(axis) - from) * scale;
        return at > 0 ? static_cast<int>(std::min(at, kTopBins - 1.0f)) : 0;
    }
};

/// The cheapest split found so far; infinite: none.
struct TopSplit {
    float cost = kEndless;
    TopBinning binning;
    int bin = 0;  ///< the first bin of the upper side
};

/// Builds a binary tree top down, halves as parallel tasks, then collapses it.
class TopBuilder {
  public:
    TopBuilder(std::span<const GridExtent> extents, std::span<const uint32_t> grids) : extents_(extents) {
        items_.reserve(grids.size());
        for (const uint32_t grid : grids) {
            const EndBoxes& e = extents[grid].box;
            Item item{{}, grid};
            // At mid-shutter, since boxes are linear from open to close.
            for (int k = 0; k < 3; ++k) {
                item.box.low[k] = 0.5f * (e.at[0].low[k] + e.at[1].low[k]);
                item.box.high[k] = 0.5f * (e.at[0].high[k] + e.at[1].high[k]);
            }
            items_.push_back(item);
        }
        nodes_.resize(grids.size() - 1);
    }

    std::vector<WideChildren> build() {
        const uint32_t root = binary(items_, 0, 0);
        std::vector<WideChildren> wide;
        wide.reserve(items_.size() / 6 + 4);
        collapse(root, wide);
        return wide;
    }

  private:
    const EndBoxes& box_of(uint32_t link) const {
        return link & kGridLink ? extents_[link & ~kGridLink].box : nodes_[link].box;
    }

    /// Builds the binary tree of some grids and gives its link; a subtree of n grids has n - 1 nodes,
    /// numbered from `first`: places are known before subtrees are built, whoever builds first.
    uint32_t binary(std::span<Item> part, uint32_t first, int depth) {
        if (part.size() == 1) return part[0].grid | kGridLink;
        const size_t middle = part_in_two(part, depth);
        const auto low = part.first(middle), high = part.subspan(middle);
        const auto high_first = first + static_cast<uint32_t>(middle);
        BinaryNode& node = nodes_[first];
        if (part.size() < kTaskFrom) {
            node.child[0] = binary(low, first + 1, depth + 1);
            node.child[1] = binary(high, high_first, depth + 1);
        } else {
            tbb::parallel_invoke([&] { node.child[0] = binary(low, first + 1, depth + 1); },
                                 [&] { node.child[1] = binary(high, high_first, depth + 1); });
        }
        node.box = both(box_of(node.child[0]), box_of(node.child[1]));
        node.count = static_cast<uint32_t>(part.size());
        return first;
    }

    /// Parts grids by the best split, moved to where nodes are full: moves the lower part to the front and
    /// tells its size, which is neither 0 nor all.
    static size_t part_in_two(std::span<Item> part, int depth) {
        const TopSplit split = depth < kSahDepthLimit ? best_split(part) : TopSplit{};
        if (split.cost == kEndless) return filling(part.size(), part.size() / 2);
        const auto middle = std::partition(
            part.begin(), part.end(), [&](const Item& item) { return split.binning.of(item) < split.bin; });
        const auto filled = part.begin() + static_cast<std::ptrdiff_t>(filling(
                                               part.size(), static_cast<size_t>(middle - part.begin())));
        const auto before = [axis = split.binning.axis](const Item& a, const Item& b) {
            return std::pair(a.place(axis), a.grid) < std::pair(b.place(axis), b.grid);
        };
        // Grids between the split and the full place change sides: those nearest to the other side.
        if (filled < middle) std::nth_element(part.begin(), filled, middle, before);
        if (filled > middle) std::nth_element(middle, filled, part.end(), before);
        return static_cast<size_t>(filled - part.begin());
    }

    /// The place nearest to a split of `size` grids that leaves one side with full nodes alone: the nodes
    /// above small grids take as much memory as the grids.
    static size_t filling(size_t size, size_t middle) {
        constexpr size_t kFull = WideNode::kChildren;
        if (size <= kFull) return middle;
        const auto nearest = [=](size_t side) {
            return std::clamp((side + kFull / 2) / kFull * kFull, kFull, (size - 1) / kFull * kFull);
        };
        const auto away = [middle](size_t at) { return at > middle ? at - middle : middle - at; };
        const size_t low = nearest(middle), high = size - nearest(size - middle);
        return away(low) <= away(high) ? low : high;
    }

    /// The cheapest plane between bins of any axis; cost infinite where all centroids coincide.
    static TopSplit best_split(std::span<const Item> part) {
        float from[3] = {kEndless, kEndless, kEndless}, to[3] = {-kEndless, -kEndless, -kEndless};
        for (const Item& item : part)
            for (int k = 0; k < 3; ++k)
                from[k] = std::min(from[k], item.place(k)), to[k] = std::max(to[k], item.place(k));
        TopSplit best;
        for (int axis = 0; axis < 3; ++axis)
            if (to[axis] > from[axis])
                consider(part, {axis, from[axis], kTopBins / (to[axis] - from[axis])}, best);
        return best;
    }

    /// Tries all planes along one axis, in two sweeps over the bins.
    static void consider(std::span<const Item> part, const TopBinning& binning, TopSplit& best) {
        std::array<Box, kTopBins> bins;
        std::array<uint32_t, kTopBins> counts{};
        for (const Item& item : part) {
            const int bin = binning.of(item);
            bins[bin].add(item.box);
            ++counts[bin];
        }
        std::array<float, kTopBins> cost_above{};  // of bins [b, kTopBins)
        Box above, below;
        uint32_t count = 0;
        for (int b = kTopBins - 1; b > 0; --b) {
            above.add(bins[b]);
            count += counts[b];
            cost_above[b] = above.half_area() * static_cast<float>(count);
        }
        count = 0;
        for (int b = 1; b < kTopBins; ++b) {
            below.add(bins[b - 1]);
            count += counts[b - 1];
            if (count == 0 || count == part.size()) continue;
            const float cost = below.half_area() * static_cast<float>(count) + cost_above[b];
            if (cost < best.cost) best = {cost, binning, b};
        }
    }

    uint32_t count_of(uint32_t link) const { return link & kGridLink ? 1 : nodes_[link].count; }

    /// The most grids below a child that let a tree of `count` grids have the fewest levels.
    static uint32_t capacity(uint32_t count) {
        uint32_t below = 1;
        while (below * WideNode::kChildren < count) below *= WideNode::kChildren;
        return below;
    }

    /// Opens the fullest children until none holds more than it should or there are 16, so that nodes are
    /// well filled: their memory counts where grids are small. The number of the node that this makes.
    uint32_t collapse(uint32_t link, std::vector<WideChildren>& wide) const {
        const auto number = static_cast<uint32_t>(wide.size());
        wide.emplace_back();
        std::array<uint32_t, WideNode::kChildren> links{link};
        int count = 1;
        const uint32_t most = capacity(count_of(link));
        while (count < WideNode::kChildren) {
            const auto fullest =
                std::max_element(links.begin(), links.begin() + count,
                                 [this](uint32_t a, uint32_t b) { return count_of(a) < count_of(b); });
            if (count_of(*fullest) <= most) break;
            const BinaryNode& opened = nodes_[*fullest];
            *fullest = opened.child[0];
            links[count++] = opened.child[1];
        }
        for (int i = 0; i < count; ++i) {
            const uint32_t below = links[i] & kGridLink ? links[i] : collapse(links[i], wide);
            wide[number].child[i] = {box_of(links[i]), below};
        }
        wide[number].count = count;
        return number;
    }

    std::span<const GridExtent> extents_;
    std::vector<Item> items_;
    std::vector<BinaryNode> nodes_;
};

}  // namespace

std::vector<WideChildren> build_wide_top(std::span<const GridExtent> extents,
                                         std::span<const uint32_t> grids) {
    return TopBuilder(extents, grids).build();
}

}  // namespace trapeze
