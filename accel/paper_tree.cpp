#include "accel/paper_tree.h"

#include <tbb/parallel_for.h>
#include <tbb/parallel_invoke.h>

#include <algorithm>

namespace trapeze {
namespace {

constexpr int kParallelDepth = 7;  ///< levels whose subtrees are bounded in parallel

/// The bound of two, in the orientation of that one which makes it smaller; the first one's of equals.
HyperTrapezoid smaller_union(const HyperTrapezoid& a, const HyperTrapezoid& b) {
    HyperTrapezoid in_a = a, in_b = b;
    in_a.merge(b);
    in_b.merge(a);
    return in_b.expected_half_area() < in_a.expected_half_area() ? in_b : in_a;
}

}  // namespace

std::vector<GridSummary> PaperTree::summaries_of(const Grids& grids) {
    std::vector<GridSummary> summaries(grids.grids.size());
    tbb::parallel_for(size_t{0}, summaries.size(),
                      [&](size_t i) { summaries[i] = summarise(grids.grids[i]); });
    return summaries;
}

PaperTree::PaperTree(const Grids& grids, const std::vector<GridSummary>& summaries)
    : grids_(grids), in_grid_(grids.grids, summaries, grid_bounds_) {
    const size_t count = grids.grids.size();
    top_.key_count = grids.max_key_count();
    if (count > 0) {
        top_.nodes.resize(2 * count - 1);
        top_.boxes.resize(top_.nodes.size() * top_.key_count);
        const TopTopology topology = build_top_topology(summaries);
        set_node(top_.nodes.size() - 1, topology.root, build_bounds(topology, summaries, topology.root, 0));
    }
    grid_bounds_ = {};
    stats_.tree_bytes = sizeof(*this) + in_grid_.bytes() + top_.bytes();
    stats_.tree_nodes = top_.nodes.size() + 2 * in_grid_.inner_nodes();
    stats_.tree_leaves = count + in_grid_.inner_nodes();  // a binary tree has a leaf more than inner nodes
}

PaperTree::NodeBound PaperTree::build_bounds(const TopTopology& topology,
                                             const std::vector<GridSummary>& summaries, TopLink link,
                                             int depth) {
    if (link.is_leaf()) {
        const GridSummary& grid = summaries[link.index()];
        const HyperTrapezoid& bound = grid_bounds_[link.index()];
        return {bound.in(bound.frame, top_.key_count), grid.absolute_max, grid.quad_extent};
    }
    NodeBound child[2];
    const auto build = [&](int side) {
        const TopLink below = topology.inner[link.index()][side];
        child[side] = build_bounds(topology, summaries, below, depth + 1);
        set_node(2 * size_t{link.index()} + side, below, child[side]);
    };
    if (depth < kParallelDepth)
        tbb::parallel_invoke([&] { build(0); }, [&] { build(1); });
    else
        build(0), build(1);
    return {smaller_union(child[0].box, child[1].box), std::max(child[0].absolute_max, child[1].absolute_max),
            std::max(child[0].quad_extent, child[1].quad_extent)};
}

void PaperTree::set_node(size_t index, TopLink link, const NodeBound& bound) {
    top_.nodes[index] = {FrameColumns(bound.box.frame), bound.absolute_max, bound.quad_extent, link};
    for (int key = 0; key < top_.key_count; ++key) {
        KeyBox& box = top_.boxes[index * top_.key_count + key];
        for (int k = 0; k < 3; ++k) {
            box.low[k] = bound.box.keys[key].min[k];
            box.high[k] = bound.box.keys[key].max[k];
        }
    }
}

std::optional<Hit> PaperTree::closest(const SpaceRay& ray, DepthRange range) const {
    TraceRay trace_ray = TraceRay::turned(axis_ray(ray), range);
    ClosestHit policy;
    SampleStats stats;
    trace(trace_ray, policy, stats);
    if (!policy.found()) return {};
    return policy.best;
}

bool PaperTree::any(const SpaceRay& ray, DepthRange range) const {
    TraceRay trace_ray = TraceRay::turned(axis_ray(ray), range);
    AnyHit policy;
    SampleStats stats;
    trace(trace_ray, policy, stats);
    return policy.found;
}

}  // namespace trapeze
