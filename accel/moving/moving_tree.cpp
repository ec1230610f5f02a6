#include "accel/moving/moving_tree.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "accel/builders/grid_summary.h"
#include "accel/builders/micropolygon_boxes.h"
#include "accel/moving/key_boxes.h"

namespace trapeze {
namespace {

/// Boxes of one micropolygon at the keys of its grid.
struct GridKeyBoxes {
    std::array<Box3f, kMaxKeyCount> box;
    size_t count = 1;

    std::span<const Box3f> all() const { return std::span(box).first(count); }
};

float time_of_key(size_t key, size_t count) {
    return count == 1 ? 0.0f : static_cast<float>(key) / static_cast<float>(count - 1);
}

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
    const auto pose_at = [&](size_t key) { return pose_of(grid, id, time_of_key(key, result.count)); };
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

/// What leaves are made of.
struct MovingTree::Sources {
    const std::vector<GridSummary>& summaries;
    const std::vector<MicropolygonId>& ids;
    const MovingTreeOptions& options;
};

MovingTree::MovingTree(const Grids& grids, const MovingTreeOptions& options) : grids_(grids) {
    const std::vector<GridSummary> summaries =
        framed_summaries(grids, {PaperTreeOptions::Bounds::AxisAligned});
    std::vector<MicropolygonId> ids;
    std::vector<SahItem> items;
    micropolygon_items(grids, summaries, ids, items);
    SpatialOptions spatial;
    spatial.leaf_below = static_cast<size_t>(options.leaf);
    spatial.budget = static_cast<size_t>(options.budget * static_cast<double>(items.size()));
    // The boxes of the second form have to hold all of the whole box together.
    spatial.tight = options.clipping != MovingTreeOptions::Clipping::Box;
    SpatialTopology topology = build_spatial_topology(items, grids, ids, spatial);

    items = {};
    leaf_first_ = std::move(topology.leaf_first);
    top_.key_count = options.keys > 0 ? options.keys : grids.max_key_count();
    top_.oriented = false;
    const auto by_id = [](const SahItem& a, const SahItem& b) {
        return PartId::index(a.id) < PartId::index(b.id);
    };
    tbb::parallel_for(size_t{0}, leaf_first_.size() - 1, [&](size_t i) {
        std::sort(topology.references.begin() + leaf_first_[i],
                  topology.references.begin() + leaf_first_[i + 1], by_id);
    });
    std::vector<Box3f> boxes((leaf_first_.size() - 1) * static_cast<size_t>(top_.key_count));
    std::vector<TopLevel::Node> leaves(leaf_first_.size() - 1);
    bound_leaves({summaries, ids, options}, topology, boxes, leaves);
    bound_nodes(topology.tree, boxes, leaves);

    micropolygons_.resize(topology.references.size());
    for (size_t i = 0; i < micropolygons_.size(); ++i)
        micropolygons_[i] = ids[PartId::index(topology.references[i].id)];
    stats_.tree_bytes = sizeof(*this) + top_.bytes() + micropolygons_.capacity() * sizeof(MicropolygonId) +
                        leaf_first_.capacity() * sizeof(uint32_t);
    stats_.tree_nodes = top_.nodes.size();
    stats_.tree_leaves = leaves.size();
    stats_.tree_references = micropolygons_.size();
    stats_.tree_duplicates = micropolygons_.size() - ids.size();
    stats_.tree_splits = topology.splits;
    stats_.lacked_budget = topology.lacked_budget;
}

void MovingTree::bound_leaves(const Sources& sources, const SpatialTopology& topology,
                              std::vector<Box3f>& boxes, std::vector<TopLevel::Node>& leaves) const {
    const auto keys = static_cast<size_t>(top_.key_count);
    tbb::parallel_for(size_t{0}, leaves.size(), [&](size_t i) {
        const std::span<Box3f> of_leaf = std::span(boxes).subspan(i * keys, keys);
        std::array<Box3f, kMaxKeyCount> at_keys;
        GridKeyBoxes of_grid;
        leaves[i].link = TopLink::leaf(static_cast<uint32_t>(i));
        for (size_t r = leaf_first_[i]; r < leaf_first_[i + 1]; ++r) {
            const SahItem& reference = topology.references[r];
            const MicropolygonId& id = sources.ids[PartId::index(reference.id)];
            const GridSummary& summary = sources.summaries[id.grid];
            leaves[i].absolute_max = std::max(leaves[i].absolute_max, summary.absolute_max);
            leaves[i].quad_extent = std::max(leaves[i].quad_extent, summary.quad_extent);
            if (std::isfinite(summary.absolute_max)) {
                boxes_at_keys(grids_.grids[id.grid], id, reference, sources.options.clipping, of_grid);
            } else {  // its rounding makes any box infinite
                of_grid.count = 1, of_grid.box[0] = Box3f(V3f(0), V3f(0));
            }
            keyed_boxes(of_grid.all(), std::span(at_keys).first(keys));
            for (size_t key = 0; key < keys; ++key) of_leaf[key].extendBy(at_keys[key]);
        }
    });
}

void MovingTree::bound_nodes(const TopTopology& topology, const std::vector<Box3f>& boxes,
                             const std::vector<TopLevel::Node>& leaves) {
    if (leaves.empty()) return;
    const auto keys = static_cast<size_t>(top_.key_count);
    const auto set_box = [&](size_t node, size_t key, const Box3f& box) {
        KeyBox& to = top_.boxes[node * keys + key];
        for (int k = 0; k < 3; ++k) to.low[k] = box.min[k], to.high[k] = box.max[k];
    };
    top_.nodes.resize(2 * leaves.size() - 1);
    top_.boxes.resize(top_.nodes.size() * keys);
    const auto set_node = [&](size_t node, TopLink link) {
        if (link.is_leaf()) {
            top_.nodes[node] = leaves[link.index()];
            for (size_t key = 0; key < keys; ++key) set_box(node, key, boxes[link.index() * keys + key]);
            return;
        }
        const size_t low = 2 * size_t{link.index()}, high = low + 1;
        const TopLevel::Node &a = top_.nodes[low], &b = top_.nodes[high];
        top_.nodes[node] = {std::max(a.absolute_max, b.absolute_max), std::max(a.quad_extent, b.quad_extent),
                            link};
        for (size_t key = 0; key < keys; ++key) {
            const KeyBox &of_a = top_.boxes[low * keys + key], &of_b = top_.boxes[high * keys + key];
            KeyBox& to = top_.boxes[node * keys + key];
            for (int k = 0; k < 3; ++k) {
                to.low[k] = std::min(of_a.low[k], of_b.low[k]);
                to.high[k] = std::max(of_a.high[k], of_b.high[k]);
            }
        }
    };
    // Inner nodes are in preorder: what is below one comes after it.
    for (size_t i = topology.inner.size(); i-- > 0;)
        for (const size_t side : {0, 1}) set_node(2 * i + side, topology.inner[i][side]);
    set_node(top_.nodes.size() - 1, topology.root);
}

}  // namespace trapeze
