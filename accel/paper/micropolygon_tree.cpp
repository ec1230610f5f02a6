#include "accel/paper/micropolygon_tree.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "accel/builders/micropolygon_boxes.h"
#include "accel/builders/morton_order.h"

namespace trapeze {
namespace {

/// Parts of up to this many micropolygons are split at the best of all places, larger ones at the best plane
/// of a few.
constexpr size_t kSweepUpTo = 64;

/// Nodes of up to this many leaves are bounded from the vertices. With 8, rays visit twice the nodes where
/// things fly past each other.
constexpr size_t kBoundFromVerticesUpTo = 32;

/// Bound in some axes of some micropolygons of one grid, from their vertices: a box at each of the grid's
/// keys, or one box for all times.
HyperTrapezoid bound_in(const Axes& axes, const Grid& grid, std::span<const MicropolygonId> part,
                        float absolute_max, bool whole_motion) {
    HyperTrapezoid bound{axes, {}};
    if (!std::isfinite(absolute_max)) {  // its rounding makes it infinite
        bound.keys = {Box3f(V3f(0), V3f(0))};
        return bound;
    }
    for (int key = 0; key < grid.key_count; ++key) {
        Box3f box;
        for (const MicropolygonId& id : part)
            for (int corner = 0; corner < 4; ++corner)
                box.extendBy(
                    axes.from_space(vertex_of_key(grid, key, id.u + (corner & 1), id.v + (corner >> 1))));
        box = grown_for_axes(box, absolute_max);
        if (whole_motion && key > 0)
            bound.keys[0].extendBy(box);
        else
            bound.keys.push_back(box);
    }
    return bound;
}

/// Calls of_grid(span) for each run of micropolygons of one grid in a list sorted by grid.
template <class OfGrid>
void for_each_grid(std::span<const MicropolygonId> list, OfGrid&& of_grid) {
    for (size_t first = 0, last; first < list.size(); first = last) {
        last = first + 1;
        while (last < list.size() && list[last].grid == list[first].grid) ++last;
        of_grid(list.subspan(first, last - first));
    }
}

/// The orientation of some micropolygons, from their averaged edges at mid-shutter as for a grid.
Axes axes_of_micropolygons(const Grids& grids, std::span<const MicropolygonId> list) {
    V3d along_u(0), along_v(0);
    for (const MicropolygonId& id : list) {
        const Grid& grid = grids.grids[id.grid];
        V3d corner[4];
        for (int c = 0; c < 4; ++c) corner[c] = V3d(grid.vertex(id.u + (c & 1), id.v + (c >> 1), 0.5f));
        along_u += (corner[1] - corner[0]) + (corner[3] - corner[2]);
        along_v += (corner[2] - corner[0]) + (corner[3] - corner[1]);
    }
    return axes_of(along_u, along_v);
}

}  // namespace

MicropolygonTree::MicropolygonTree(const Grids& grids, const PaperTreeOptions& options) : ListTree(grids) {
    const std::vector<GridSummary> summaries = oriented_summaries(grids, options);
    build_topology(summaries, options);
}

void MicropolygonTree::build_topology(const std::vector<GridSummary>& summaries,
                                      const PaperTreeOptions& options) {
    UnsetVector<MicropolygonId> ids;
    UnsetVector<SahItem> items;
    micropolygon_items(*grids_, summaries, ids, items);

    SahOptions sah;
    sah.leaf_below = static_cast<size_t>(options.leaf);
    sah.sweep_up_to = kSweepUpTo;
    sah.split_anyway = !options.orient_split;
    sah.fallback_order = [&](std::span<SahItem> part) {
        sort_by_orientation(part, [&](uint32_t id) {
            return options.orient_split ? summaries[ids[id].grid].main_direction : V3f(0, 0, 1);
        });
    };
    // From here on leaves are ranges of micropolygons_, in the order that the SAH gave the items.
    SahTopology topology = build_sah_topology(items, sah);
    leaf_first_ = std::move(topology.leaf_first);
    micropolygons_.resize(items.size());
    tbb::parallel_for(size_t{0}, items.size(), [&](size_t i) { micropolygons_[i] = ids[items[i].id]; });
    // In a leaf by id: those of one grid come together, as bounding them wants.
    tbb::parallel_for(size_t{0}, leaf_count(), [&](size_t i) {
        std::sort(micropolygons_.begin() + leaf_first_[i], micropolygons_.begin() + leaf_first_[i + 1],
                  [](const MicropolygonId& a, const MicropolygonId& b) { return a.packed() < b.packed(); });
    });

    const LeafBounds bounds{
        [&](uint32_t index) { return leaf_bound(index, summaries, options); },
        [&](uint32_t index, const Axes& axes) { return leaf_bound_in(axes, index, summaries, options); },
        kBoundFromVerticesUpTo};
    top_ = bound_top_level(topology.tree, leaf_count(), grids_->max_key_count(), options, bounds);
    count_built(sizeof(*this));
}

HyperTrapezoid MicropolygonTree::leaf_bound_in(const Axes& axes, uint32_t index,
                                               const std::vector<GridSummary>& summaries,
                                               const PaperTreeOptions& options) const {
    const bool whole_motion = options.bounds == PaperTreeOptions::Bounds::WholeMotion;
    HyperTrapezoid all{axes, {}};
    for_each_grid(leaf(index), [&](std::span<const MicropolygonId> part) {
        const uint32_t grid = part[0].grid;
        const HyperTrapezoid bound =
            bound_in(axes, grids_->grids[grid], part, summaries[grid].absolute_max, whole_motion);
        if (all.keys.empty())
            all = bound;
        else
            all.merge(bound);
    });
    return all;
}

NodeBound MicropolygonTree::leaf_bound(uint32_t index, const std::vector<GridSummary>& summaries,
                                       const PaperTreeOptions& options) const {
    const std::span<const MicropolygonId> list = leaf(index);
    NodeBound smallest;
    double least_area = std::numeric_limits<double>::infinity();
    // Candidates for the leaf's orientation: the axes of its grids, then those of its own edges.
    const auto consider = [&](const Axes& axes) {
        HyperTrapezoid bound = leaf_bound_in(axes, index, summaries, options);
        const double area = bound.expected_half_area();
        if (smallest.box.keys.empty() || area < least_area)
            smallest.box = std::move(bound), least_area = area;
    };
    for_each_grid(list, [&](std::span<const MicropolygonId> part) {
        const GridSummary& grid = summaries[part[0].grid];
        if (smallest.box.keys.empty() || !(grid.axes == smallest.box.axes)) consider(grid.axes);
        smallest.absolute_max = std::max(smallest.absolute_max, grid.absolute_max);
        smallest.quad_extent = std::max(smallest.quad_extent, grid.quad_extent);
    });
    if (options.oriented() && std::isfinite(smallest.absolute_max))
        consider(axes_of_micropolygons(*grids_, list));
    return smallest;
}

}  // namespace trapeze
