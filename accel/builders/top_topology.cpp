#include "accel/builders/top_topology.h"

#include "accel/builders/morton_order.h"

namespace trapeze {

TopTopology build_top_topology(std::span<const GridSummary> grids, bool orient_split) {
    std::vector<SahItem> items;
    items.reserve(grids.size());
    for (const GridSummary& grid : grids)
        items.push_back({grid.box, grid.weight, static_cast<uint32_t>(items.size())});

    SahOptions options;
    options.split_anyway = !orient_split;
    // Parts for which no split is found are ordered by codes of place and direction. With one direction for
    // all, that is an order of space alone.
    options.fallback_order = [&](std::span<SahItem> part) {
        sort_by_orientation(
            part, [&](uint32_t grid) { return orient_split ? grids[grid].main_direction : V3f(0, 0, 1); });
    };
    TopTopology topology = build_sah_topology(items, options).tree;
    // Leaves hold one grid each: their number gives way to the grid's.
    const auto name_by_grid = [&](TopLink& link) {
        if (link.is_leaf()) link = TopLink::leaf(items[link.index()].id);
    };
    for (auto& children : topology.inner)
        for (TopLink& child : children) name_by_grid(child);
    if (!items.empty()) name_by_grid(topology.root);
    return topology;
}

}  // namespace trapeze
