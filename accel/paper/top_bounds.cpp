#include "accel/paper/top_bounds.h"

#include <tbb/parallel_invoke.h>

#include <algorithm>
#include <span>
#include <utility>

namespace trapeze {
namespace {

constexpr int kParallelDepth = 7;  ///< levels whose subtrees are bounded in parallel

/// Nodes of up to this many leaves are bounded from the leaves' bounds, turned once; larger ones from their
/// children's: beside their size, what a turned box grows by is little.
constexpr size_t kFromLeavesUpTo = 1024;

/// The pass itself. Bounds of leaves are kept from left to right, so that a node's leaves are a range of
/// them.
class Bounding {
  public:
    Bounding(const TopTopology& topology, const PaperTreeOptions& options, const LeafBounds& leaf_bounds,
             TopLevel& top)
        : topology_(topology),
          options_(options),
          leaf_bounds_(leaf_bounds),
          top_(top),
          leaves_(topology.inner.size() + 1),
          axes_sets_(top.oriented ? leaves_.size() + 1 : 0) {
        if (top.oriented) axes_sets_.back() = AxesColumns(Axes{});
    }
    /// Of leaves from left to right, and the axes of space.
    std::vector<AxesColumns> axes_sets() && { return std::move(axes_sets_); }

    /// The subtree below a link, with its leaves counted from left to right. Inner nodes are in preorder, so
    /// that a subtree's are those from its root's on; it has a leaf more than inner nodes.
    struct Part {
        TopLink link;
        size_t first_leaf, leaf_count;
    };
    Part all() const { return {topology_.root, 0, leaves_.size()}; }

    /// Bounds a subtree, writes the nodes below its root, and gives the bound of the root itself, which its
    /// parent (or bound_top_level()) writes: a node is stored as its parent sees it.
    NodeBound bound(const Part& part, int depth) {
        if (part.link.is_leaf()) {
            NodeBound leaf = leaf_bounds_.own(part.link.index());
            // The top level has as many keys as any grid: a leaf of fewer gets boxes in between.
            leaf.box = leaf.box.in(leaf.box.axes, top_.key_count);
            leaves_[part.first_leaf] = {part.link.index(), leaf.box};
            leaf.axes = static_cast<uint32_t>(part.first_leaf);
            return leaf;
        }
        NodeBound child[2];
        const auto build = [&](int side) {
            const Part below = child_of(part, side);
            child[side] = bound(below, depth + 1);
            set_node(2 * size_t{part.link.index()} + side, below.link, child[side]);
        };
        if (depth < kParallelDepth)
            tbb::parallel_invoke([&] { build(0); }, [&] { build(1); });
        else
            build(0), build(1);
        HyperTrapezoid box = union_of(part, child[0].box, child[1].box);
        const uint32_t axes = box.axes == child[0].box.axes   ? child[0].axes
                              : box.axes == child[1].box.axes ? child[1].axes
                                                              : static_cast<uint32_t>(leaves_.size());
        return {std::move(box), std::max(child[0].absolute_max, child[1].absolute_max),
                std::max(child[0].quad_extent, child[1].quad_extent), axes};
    }

    /// Stores a bound as node `index` of the tree: one KeyBox a key, side by side. Subtrees write apart from
    /// each other, so that parallel tasks may call it.
    void set_node(size_t index, TopLink link, const NodeBound& bound) {
        top_.nodes[index] = {bound.absolute_max, bound.quad_extent, link, bound.axes};
        if (top_.oriented && link.is_leaf()) axes_sets_[bound.axes] = AxesColumns(bound.box.axes);
        for (int key = 0; key < top_.key_count; ++key) {
            KeyBox& box = top_.boxes[index * top_.key_count + key] = KeyBox();
            for (int k = 0; k < 3; ++k) {
                box.low[k] = bound.box.keys[key].min[k];
                box.high[k] = bound.box.keys[key].max[k];
            }
        }
    }

  private:
    /// One side of an inner node; how many leaves are below it follows from the numbers of the nodes.
    Part child_of(const Part& part, int side) const {
        const auto& [low, high] = topology_.inner[part.link.index()];
        size_t low_leaves = part.leaf_count - 1;  // when the high one is a leaf
        if (!high.is_leaf()) low_leaves = high.index() - part.link.index();
        if (side == 0) return {low, part.first_leaf, low_leaves};
        return {high, part.first_leaf + low_leaves, part.leaf_count - low_leaves};
    }

    /// The bound of two children together: axis-aligned without propagation, else in the orientation of that
    /// child which makes it smaller, the first one's of equals.
    HyperTrapezoid union_of(const Part& part, const HyperTrapezoid& a, const HyperTrapezoid& b) const {
        if (!options_.orient_propagation) return union_in(Axes{}, part, a, b);
        HyperTrapezoid in_a = union_in(a.axes, part, a, b);
        if (a.axes == b.axes) return in_a;
        HyperTrapezoid in_b = union_in(b.axes, part, a, b);
        return in_b.expected_half_area() < in_a.expected_half_area() ? in_b : in_a;
    }
    /// That bound in given axes: from the children where they have it (or are large), else from the leaves
    /// or what is in them, each turned once [decision 0008].
    HyperTrapezoid union_in(const Axes& axes, const Part& part, const HyperTrapezoid& a,
                            const HyperTrapezoid& b) const {
        HyperTrapezoid both{axes, std::vector<Box3f>(static_cast<size_t>(top_.key_count))};
        if (options_.bounds_from_children || part.leaf_count > kFromLeavesUpTo ||
            (a.axes == axes && b.axes == axes)) {
            both.merge(a);
            both.merge(b);
            return both;
        }
        const bool from_contents = part.leaf_count <= leaf_bounds_.in_up_to;
        for (const Leaf& leaf : std::span(leaves_).subspan(part.first_leaf, part.leaf_count))
            both.merge(from_contents && !(leaf.box.axes == axes) ? leaf_bounds_.in(leaf.index, axes)
                                                                 : leaf.box);
        return both;
    }

    /// What LeafBounds::own() gave, at as many keys as the tree has: nodes above read it again for all axes
    /// that they try.
    struct Leaf {
        uint32_t index = 0;
        HyperTrapezoid box;
    };

    const TopTopology& topology_;
    const PaperTreeOptions& options_;
    const LeafBounds& leaf_bounds_;
    TopLevel& top_;
    std::vector<Leaf> leaves_;
    std::vector<AxesColumns> axes_sets_;
};

}  // namespace

TopLevel bound_top_level(const TopTopology& topology, size_t leaf_count, int key_count,
                         const PaperTreeOptions& options, const LeafBounds& leaves) {
    TopLevel top;
    top.key_count = options.bounds == PaperTreeOptions::Bounds::WholeMotion ? 1 : key_count;
    top.oriented = options.oriented();
    if (leaf_count == 0) return top;
    top.nodes.resize(2 * leaf_count - 1);
    top.boxes.resize(top.nodes.size() * top.key_count);
    Bounding bounding(topology, options, leaves, top);
    bounding.set_node(top.nodes.size() - 1, topology.root, bounding.bound(bounding.all(), 0));
    if (top.oriented)
        top.axes_sets = std::make_shared<const std::vector<AxesColumns>>(std::move(bounding).axes_sets());
    top.keeps_turned_rays = top.oriented && options.keep_turned_rays;
    return top;
}

}  // namespace trapeze
