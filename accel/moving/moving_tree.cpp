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

/// Boxes of one micropolygon at the keys of its grid.
struct GridKeyBoxes {
    std::array<Box3f, kMaxKeyCount> box;
    size_t count = 1;

    std::span<const Box3f> all() const { return std::span(box).first(count); }
};

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

/// Boxes of a whole micropolygon, or of its part in a box at mid-shutter, at all keys of its grid.
void boxes_at_keys(const Grid& grid, const MicropolygonId& id, const SahItem& reference,
                   MovingTreeOptions::Clipping clipping, GridKeyBoxes& result) {
    using Clipping = MovingTreeOptions::Clipping;
    result.count = grid.key_count;
    const auto pose_at = [&](size_t key) {
        QuadPose pose;
        for (int c = 0; c < 4; ++c)
            pose[static_cast<size_t>(c)] =
                vertex_of_key(grid, static_cast<int>(key), id.u + (c & 1), id.v + (c >> 1));
        return pose;
    };
    for (size_t key = 0; key < result.count; ++key) result.box[key] = box_of(pose_at(key));
    if (!PartId::is_part(reference.id)) return;
    const QuadPose middle = pose_of(grid, id, 0.5f);
    if (clipping == Clipping::Polygon) {
        const MicropolygonPart part(middle, reference.box);
        if (part.is_empty()) return;
        for (size_t key = 0; key < result.count; ++key) result.box[key] = part.box_when(pose_at(key));
    } else {
        const Box3f whole = box_of(middle);
        for (size_t key = 0; key < result.count; ++key)
            result.box[key] = moved_with(reference.box, whole, result.box[key]);
    }
}

}  // namespace

/// What leaves are made of: lists of references, each an index of an id.
struct MovingTree::Sources {
    std::span<const GridSummary> summaries;
    std::span<const MicropolygonId> ids;
    std::span<const SahItem> references;
};

MovingTree::MovingTree(const Grids& grids, const MovingTreeOptions& options)
    : ListTree(grids), options_(options) {
    build();
}

void MovingTree::build() {
    PhaseClock clock;
    BuildPhases phases;
    const std::vector<GridSummary> summaries =
        framed_summaries(*grids_, {PaperTreeOptions::Bounds::AxisAligned});
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
    const std::vector<GridSummary> summaries =
        framed_summaries(grids, {PaperTreeOptions::Bounds::AxisAligned});
    std::vector<SahItem> whole(micropolygons_.size());
    for (size_t i = 0; i < whole.size(); ++i) whole[i].id = static_cast<uint32_t>(i);
    bound({summaries, micropolygons_, whole});
}

void MovingTree::bound(const Sources& sources) {
    top_.key_count = options_.keys > 0 ? options_.keys : grids_->max_key_count();
    top_.boxes.resize(top_.nodes.size() * static_cast<size_t>(top_.key_count));
    tbb::parallel_for(size_t{0}, top_.nodes.size(), [&](size_t node) {
        if (top_.nodes[node].link.is_leaf()) bound_leaf(sources, node);
    });
    if (!top_.nodes.empty()) bound_below(top_.nodes.size() - 1, 0);
    stats_.tree_sah_cost = sah_cost();
}

double MovingTree::sah_cost() const {
    if (top_.nodes.empty()) return 0;
    const auto keys = static_cast<size_t>(top_.key_count);
    const auto mean_area = [&](size_t node) {
        double sum = 0;
        for (size_t key = 0; key < keys; ++key) {
            const KeyBox& box = top_.boxes[node * keys + key];
            // Between keys boxes are interpolated: those at both ends count for half a segment.
            const double part = keys > 2 && (key == 0 || key + 1 == keys) ? .5 : 1;
            sum += part * half_area(Box3f(V3f(box.low[0], box.low[1], box.low[2]),
                                          V3f(box.high[0], box.high[1], box.high[2])));
        }
        return sum;
    };
    const double root = mean_area(top_.nodes.size() - 1);
    if (!(root > 0)) return 0;
    double sum = 0;
    for (size_t i = 0; i < top_.nodes.size(); ++i) {
        const TopLink link = top_.nodes[i].link;
        const double steps =
            link.is_leaf() ? static_cast<double>(leaf_first_[link.index() + 1] - leaf_first_[link.index()])
                           : 1;
        sum += steps * mean_area(i);
    }
    return sum / root;
}

void MovingTree::bound_leaf(const Sources& sources, size_t at) {
    const auto keys = static_cast<size_t>(top_.key_count);
    std::array<Box3f, kMaxKeyCount> of_leaf, at_keys;
    std::fill_n(of_leaf.begin(), keys, Box3f());
    GridKeyBoxes of_grid;
    TopLevel::Node& node = top_.nodes[at];
    node.absolute_max = node.quad_extent = 0;
    const uint32_t list = node.link.index();
    for (size_t r = leaf_first_[list]; r < leaf_first_[list + 1]; ++r) {
        const SahItem& reference = sources.references[r];
        const MicropolygonId& id = sources.ids[PartId::index(reference.id)];
        const GridSummary& summary = sources.summaries[id.grid];
        node.absolute_max = std::max(node.absolute_max, summary.absolute_max);
        node.quad_extent = std::max(node.quad_extent, summary.quad_extent);
        if (std::isfinite(summary.absolute_max)) {
            boxes_at_keys(grids_->grids[id.grid], id, reference, options_.clipping, of_grid);
        } else {  // its rounding makes any box infinite
            of_grid.count = 1, of_grid.box[0] = Box3f(V3f(0), V3f(0));
        }
        keyed_boxes(of_grid.all(), std::span(at_keys).first(keys));
        for (size_t key = 0; key < keys; ++key) of_leaf[key].extendBy(at_keys[key]);
    }
    KeyBox* const to = top_.boxes.data() + at * keys;
    for (size_t key = 0; key < keys; ++key)
        for (int k = 0; k < 3; ++k)
            to[key].low[k] = of_leaf[key].min[k], to[key].high[k] = of_leaf[key].max[k];
}

void MovingTree::bound_below(size_t at, int depth) {
    TopLevel::Node& node = top_.nodes[at];
    if (node.link.is_leaf()) return;
    const auto keys = static_cast<size_t>(top_.key_count);
    const size_t low = 2 * size_t{node.link.index()}, high = low + 1;
    if (depth < kParallelLevels)
        tbb::parallel_invoke([&] { bound_below(low, depth + 1); }, [&] { bound_below(high, depth + 1); });
    else
        bound_below(low, depth + 1), bound_below(high, depth + 1);
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
}

}  // namespace trapeze
