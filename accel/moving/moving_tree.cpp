#include "accel/moving/moving_tree.h"

#include <tbb/parallel_for.h>
#include <tbb/parallel_invoke.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "accel/builders/build_clock.h"
#include "accel/builders/grid_summary.h"
#include "accel/builders/micropolygon_boxes.h"
#include "accel/builders/sah_topology.h"
#include "accel/moving/key_boxes.h"
#include "accel/moving/linear_topology.h"

namespace trapeze {
namespace {

constexpr int kParallelLevels = 7;  ///< levels whose subtrees are bounded in parallel

using KeyBoxes = std::array<Box3f, kMaxKeyCount>;

/// A box that lies in `whole` of mid-shutter, where the same place of `then` is [Gruenschloss11 eq. 1]: along
/// an axis without extent the whole of it.
Box3f moved_with(const Box3f& box, const Box3f& whole, const Box3f& then) {
    Box3f moved = then;
    for (int k = 0; k < 3; ++k) {
        const float extent = whole.max[k] - whole.min[k], extent_then = then.max[k] - then.min[k];
        if (!(extent > 0)) continue;
        moved.min[k] = then.min[k] + (box.min[k] - whole.min[k]) / extent * extent_then;
        moved.max[k] = then.min[k] + (box.max[k] - whole.min[k]) / extent * extent_then;
    }
    return moved;
}

/// Boxes of a whole micropolygon, or of its part in a box at mid-shutter, at all keys of its grid, of which
/// it returns the number.
size_t boxes_at_keys(const Grid& grid, const MicropolygonId& id, const SahItem& reference,
                     MovingTreeOptions::Clipping clipping, KeyBoxes& boxes) {
    using Clipping = MovingTreeOptions::Clipping;
    const auto keys = static_cast<size_t>(grid.key_count);
    std::array<int, 4> at{};
    for (int c = 0; c < 4; ++c)
        at[static_cast<size_t>(c)] = grid.shape.tiled_index(id.u + (c & 1), id.v + (c >> 1));
    const auto pose_at = [&](size_t key) {
        const KeyVertices vertices(grid, static_cast<int>(key));
        return QuadPose{vertices[at[0]], vertices[at[1]], vertices[at[2]], vertices[at[3]]};
    };
    for (size_t key = 0; key < keys; ++key) boxes[key] = box_of(pose_at(key));
    if (!PartId::is_part(reference.id)) return keys;
    const QuadPose middle = pose_of(grid, id, 0.5f);
    if (clipping == Clipping::Polygon) {
        const MicropolygonPart part(middle, reference.box);
        if (part.is_empty()) return keys;
        for (size_t key = 0; key < keys; ++key) boxes[key] = part.box_when(pose_at(key));
    } else {
        const Box3f whole = box_of(middle);
        for (size_t key = 0; key < keys; ++key) boxes[key] = moved_with(reference.box, whole, boxes[key]);
    }
    return keys;
}

}  // namespace

/// What leaves are made of: lists of references, each an index of an id.
struct MovingTree::Sources {
    std::span<const GridSummary> summaries;
    std::span<const MicropolygonId> ids;
    std::span<const SahItem> references;

    /// Asks memory for what references further on need, in steps of which each needs the one before. Leaves
    /// are bounded from left to right, and their grids are anywhere: waiting for them took four fifths of the
    /// time. Inlined, since GCC drops calls of what only reads and asks.
    [[gnu::always_inline]] void look_ahead(const Grids& grids, size_t reference) const {
        constexpr size_t kIds = 32, kGrids = 20, kVertices = 10;
        const auto id_of = [&](size_t r) -> const MicropolygonId& {
            return ids[PartId::index(references[r].id)];
        };
        if (reference + kIds >= references.size()) return;
        __builtin_prefetch(&id_of(reference + kIds));
        const uint32_t grid = id_of(reference + kGrids).grid;
        __builtin_prefetch(&summaries[grid]);
        __builtin_prefetch(&grids.grids[grid]);
        const MicropolygonId& next = id_of(reference + kVertices);
        const Grid& of_next = grids.grids[next.grid];
        const int at = of_next.shape.tiled_index(next.u, next.v);
        for (int segment = 0; segment < segment_count(of_next.key_count); ++segment)
            for (int k = 0; k < (of_next.moves() ? 6 : 3); ++k)
                __builtin_prefetch(of_next.plane(segment, k) + at);
    }
};

/// What bounding a leaf works on; it is large, and made once for many leaves.
struct MovingTree::LeafBoxes {
    KeyBoxes of_leaf, at_keys, of_grid;
};

MovingTree::MovingTree(const Grids& grids, const MovingTreeOptions& options)
    : ListTree(grids), options_(options) {
    build();
}

void MovingTree::build() {
    PhaseClock clock;
    BuildPhases phases;
    const std::vector<GridSummary> summaries = summaries_along_axes(*grids_);
    std::vector<MicropolygonId> ids;
    std::vector<SahItem> items;
    micropolygon_items(*grids_, summaries, ids, items);
    SpatialOptions spatial;
    spatial.leaf_below = static_cast<size_t>(options_.leaf);
    spatial.budget = static_cast<size_t>(options_.budget * static_cast<double>(items.size()));
    // The boxes of the second form have to hold all of the whole box together.
    spatial.tight = options_.clipping != MovingTreeOptions::Clipping::Box;
    phases.prepare = clock.end_phase();
    SpatialTopology topology = options_.topology == MovingTreeOptions::Topology::Morton
                                   ? build_linear_topology(items, spatial.leaf_below)
                                   : build_spatial_topology(items, *grids_, ids, spatial);
    phases.divide = clock.end_phase(), phases.divide_work = topology.work,
    phases.cut_work = topology.cut_work;

    items = {};
    leaf_first_ = std::move(topology.leaf_first);
    top_.oriented = false;
    const auto by_id = [](const SahItem& a, const SahItem& b) {
        return PartId::index(a.id) < PartId::index(b.id);
    };
    tbb::parallel_for(size_t{0}, leaf_count(), [&](size_t i) {
        std::sort(topology.references.begin() + leaf_first_[i],
                  topology.references.begin() + leaf_first_[i + 1], by_id);
    });
    link_nodes(topology.tree);
    bound({summaries, ids, topology.references});

    micropolygons_.resize(topology.references.size());
    tbb::parallel_for(size_t{0}, micropolygons_.size(),
                      [&](size_t i) { micropolygons_[i] = ids[PartId::index(topology.references[i].id)]; });
    count_built(sizeof(*this));
    stats_.tree_references = micropolygons_.size();
    stats_.tree_duplicates = micropolygons_.size() - ids.size();
    stats_.tree_splits = topology.splits;
    stats_.lacked_budget = topology.lacked_budget;
    phases.bound = clock.end_phase();
    stats_.phases = phases;
}

void MovingTree::link_nodes(const TopTopology& topology) {
    top_.nodes.clear();
    if (leaf_count() == 0) return;
    top_.nodes.resize(2 * leaf_count() - 1);
    for (size_t i = 0; i < topology.inner.size(); ++i)
        for (const size_t side : {0, 1}) top_.nodes[2 * i + side].link = topology.inner[i][side];
    top_.nodes.back().link = topology.root;
}

bool MovingTree::lists_hold(const Grids& grids) const {
    if (micropolygons_.size() - stats_.tree_duplicates != grids.micropolygon_count()) return false;
    return std::ranges::all_of(micropolygons_, [&](const MicropolygonId& id) {
        return id.grid < grids.grids.size() && id.u < grids.grids[id.grid].shape.nu &&
               id.v < grids.grids[id.grid].shape.nv;
    });
}

void MovingTree::refit(const Grids& grids) {
    grids_ = &grids;
    if (!lists_hold(grids)) {
        build();
        return;
    }
    const std::vector<GridSummary> summaries = summaries_along_axes(grids);
    std::vector<SahItem> whole(micropolygons_.size());
    for (size_t i = 0; i < whole.size(); ++i) whole[i].id = static_cast<uint32_t>(i);
    bound({summaries, micropolygons_, whole});
}

void MovingTree::bound(const Sources& sources) {
    top_.key_count = options_.keys > 0 ? options_.keys : grids_->max_key_count();
    top_.boxes.resize(top_.nodes.size() * static_cast<size_t>(top_.key_count));
    stats_.tree_sah_cost = 0;
    if (top_.nodes.empty()) return;
    const size_t root = top_.nodes.size() - 1;
    LeafBoxes boxes;
    const double costs = bound_below(sources, root, 0, boxes), area = mean_area(root);
    if (area > 0) stats_.tree_sah_cost = costs / area;
}

double MovingTree::mean_area(size_t node) const {
    const auto keys = static_cast<size_t>(top_.key_count);
    double sum = 0;
    for (size_t key = 0; key < keys; ++key) {
        const KeyBox& box = top_.boxes[node * keys + key];
        // Between keys boxes are interpolated: those at both ends count for half a segment.
        const double part = keys > 2 && (key == 0 || key + 1 == keys) ? .5 : 1;
        sum += part * half_area(Box3f(V3f(box.low[0], box.low[1], box.low[2]),
                                      V3f(box.high[0], box.high[1], box.high[2])));
    }
    return sum;
}

void MovingTree::bound_leaf(const Sources& sources, size_t at, LeafBoxes& boxes) {
    const auto keys = static_cast<size_t>(top_.key_count);
    auto& [of_leaf, at_keys, of_grid] = boxes;
    std::fill_n(of_leaf.begin(), keys, Box3f());
    TopLevel::Node& node = top_.nodes[at];
    node.absolute_max = node.quad_extent = 0;
    const uint32_t list = node.link.index();
    for (size_t r = leaf_first_[list]; r < leaf_first_[list + 1]; ++r) {
        sources.look_ahead(*grids_, r);
        const SahItem& reference = sources.references[r];
        const MicropolygonId& id = sources.ids[PartId::index(reference.id)];
        const GridSummary& summary = sources.summaries[id.grid];
        node.absolute_max = std::max(node.absolute_max, summary.absolute_max);
        node.quad_extent = std::max(node.quad_extent, summary.quad_extent);
        size_t grid_keys = 1;
        if (std::isfinite(summary.absolute_max)) {
            grid_keys = boxes_at_keys(grids_->grids[id.grid], id, reference, options_.clipping, of_grid);
        } else {  // its rounding makes any box infinite
            of_grid[0] = Box3f(V3f(0), V3f(0));
        }
        keyed_boxes(std::span(of_grid).first(grid_keys), std::span(at_keys).first(keys));
        for (size_t key = 0; key < keys; ++key) of_leaf[key].extendBy(at_keys[key]);
    }
    KeyBox* const to = top_.boxes.data() + at * keys;
    for (size_t key = 0; key < keys; ++key)
        for (int k = 0; k < 3; ++k)
            to[key].low[k] = of_leaf[key].min[k], to[key].high[k] = of_leaf[key].max[k];
}

double MovingTree::bound_below(const Sources& sources, size_t at, int depth, LeafBoxes& boxes) {
    TopLevel::Node& node = top_.nodes[at];
    if (node.link.is_leaf()) {
        bound_leaf(sources, at, boxes);
        const uint32_t list = node.link.index();
        return (leaf_first_[list + 1] - leaf_first_[list]) * mean_area(at);
    }
    const auto keys = static_cast<size_t>(top_.key_count);
    const size_t low = 2 * size_t{node.link.index()}, high = low + 1;
    double cost_low = 0, cost_high = 0;
    const auto bound_low = [&](LeafBoxes& to) { cost_low = bound_below(sources, low, depth + 1, to); };
    if (depth < kParallelLevels) {
        tbb::parallel_invoke(
            [&] {
                LeafBoxes of_other_thread;
                bound_low(of_other_thread);
            },
            [&] { cost_high = bound_below(sources, high, depth + 1, boxes); });
    } else {
        bound_low(boxes);
        cost_high = bound_below(sources, high, depth + 1, boxes);
    }
    const TopLevel::Node &a = top_.nodes[low], &b = top_.nodes[high];
    node.absolute_max = std::max(a.absolute_max, b.absolute_max);
    node.quad_extent = std::max(a.quad_extent, b.quad_extent);
    for (size_t key = 0; key < keys; ++key) {
        const KeyBox &of_a = top_.boxes[low * keys + key], &of_b = top_.boxes[high * keys + key];
        KeyBox& to = top_.boxes[at * keys + key];
        for (int k = 0; k < 3; ++k) {
            to.low[k] = std::min(of_a.low[k], of_b.low[k]);
            to.high[k] = std::max(of_a.high[k], of_b.high[k]);
        }
    }
    return cost_low + cost_high + mean_area(at);
}

}  // namespace trapeze
