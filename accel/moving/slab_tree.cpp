#include "accel/moving/slab_tree.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>

#include "accel/builders/build_clock.h"
#include "accel/builders/grid_summary.h"
#include "accel/builders/micropolygon_boxes.h"
#include "accel/moving/spatial_topology.h"
#include "accel/paper/paired_nodes.h"

namespace trapeze {
namespace {

/// How far a first vertex of a grid's micropolygons goes along each axis while the shutter is open: the root
/// mean square, by micropolygons. Grids are added up in their order, whoever reads them.
V3f mean_speed(const Grids& grids, const std::vector<uint8_t>& unbounded) {
    std::vector<V3d> squares(grids.grids.size(), V3d(0));
    std::vector<double> counts(grids.grids.size(), 0);
    tbb::parallel_for(size_t{0}, squares.size(), [&](size_t g) {
        const Grid& grid = grids.grids[g];
        if (unbounded[g]) return;
        counts[g] = grid.shape.micropolygon_count();
        if (!grid.moves()) return;
        for (int v = 0; v < grid.shape.nv; ++v)
            for (int u = 0; u < grid.shape.nu; ++u) {
                const V3d way = V3d(grid.vertex(u, v, 1)) - V3d(grid.vertex(u, v, 0));
                squares[g] += way * way;
            }
    });
    V3d sum(0);
    double count = 0;
    for (size_t g = 0; g < squares.size(); ++g) sum += squares[g], count += counts[g];
    V3f speed(0);
    for (int k = 0; k < 3 && count > 0; ++k) speed[k] = static_cast<float>(std::sqrt(sum[k] / count));
    return speed;
}

}  // namespace

SlabTree::SlabTree(const Grids& grids, const SlabTreeOptions& options) : grids_(grids) {
    PhaseClock clock;
    BuildPhases phases;
    const std::vector<GridSummary> summaries = summaries_along_axes(grids);
    for (const GridSummary& summary : summaries) unbounded_.push_back(!std::isfinite(summary.absolute_max));
    const bool is_moving = options.planes == SlabTreeOptions::Planes::Moving;
    sets_ = is_moving ? PlaneSets::of_cube() : PlaneSets::of_space_time(mean_speed(grids, unbounded_));
    key_count_ = is_moving ? static_cast<size_t>(grids.max_key_count()) : 1;
    UnsetVector<MicropolygonId> ids;
    UnsetVector<SahItem> items;
    micropolygon_items(grids, summaries, ids, items);
    phases.prepare = clock.end_phase();

    SpatialOptions spatial;
    spatial.leaf_below = static_cast<size_t>(options.leaf);
    SpatialTopology topology = build_spatial_topology(items, grids, spatial);
    phases.divide = clock.end_phase(), phases.divide_work = topology.work;
    items = {};
    leaf_first_ = std::move(topology.leaf_first);
    micropolygons_.resize(topology.references.size());
    link_nodes(topology.tree, leaf_count(), nodes_);
    extents_.resize(nodes_.size() * key_count_);
    tbb::parallel_for(size_t{0}, micropolygons_.size(),
                      [&](size_t i) { micropolygons_[i] = ids[PartId::index(topology.references[i].id)]; });
    tbb::parallel_for(size_t{0}, nodes_.size(), [&](size_t node) {
        if (nodes_[node].link.is_leaf()) bound_leaf(node);
    });
    // Inner nodes are in preorder: what is below one comes after it.
    for (size_t i = topology.tree.inner.size(); i-- > 0;)
        for (const size_t node : {2 * i, 2 * i + 1})
            if (!nodes_[node].link.is_leaf()) join(node, 2 * size_t{nodes_[node].link.index()});
    if (!nodes_.empty() && !nodes_.back().link.is_leaf())
        join(nodes_.size() - 1, 2 * size_t{nodes_.back().link.index()});
    phases.bound = clock.end_phase();

    stats_.tree_bytes = sizeof(*this) + unbounded_.capacity() + nodes_.capacity() * sizeof(Node) +
                        extents_.capacity() * sizeof(PlaneExtents) +
                        micropolygons_.capacity() * sizeof(MicropolygonId) +
                        leaf_first_.capacity() * sizeof(uint32_t);
    stats_.tree_nodes = nodes_.size(), stats_.tree_leaves = leaf_count();
    stats_.tree_references = micropolygons_.size();
    stats_.phases = phases;
}

void SlabTree::bound_leaf(size_t node) {
    PlaneExtents* const extents = extents_of(node);
    std::fill_n(extents, key_count_, PlaneExtents::empty(sets_));
    for (const MicropolygonId& id : leaf(nodes_[node].link.index()))
        bound_micropolygon(grids_.grids[id.grid], id, nodes_[node], extents);
    // Along a diagonal a coordinate is no larger than twice the largest along the axes.
    float lean = 0;
    for (size_t k = 0; k < sets_.count; ++k) lean = std::max(lean, std::abs(sets_.set[k].by_time));
    nodes_[node].absolute_max = 2 * nodes_[node].absolute_max + lean;
}

/// Takes a micropolygon into a leaf. Where planes move it is looked at at all of the tree's keys, between
/// which it goes straight, as its grid's keys are among them; else at its own alone. Of what cannot be
/// bounded a point is taken in: its rounding makes any bound infinite.
void SlabTree::bound_micropolygon(const Grid& grid, const MicropolygonId& id, Node& node,
                                  PlaneExtents* extents) const {
    if (unbounded_[id.grid]) {
        node.absolute_max = std::numeric_limits<float>::infinity();
        for (size_t key = 0; key < key_count_; ++key) extents[key].extend(sets_, V3f(0), 0);
        return;
    }
    const bool is_moving = key_count_ > 1;
    const int keys = is_moving ? static_cast<int>(key_count_) : grid.key_count;
    for (int key = 0; key < keys; ++key) {
        const float time = keys > 1 ? static_cast<float>(key) / static_cast<float>(keys - 1) : 0;
        PlaneExtents& to = extents[is_moving ? key : 0];
        Box3f box;
        for (int corner = 0; corner < 4; ++corner) {
            const V3f p = grid.vertex_at_key(id.u + (corner & 1), id.v + (corner >> 1), key, keys);
            box.extendBy(p);
            to.extend(sets_, p, time);
            // What stands still is on planes of space-time at all times.
            if (!is_moving && keys == 1) to.extend(sets_, p, 1);
        }
        for (int k = 0; k < 3; ++k) {
            node.absolute_max = std::max({node.absolute_max, -box.min[k], box.max[k]});
            node.quad_extent = std::max(node.quad_extent, box.max[k] - box.min[k]);
        }
    }
}

void SlabTree::join(size_t node, size_t first_child) {
    Node& to = nodes_[node];
    std::fill_n(extents_of(node), key_count_, PlaneExtents::empty(sets_));
    for (const size_t child : {first_child, first_child + 1}) {
        to.absolute_max = std::max(to.absolute_max, nodes_[child].absolute_max);
        to.quad_extent = std::max(to.quad_extent, nodes_[child].quad_extent);
        for (size_t key = 0; key < key_count_; ++key) extents_of(node)[key].extend(extents_of(child)[key]);
    }
}

SlabTreeView::SlabTreeView(const SlabTree& tree, const TraceRay& ray)
    : tree_(tree), segment_(segment_at(ray.axis.time, static_cast<int>(tree.key_count_))) {
    for (size_t k = 0; k < PlaneSets::kLanes; ++k) {
        const bool is_set = k < tree.sets_.count;
        const PlaneSet& set = tree.sets_.set[k];
        origin_[k] = is_set ? set.at(ray.origin, ray.axis.time) : 0;
        const float along = is_set ? set.normal.dot(ray.direction) : 0;
        inverse_[k] = 1 / (std::abs(along) < kLeastDirection ? kLeastDirection : along);
    }
}

/// Whether the ray may hit something in a node; the visit is set in any case, so that nothing branches on it.
/// As clip() in accel/slabs.h, for eight pairs of planes.
inline bool SlabTreeView::meet(size_t index, const TraceRay& ray, Visit& visit) const {
    const SlabTree::Node& node = tree_.nodes_[index];
    const PlaneExtents& from = tree_.extents_of(index)[segment_.index];
    const PlaneExtents& to = tree_.key_count_ > 1 ? (&from)[1] : from;
    const float rounding = ray.rounding(node.absolute_max);
    float near[PlaneSets::kLanes], far[PlaneSets::kLanes];
    for (size_t k = 0; k < PlaneSets::kLanes; ++k) {
        const float low = position_at(from.low[k], to.low[k] - from.low[k], segment_.local);
        const float high = position_at(from.high[k], to.high[k] - from.high[k], segment_.local);
        const float a = (low - origin_[k]) * inverse_[k], b = (high - origin_[k]) * inverse_[k];
        const float pad = rounding * std::abs(inverse_[k]);
        near[k] = (a < b ? a : b) - pad, far[k] = (a < b ? b : a) + pad;
    }
    for (size_t step = PlaneSets::kLanes / 2; step > 0; step /= 2)
        for (size_t k = 0; k < step; ++k) {
            near[k] = near[k] > near[k + step] ? near[k] : near[k + step];
            far[k] = far[k] < far[k + step] ? far[k] : far[k + step];
        }
    visit.node = node.link.value;
    return DepthInterval{near[0], far[0]}.meets(ray, node.quad_extent + rounding, visit.depth);
}

Visits SlabTreeView::enter(const TraceRay& ray) const {
    return enter_paired(tree_.nodes_.size(),
                        [&](size_t node, Visit& visit) { return meet(node, ray, visit); });
}

Visits SlabTreeView::step(const Visit& at, const TraceRay& ray) const {
    return step_paired(at.node, [&](size_t node, Visit& visit) { return meet(node, ray, visit); });
}

}  // namespace trapeze
