#include "accel/paper/paper_tree.h"

#include "accel/builders/top_topology.h"
#include "accel/paper/top_bounds.h"

namespace trapeze {
namespace {

/// Nodes of up to this many grids are bounded from the vertices. 32 saves a further hundredth of the nodes
/// visited, for a third more time to build.
constexpr size_t kTightUpTo = 8;

}  // namespace

PaperTree::PaperTree(const Grids& grids, const PaperTreeOptions& options,
                     const std::vector<GridSummary>& summaries)
    : grids_(grids), in_grid_(grids.grids, summaries, options, grid_bounds_) {
    const size_t count = grids.grids.size();
    // A leaf of the top level is a grid: its own bound was made with its tree, others are made from its
    // vertices.
    const LeafBounds bounds{
        [&](uint32_t grid) {
            return NodeBound{grid_bounds_[grid], summaries[grid].absolute_max, summaries[grid].quad_extent};
        },
        [&](uint32_t grid, const Axes& axes) {
            return bound_in_axes(grids.grids[grid], summaries[grid].absolute_max, axes);
        },
        kTightUpTo};
    top_ = bound_top_level(build_top_topology(summaries, options.orient_split), count, grids.max_key_count(),
                           options, bounds);
    grid_bounds_ = {};
    stats_.tree_bytes = sizeof(*this) + in_grid_.bytes() + top_.bytes();
    stats_.tree_nodes = top_.nodes.size() + 2 * in_grid_.inner_nodes();
    stats_.tree_leaves = count + in_grid_.inner_nodes();  // a binary tree has a leaf more than inner nodes
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
