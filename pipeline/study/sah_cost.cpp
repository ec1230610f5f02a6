#include "pipeline/study/sah_cost.h"

#include "accel/builders/grid_summary.h"
#include "accel/builders/micropolygon_boxes.h"
#include "accel/paper/in_grid_trees.h"

namespace trapeze {
namespace {

/// A subtree's box, and the sum over its nodes of area times cost.
struct Subtree {
    Box3f box;
    double cost = 0;

    static Subtree leaf(const Box3f& box, int count) { return {box, half_area(box) * count}; }
    static Subtree join(const Subtree& a, const Subtree& b) {
        Box3f box = a.box;
        box.extendBy(b.box);
        return {box, half_area(box) * kTraversalCost + a.cost + b.cost};
    }
    /// The cost for a random line that meets the box: the chance to meet a node is its area over the box's.
    double relative() const {
        const double area = half_area(box);
        return area > 0 ? cost / area : 0;
    }
};

/// The cost of a block's tree by midpoint splits. `items`: the grid's micropolygons row by row, nu a row.
Subtree parametric_tree(const std::vector<SahItem>& items, int nu, const ParametricSplits& splits,
                        const GridBlock& block) {
    if (!splits.is_leaf(block)) {
        const BlockHalves parts = halves(block);
        return Subtree::join(parametric_tree(items, nu, splits, parts.low),
                             parametric_tree(items, nu, splits, parts.high));
    }
    Box3f box;
    for (int v = block.v; v < block.v + block.nv; ++v)
        for (int u = block.u; u < block.u + block.nu; ++u) box.extendBy(items[v * nu + u].box);
    return Subtree::leaf(box, block.count());
}

/// The cost of a tree that the SAH built; `items` are in the order of its leaves.
Subtree greedy_tree(const std::vector<SahItem>& items, const SahTopology& topology, TopLink link) {
    if (!link.is_leaf()) {
        const auto& [low, high] = topology.tree.inner[link.index()];
        return Subtree::join(greedy_tree(items, topology, low), greedy_tree(items, topology, high));
    }
    const uint32_t first = topology.leaf_first[link.index()], last = topology.leaf_first[link.index() + 1];
    Box3f box;
    for (uint32_t i = first; i < last; ++i) box.extendBy(items[i].box);
    return Subtree::leaf(box, static_cast<int>(last - first));
}

}  // namespace

SahCosts sah_costs(const Grid& grid, int leaf_below) {
    std::vector<SahItem> items(static_cast<size_t>(grid.shape.micropolygon_count()));
    boxes_of_grid(grid, summarise(grid).axes, 0.5f, 0, items.data());
    const double parametric = parametric_tree(items, grid.shape.nu, ParametricSplits(leaf_below),
                                              {0, 0, grid.shape.nu, grid.shape.nv})
                                  .relative();
    SahOptions options;
    options.leaf_below = static_cast<size_t>(leaf_below);
    options.sweep_up_to = SahOptions::kMostSwept;
    options.split_anyway = true;
    options.fallback_order = [](std::span<SahItem>) {};  // where all is at one place any order will do
    const SahTopology topology = build_sah_topology(items, options);
    return {parametric, greedy_tree(items, topology, topology.tree.root).relative()};
}

}  // namespace trapeze
