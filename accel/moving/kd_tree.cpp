#include "accel/moving/kd_tree.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>

#include "accel/builders/build_clock.h"
#include "accel/builders/grid_summary.h"
#include "accel/builders/micropolygon_boxes.h"

namespace trapeze {

std::vector<float> KdTree::extents_below(const std::vector<GridSummary>& summaries) const {
    std::vector<float> extents(nodes_.size());
    for (size_t node = nodes_.size(); node-- > 0;) {
        const uint32_t at = nodes_[node].index();
        if (!nodes_[node].is_leaf()) {
            extents[node] = std::max(extents[at], extents[at + 1]);
            continue;
        }
        for (uint32_t i = leaf_first_[at]; i < leaf_first_[at + 1]; ++i)
            extents[node] = std::max(extents[node], summaries[references_[i].id.grid].quad_extent);
    }
    return extents;
}

KdTree::KdTree(const Grids& grids, const KdTreeOptions& options) : grids_(grids), mailbox_(options.mailbox) {
    PhaseClock clock;
    const std::vector<GridSummary> summaries = summaries_along_axes(grids);
    for (size_t g = 0; g < summaries.size(); ++g) {
        const GridSummary& summary = summaries[g];
        if (std::isfinite(summary.absolute_max)) {
            absolute_max_ = std::max(absolute_max_, summary.absolute_max);
            continue;
        }
        const GridShape& shape = grids.grids[g].shape;
        for (int i = 0; i < shape.micropolygon_count(); ++i)
            unbounded_.push_back(micropolygon_of_grid(g, shape, i));
    }
    const SweptBoxes boxes(grids, summaries);
    stats_.phases.prepare = clock.end_phase();
    KdTopology topology = build_kd_topology(grids, boxes, options);
    stats_.phases.divide = clock.end_phase();
    stats_.phases.divide_work = topology.work, stats_.phases.cut_work = topology.part_work;
    nodes_ = std::move(topology.nodes);
    leaf_first_ = std::move(topology.leaf_first);
    for (int k = 0; k < 3; ++k) box_.low[k] = topology.box.min[k], box_.high[k] = topology.box.max[k];
    references_.resize(topology.references.size());
    tbb::parallel_for(size_t{0}, references_.size(), [&](size_t i) {
        const KdReference& from = topology.references[i];
        // Rounded outwards: `from` by the conversion, which cuts off, and `to` by std::ceil().
        // The same product as of a ray's time, so that both round alike.
        references_[i] = {boxes.id(from.item), static_cast<uint16_t>(from.when.from * kTimeSteps),
                          static_cast<uint16_t>(std::min(std::ceil(from.when.to * kTimeSteps), kTimeSteps))};
    });

    extents_ = extents_below(summaries);

    stats_.tree_bytes = sizeof(*this) + nodes_.capacity() * (sizeof(KdNode) + sizeof(float)) +
                        leaf_first_.capacity() * sizeof(uint32_t) +
                        references_.capacity() * sizeof(Reference) +
                        unbounded_.capacity() * sizeof(MicropolygonId);
    stats_.tree_nodes = nodes_.size();
    stats_.tree_leaves = leaf_first_.size() - 1;
    stats_.tree_references = references_.size() + unbounded_.size();
    stats_.tree_duplicates = references_.size() - std::min(references_.size(), boxes.size());
    stats_.tree_splits = (nodes_.size() - stats_.tree_leaves);
    stats_.tree_guests = topology.guests, stats_.tree_incoherent = topology.incoherent;
    stats_.lacked_budget = topology.lacked_budget;
    stats_.phases.bound = clock.end_phase();
}

}  // namespace trapeze
