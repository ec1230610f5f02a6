#include "accel/builders/top_bounds.h"

#include <tbb/parallel_invoke.h>

#include <algorithm>

namespace trapeze {
namespace {

constexpr int kParallelDepth = 7;  ///< levels whose subtrees are bounded in parallel

/// The bound of two in a given orientation.
HyperTrapezoid union_in(const Frame& frame, const HyperTrapezoid& a, const HyperTrapezoid& b) {
    HyperTrapezoid both = a.in(frame, a.key_count());
    both.merge(b);
    return both;
}

/// The bound of two, in the orientation of that one which makes it smaller; the first one's of equals.
HyperTrapezoid smaller_union(const HyperTrapezoid& a, const HyperTrapezoid& b) {
    HyperTrapezoid in_a = union_in(a.frame, a, b);
    if (a.frame == b.frame) return in_a;
    HyperTrapezoid in_b = union_in(b.frame, b, a);
    return in_b.expected_half_area() < in_a.expected_half_area() ? in_b : in_a;
}

class Bounding {
  public:
    Bounding(const TopTopology& topology, const PaperTreeOptions& options,
             const std::function<NodeBound(uint32_t)>& bound_of, TopLevel& top)
        : topology_(topology), options_(options), bound_of_(bound_of), top_(top) {}

    NodeBound bound(TopLink link, int depth) const {
        if (link.is_leaf()) {
            NodeBound leaf = bound_of_(link.index());
            leaf.box = leaf.box.in(leaf.box.frame, top_.key_count);
            return leaf;
        }
        NodeBound child[2];
        const auto build = [&](int side) {
            const TopLink below = topology_.inner[link.index()][side];
            child[side] = bound(below, depth + 1);
            set_node(2 * size_t{link.index()} + side, below, child[side]);
        };
        if (depth < kParallelDepth)
            tbb::parallel_invoke([&] { build(0); }, [&] { build(1); });
        else
            build(0), build(1);
        return {options_.orient_propagation ? smaller_union(child[0].box, child[1].box)
                                            : union_in(Frame{}, child[0].box, child[1].box),
                std::max(child[0].absolute_max, child[1].absolute_max),
                std::max(child[0].quad_extent, child[1].quad_extent)};
    }

    void set_node(size_t index, TopLink link, const NodeBound& bound) const {
        top_.nodes[index] = {bound.absolute_max, bound.quad_extent, link};
        if (top_.oriented) top_.frames[index] = FrameColumns(bound.box.frame);
        for (int key = 0; key < top_.key_count; ++key) {
            KeyBox& box = top_.boxes[index * top_.key_count + key];
            for (int k = 0; k < 3; ++k) {
                box.low[k] = bound.box.keys[key].min[k];
                box.high[k] = bound.box.keys[key].max[k];
            }
        }
    }

  private:
    const TopTopology& topology_;
    const PaperTreeOptions& options_;
    const std::function<NodeBound(uint32_t)>& bound_of_;
    TopLevel& top_;
};

}  // namespace

TopLevel bound_top_level(const TopTopology& topology, size_t leaf_count, int key_count,
                         const PaperTreeOptions& options,
                         const std::function<NodeBound(uint32_t leaf)>& bound_of) {
    TopLevel top;
    top.key_count = options.bounds == PaperTreeOptions::Bounds::WholeMotion ? 1 : key_count;
    top.oriented = options.oriented();
    if (leaf_count == 0) return top;
    top.nodes.resize(2 * leaf_count - 1);
    if (top.oriented) top.frames.resize(top.nodes.size());
    top.boxes.resize(top.nodes.size() * top.key_count);
    const Bounding bounding(topology, options, bound_of, top);
    bounding.set_node(top.nodes.size() - 1, topology.root, bounding.bound(topology.root, 0));
    return top;
}

}  // namespace trapeze
