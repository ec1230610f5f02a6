#include "accel/moving/moving_tree.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>
#include <tbb/parallel_invoke.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>

#include "accel/builders/box_sum.h"
#include "accel/builders/build_clock.h"
#include "accel/builders/grid_summary.h"
#include "accel/builders/micropolygon_boxes.h"
#include "accel/builders/sah_topology.h"
#include "accel/moving/key_boxes.h"
#include "accel/moving/linear_topology.h"
#include "accel/paper/paired_nodes.h"

namespace trapeze {
namespace {

constexpr int kParallelLevels = 7;  ///< levels whose subtrees are bounded in parallel

/// Room for boxes at all keys of any grid or tree; the first ones are used.
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

/// Half the area of a box.
double area_in_lanes(const KeyBox& box) {
    using Floats = BoxLanes::Lanes;
    using Doubles = double __attribute__((vector_size(32)));
    Floats low, high;
    std::memcpy(&low, box.low, sizeof low), std::memcpy(&high, box.high, sizeof high);
    const Doubles side = __builtin_convertvector(high, Doubles) - __builtin_convertvector(low, Doubles);
    const Doubles faces = side * __builtin_shufflevector(side, side, 1, 2, 0, 3);
    return faces[0] + faces[1] + faces[2];
}

/// Boxes at all keys of its grid of the part of a micropolygon that is in `part` when it is as `then`;
/// `whole`: those of all of it.
void boxes_of_part(const Grid& grid, const MicropolygonId& id, const Box3f& part, const QuadPose& then,
                   MovingTreeOptions::Clipping clipping, std::span<const Box3f> whole, KeyBoxes& boxes) {
    using Clipping = MovingTreeOptions::Clipping;
    std::ranges::copy(whole, boxes.begin());
    if (clipping != Clipping::Polygon) {
        for (size_t key = 0; key < whole.size(); ++key)
            boxes[key] = moved_with(part, box_of(then), whole[key]);
        return;
    }
    const MicropolygonPart polygon(then, part);
    // The whole boxes, which hold any part, stay.
    if (polygon.is_empty()) return;
    std::array<int, 4> at{};
    for (int c = 0; c < 4; ++c)
        at[static_cast<size_t>(c)] = grid.shape.tiled_index(id.u + (c & 1), id.v + (c >> 1));
    for (size_t key = 0; key < whole.size(); ++key) {
        const KeyVertices vertices(grid, static_cast<int>(key));
        boxes[key] = polygon.box_when({vertices[at[0]], vertices[at[1]], vertices[at[2]], vertices[at[3]]});
    }
}

/// In lanes, and so written at once: it is read in lanes right away.
KeyBox grown(const BoxSum& sum, float by) {
    using Floats = BoxLanes::Lanes;
    const BoxLanes box = sum.lanes();
    const Floats fourth = {-1, 1, 0, 0}, pad = {by, by, by, 0};  // a fourth slab that holds all
    const Floats low = __builtin_shufflevector(box.low, fourth, 0, 1, 2, 4) - pad;
    const Floats high = __builtin_shufflevector(box.high, fourth, 1, 2, 3, 5) + pad;
    KeyBox grown;
    std::memcpy(grown.low, &low, sizeof low), std::memcpy(grown.high, &high, sizeof high);
    return grown;
}

}  // namespace

/// What leaves are made of: a list of references, each to a micropolygon or to a part of one.
struct MovingTree::Sources {
    const SweptBoxes& boxes;
    std::span<const uint32_t> references;  ///< PartIds of micropolygons in `boxes`, list after list
    std::span<const SahItem> parts;        ///< as the references, where some are to parts
    std::span<const LanePose> poses;       ///< of micropolygons at mid-shutter, where there are parts
    const LastFrame* last = nullptr;       ///< else it says which are, and of what
    bool are_places = false;               ///< the references: of whole micropolygons, SweptBoxes::place()

    size_t place(size_t r) const {
        return are_places ? references[r] : boxes.place(PartId::index(references[r]));
    }
    /// Micropolygons next to each other in a tree are anywhere in memory: asks for those of references to
    /// come.
    [[gnu::always_inline]] void fetch_after(size_t r) const {
        constexpr size_t kAhead = 24;
        const size_t end = references.size() - 1;
        if (!are_places) boxes.fetch_place(PartId::index(references[std::min(r + 2 * kAhead, end)]));
        boxes.fetch(place(std::min(r + kAhead, end)));
    }
};

/// The frame before one that a tree is refitted to.
struct MovingTree::LastFrame {
    const Grids& grids;
    std::vector<Box3f> at_close;  ///< of leaves, by their lists, as the shutter closed
    std::vector<uint32_t> times;  ///< by micropolygon: its references

    /// Sets boxes of what a leaf has of a micropolygon; false, with nothing set, where that was nowhere that
    /// can be bounded.
    bool boxes_of(const Grid& now, const MicropolygonId& id, size_t list,
                  MovingTreeOptions::Clipping clipping, std::span<const Box3f> whole, KeyBoxes& boxes) const;
};

/// What bounding a leaf works on; it is large, and made once for many leaves.
struct MovingTree::LeafBoxes {
    std::array<BoxSum, kMaxKeyCount> of_leaf;
    BoxSum whole;         ///< of all that is in the leaf: of parts the whole
    LongestSide longest;  ///< of micropolygons
    KeyBoxes of_part;
};

MovingTree::MovingTree(const Grids& grids, const MovingTreeOptions& options)
    : ListTree(grids), options_(options) {
    build();
}

void MovingTree::build() {
    PhaseClock clock;
    BuildPhases phases;
    const bool linear = options_.topology == MovingTreeOptions::Topology::Morton;
    MiddlePoints middles;
    const SweptBoxes boxes(*grids_, linear ? &middles : nullptr);
    top_.oriented = false;
    if (linear) {
        phases.prepare = clock.end_phase();
        LinearTopology topology = build_linear_topology(middles.at, middles.box,
                                                        static_cast<size_t>(options_.leaf), boxes.places());
        middles = {};
        phases.divide = clock.end_phase();
        leaf_first_ = std::move(topology.leaf_first);
        link_nodes(topology.tree, leaf_count(), top_.nodes);
        bound({boxes, topology.items, {}, {}, nullptr, !boxes.places().empty()});
    } else {
        build_spatial(boxes, clock, phases);
    }
    count_built(sizeof(*this));
    stats_.tree_references = micropolygons_.size();
    stats_.tree_duplicates = micropolygons_.size() - boxes.size();
    phases.bound = clock.end_phase();
    stats_.phases = phases;
}

void MovingTree::build_spatial(const SweptBoxes& boxes, PhaseClock& clock, BuildPhases& phases) {
    UnsetVector<MicropolygonId> ids;
    UnsetVector<SahItem> items;
    micropolygon_items(*grids_, summaries_along_axes(*grids_), ids, items);
    SpatialOptions spatial;
    spatial.leaf_below = static_cast<size_t>(options_.leaf);
    spatial.budget = static_cast<size_t>(options_.budget * static_cast<double>(items.size()));
    // The boxes of the second form have to hold all of the whole box together.
    spatial.tight = options_.clipping != MovingTreeOptions::Clipping::Box;
    phases.prepare = clock.end_phase();
    SpatialTopology topology = build_spatial_topology(items, *grids_, spatial);
    phases.divide = clock.end_phase(), phases.divide_work = topology.work;
    phases.cut_work = topology.cut_work;
    stats_.tree_splits = topology.splits, stats_.lacked_budget = topology.lacked_budget;

    items = {};
    leaf_first_ = std::move(topology.leaf_first);
    const auto by_id = [](const SahItem& a, const SahItem& b) {
        return PartId::index(a.id) < PartId::index(b.id);
    };
    UnsetVector<uint32_t> references(topology.references.size());
    tbb::parallel_for(size_t{0}, leaf_count(), [&](size_t i) {
        const uint32_t first = leaf_first_[i], last = leaf_first_[i + 1];
        std::sort(topology.references.begin() + first, topology.references.begin() + last, by_id);
        for (uint32_t r = first; r < last; ++r) references[r] = topology.references[r].id;
    });
    link_nodes(topology.tree, leaf_count(), top_.nodes);
    bound({boxes, references, topology.references, topology.poses});
}

bool MovingTree::lists_hold(const Grids& grids) const {
    if (micropolygons_.size() - stats_.tree_duplicates != grids.micropolygon_count()) return false;
    return std::ranges::all_of(micropolygons_, [&](const MicropolygonId& id) {
        return id.grid < grids.grids.size() && id.u < grids.grids[id.grid].shape.nu &&
               id.v < grids.grids[id.grid].shape.nv;
    });
}

void MovingTree::refit(const Grids& grids) {
    if (!lists_hold(grids)) {
        grids_ = &grids;
        build();
        return;
    }
    const SweptBoxes boxes(grids);
    std::vector<uint32_t> references(micropolygons_.size()), times(boxes.size());
    for (size_t i = 0; i < references.size(); ++i) {
        const MicropolygonId& id = micropolygons_[i];
        references[i] = static_cast<uint32_t>(boxes.index_of(id, grids.grids[id.grid].shape));
        ++times[references[i]];
    }
    const LastFrame last = last_frame(std::move(times));
    grids_ = &grids;
    bound({boxes, references, {}, {}, &last});
}

MovingTree::LastFrame MovingTree::last_frame(std::vector<uint32_t> times) const {
    LastFrame last{*grids_, {}, std::move(times)};
    if (stats_.tree_duplicates == 0) return last;
    last.at_close.resize(leaf_count());
    const auto keys = static_cast<size_t>(top_.key_count);
    for (size_t node = 0; node < top_.nodes.size(); ++node) {
        if (!top_.nodes[node].link.is_leaf()) continue;
        const KeyBox& box = top_.boxes[node * keys + keys - 1];
        last.at_close[top_.nodes[node].link.index()] =
            Box3f(V3f(box.low[0], box.low[1], box.low[2]), V3f(box.high[0], box.high[1], box.high[2]));
    }
    return last;
}

bool MovingTree::LastFrame::boxes_of(const Grid& now, const MicropolygonId& id, size_t list,
                                     MovingTreeOptions::Clipping clipping, std::span<const Box3f> whole,
                                     KeyBoxes& boxes) const {
    const QuadPose then = pose_of(grids.grids[id.grid], id, 1);
    Box3f part = box_of(then);
    // Negated, so that a NaN counts as too large.
    for (int k = 0; k < 3; ++k)
        if (!(std::max(-part.min[k], part.max[k]) <= kBoundableCoordinate)) return false;
    for (int k = 0; k < 3; ++k) {
        part.min[k] = std::max(part.min[k], at_close[list].min[k]);
        part.max[k] = std::min(part.max[k], at_close[list].max[k]);
    }
    boxes_of_part(now, id, part, then, clipping, whole, boxes);
    return true;
}

void MovingTree::bound(const Sources& sources) {
    top_.key_count = options_.keys > 0 ? options_.keys : grids_->max_key_count();
    top_.boxes.resize(top_.nodes.size() * static_cast<size_t>(top_.key_count));
    micropolygons_.resize(sources.references.size());
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
        sum += part * area_in_lanes(box);
    }
    return sum;
}

std::span<const Box3f> MovingTree::boxes_of(const Sources& sources, size_t r, size_t list,
                                            std::span<const Box3f> whole, LeafBoxes& boxes) {
    const uint32_t reference = sources.references[r];
    const MicropolygonId& id = micropolygons_[r];
    std::span<const Box3f> there = whole;
    if (!std::isfinite(whole[0].min.x)) {  // its rounding makes any box infinite
        boxes.of_part[0] = Box3f(V3f(0), V3f(0));
        there = std::span(boxes.of_part).first(1);
    } else if (!sources.are_places && PartId::is_part(reference)) {
        const Grid& grid = grids_->grids[id.grid];
        boxes_of_part(grid, id, sources.parts[r].box, sources.poses[PartId::index(reference)].corners(),
                      options_.clipping, whole, boxes.of_part);
        there = std::span(boxes.of_part).first(whole.size());
    } else if (sources.last && sources.last->times[reference] > 1) {
        if (sources.last->boxes_of(grids_->grids[id.grid], id, list, options_.clipping, whole, boxes.of_part))
            there = std::span(boxes.of_part).first(whole.size());
    }
    return there;
}

void MovingTree::bound_leaf(const Sources& sources, size_t at, LeafBoxes& boxes) {
    const auto keys = static_cast<size_t>(top_.key_count);
    const std::span<BoxSum> of_leaf = std::span(boxes.of_leaf).first(keys);
    std::ranges::fill(of_leaf, BoxSum());
    boxes.whole = {}, boxes.longest = {};
    TopLevel::Node& node = top_.nodes[at];
    const uint32_t list = node.link.index();
    for (size_t r = leaf_first_[list]; r < leaf_first_[list + 1]; ++r) {
        sources.fetch_after(r);
        const size_t place = sources.place(r);
        micropolygons_[r] = sources.boxes.id_at(place);
        const std::span<const Box3f> whole = sources.boxes.keys_at(place);
        const std::span<const Box3f> there = boxes_of(sources, r, list, whole, boxes);
        add_at_keys(there, of_leaf);
        for (const Box3f& box : whole) boxes.longest.add(BoxLanes(box));
        if (there.data() != whole.data() || whole.size() > keys)
            for (const Box3f& box : whole) boxes.whole.add(box);
    }
    for (const BoxSum& sum : of_leaf) boxes.whole.add(sum);
    node.absolute_max = boxes.whole.largest_coordinate(), node.quad_extent = boxes.longest.get();
    for (size_t key = 0; key < keys; ++key) {
        // By more than each of them would be, and by as much again for those between keys.
        const float pad = 2 * kBoundRounding * of_leaf[key].largest_coordinate();
        top_.boxes[at * keys + key] = grown(of_leaf[key], pad);
    }
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
    // The scratch serves one side at a time: where both may be bounded at once, the low side gets its own.
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
        for (int k = 0; k < 4; ++k) {
            to.low[k] = std::min(of_a.low[k], of_b.low[k]);
            to.high[k] = std::max(of_a.high[k], of_b.high[k]);
        }
    }
    return cost_low + cost_high + mean_area(at);
}

}  // namespace trapeze
