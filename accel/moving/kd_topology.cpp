#include "accel/moving/kd_topology.h"

#include <tbb/parallel_invoke.h>

#include <algorithm>
#include <atomic>
#include <bit>
#include <cmath>
#include <memory>
#include <utility>

#include "accel/builders/build_clock.h"
#include "accel/moving/kd_cells.h"
#include "accel/moving/micropolygon_parts.h"

namespace trapeze {
namespace {

/// Divisions on the way to a leaf that may cost more than they gain, in the hope of better ones below them,
/// as in [Pharr10 sec. 4.4.1].
constexpr int kBadDivisions = 2;

constexpr size_t kKdNodeIsTaskFrom = 1024;  ///< references below which a subtree is one task

/// A cell's sides are at least this part of the root's longest: what is flat has surfaces too.
constexpr float kLeastSide = 1e-5f;

using References = std::vector<KdReference>;

/// A node while the tree is built: subtrees are made in parallel, and get their places in one array at the
/// end.
struct BuiltNode {
    std::unique_ptr<BuiltNode> low, high;  ///< none of a leaf
    int axis = 0;
    float plane = 0;
    References references;  ///< of a leaf
};

/// What a node is built of, and what it may do.
struct NodeTask {
    References references;
    Box3f cell;
    size_t budget = 0;  ///< references that it may add
    int depth = 0, bad_divisions = 0;
};

/// What two boxes have in common; of two that are apart, what lies between them along the axes where they
/// are.
Box3f common(const Box3f& a, const Box3f& b) {
    Box3f both;
    for (int k = 0; k < 3; ++k) {
        const float low = std::max(a.min[k], b.min[k]), high = std::min(a.max[k], b.max[k]);
        both.min[k] = std::min(low, high), both.max[k] = std::max(low, high);
    }
    return both;
}

/// Builds from the root down. Every node has its references to itself, so that both sides can be built at
/// once; they are freed as soon as the sides have theirs.
class KdBuilder {
  public:
    KdBuilder(const Grids& grids, const SweptBoxes& boxes, const KdTreeOptions& options)
        : grids_(grids), boxes_(boxes), options_(options), planes_(boxes, options), crosses_(boxes.size()) {}

    KdTopology build() {
        KdTopology result;
        if (boxes_.size() > 0) {
            NodeTask root;
            root.references.resize(boxes_.size());
            for (size_t i = 0; i < boxes_.size(); ++i) {
                root.references[i].item = static_cast<uint32_t>(i);
                root.references[i].box = boxes_.at(i, options_.plane_time);
                result.box.extendBy(boxes_.swept(i));
            }
            root.cell = with_sides(result.box);
            root.budget = static_cast<size_t>(options_.budget * static_cast<double>(boxes_.size()));
            // As in [Pharr10 sec. 4.4.1].
            depth_limit_ =
                std::min(kKdDepthLimit, 8 + 13 * (static_cast<int>(std::bit_width(boxes_.size())) - 1) / 10);
            const std::unique_ptr<BuiltNode> built = build_task(std::move(root));
            result.nodes.emplace_back();
            number(*built, 0, result);
        }
        result.leaf_first.push_back(static_cast<uint32_t>(result.references.size()));
        result.guests = guests_, result.lacked_budget = lacked_budget_;
        for (const std::atomic<bool>& crosses : crosses_) result.incoherent += crosses;
        result.work = work_.seconds(), result.part_work = part_work_.seconds();
        return result;
    }

  private:
    /// Gives a box that is flat along an axis some extent there: planes have to be strictly within their
    /// cell.
    static Box3f with_sides(Box3f box) {
        const V3f size = box.max - box.min;
        const float least = kLeastSide * std::max({size.x, size.y, size.z});
        for (int k = 0; k < 3; ++k)
            if (size[k] < least) box.min[k] -= least, box.max[k] += least;
        return box;
    }

    /// A subtree whose two sides are tasks of their own where it is large.
    std::unique_ptr<BuiltNode> build_task(NodeTask task) {
        if (task.references.size() >= kKdNodeIsTaskFrom) return build_node(std::move(task));
        const WorkSum::Span span(work_);
        return build_node(std::move(task));
    }

    /// Divides a node of a task; large ones are in none, and say what they take themselves.
    bool divide_in_task(const NodeTask& task, BuiltNode& node, NodeTask& low, NodeTask& high) {
        if (task.references.size() < kKdNodeIsTaskFrom) return divide(task, node, low, high);
        const WorkSum::Span span(work_);
        return divide(task, node, low, high);
    }

    std::unique_ptr<BuiltNode> build_node(NodeTask task) {
        auto node = std::make_unique<BuiltNode>();
        NodeTask low, high;
        if (!divide_in_task(task, *node, low, high)) {
            node->references = std::move(task.references);
            return node;
        }
        const bool is_large = task.references.size() >= kKdNodeIsTaskFrom;
        task.references = {};
        // A side of a large node may have as many references as itself.
        if (is_large)
            tbb::parallel_invoke([&] { node->low = build_task(std::move(low)); },
                                 [&] { node->high = build_task(std::move(high)); });
        else
            node->low = build_node(std::move(low)), node->high = build_node(std::move(high));
        return node;
    }

    /// Divides a node by a plane; false: it is a leaf.
    bool divide(const NodeTask& task, BuiltNode& node, NodeTask& low, NodeTask& high) {
        const size_t count = task.references.size();
        if (count < 2 || task.depth >= depth_limit_) return false;
        const KdVote vote = planes_.vote(task.references, task.cell);
        const KdPlane& plane = vote.best;
        if (!std::isfinite(plane.cost)) return false;
        low.bad_divisions = task.bad_divisions;
        if (!(plane.cost < vote.leaf_cost)) {
            if (count < static_cast<size_t>(options_.leaf) || task.bad_divisions >= kBadDivisions)
                return false;
            ++low.bad_divisions;
        }
        low.cell = high.cell = task.cell;
        low.cell.max[plane.axis] = high.cell.min[plane.axis] = plane.at;
        const uint64_t guests = part(task, plane, low, high);
        const size_t kept = low.references.size() + high.references.size();
        const size_t added = kept - std::min(kept, count);
        if (added > task.budget) {
            lacked_budget_.store(true, std::memory_order_relaxed);
            return false;
        }
        guests_.fetch_add(guests, std::memory_order_relaxed);
        node.axis = plane.axis, node.plane = plane.at;
        low.depth = high.depth = task.depth + 1;
        high.bad_divisions = low.bad_divisions;
        // What is left of the budget goes with the references.
        const size_t left = task.budget - added;
        low.budget =
            static_cast<size_t>(static_cast<double>(left) * static_cast<double>(low.references.size()) /
                                static_cast<double>(std::max<size_t>(1, kept)));
        high.budget = left - low.budget;
        return true;
    }

    /// Puts references on the sides of a plane on which they are at some time; tells how many became guests.
    uint64_t part(const NodeTask& task, const KdPlane& plane, NodeTask& low, NodeTask& high) {
        const WorkSum::Span span(part_work_);
        uint64_t guests = 0;
        for (const KdReference& reference : task.references) {
            const std::span<const Box3f> keys = boxes_.keys(reference.item);
            KdReference in_low = reference, in_high = reference;
            const bool stays_guest = reference.guest && options_.guests == KdTreeOptions::Guests::Silent;
            bool new_in_low = false, new_in_high = false;
            in_low.when = when_at_or_below(keys, plane.axis, plane.at, reference.when);
            in_high.when = when_at_or_above(keys, plane.axis, plane.at, reference.when);
            if (!in_low.when.is_empty() && !in_high.when.is_empty()) {
                const MicropolygonId& id = boxes_.id(reference.item);
                const SeparatingAxes axes(grids_.grids[id.grid], id, planes_.pose_time(reference.when));
                look_closer(reference, plane, axes, low.cell, in_low);
                look_closer(reference, plane, axes, high.cell, in_high);
                // What is on one side alone at the pose time has come to the other across the plane, as a
                // guest.
                if (!(in_low.when == in_high.when)) {
                    const float pose = planes_.pose_time(reference.when);
                    new_in_low = !in_low.when.holds(pose) && in_high.when.holds(pose);
                    new_in_high = !in_high.when.holds(pose) && in_low.when.holds(pose);
                }
            }
            if (new_in_low || new_in_high) crosses_[reference.item].store(true, std::memory_order_relaxed);
            in_low.guest = stays_guest || new_in_low, in_high.guest = stays_guest || new_in_high;
            if (!in_low.when.is_empty()) low.references.push_back(in_low), guests += new_in_low;
            if (!in_high.when.is_empty()) high.references.push_back(in_high), guests += new_in_high;
        }
        return guests;
    }

    /// Looks at the polygon where a plane cuts its box. Its time on that side is cut to when axes find it in
    /// the cell. Its box is that of the polygon's part if the pose that decides is still the same one; of
    /// another pose it is the whole micropolygon's box, cut by the cell.
    void look_closer(const KdReference& whole, const KdPlane& plane, const SeparatingAxes& axes,
                     const Box3f& cell, KdReference& part) const {
        const MicropolygonId& id = boxes_.id(part.item);
        const Grid& grid = grids_.grids[id.grid];
        const float pose_time = planes_.pose_time(whole.when);
        part.when = axes.when_in_cell(common(boxes_.swept(part.item), cell), part.when);
        if (part.when.is_empty()) return;
        const float part_time = planes_.pose_time(part.when);
        if (part_time == pose_time) {
            const Chopped chopped = chop(pose_of(grid, id, pose_time), whole.box, plane.axis, plane.at);
            const Box3f& box = cell.max[plane.axis] == plane.at ? chopped.low : chopped.high;
            part.box = box.isEmpty() ? common(whole.box, cell) : box;
        } else {
            part.box = common(boxes_.at(part.item, part_time), cell);
        }
    }

    /// Nodes in the order of their levels from left to right below `at`; leaves from left to right.
    static void number(BuiltNode& node, size_t at, KdTopology& result) {
        if (!node.low) {
            result.leaf_first.push_back(static_cast<uint32_t>(result.references.size()));
            result.references.insert(result.references.end(), node.references.begin(), node.references.end());
            node.references = {};
            result.nodes[at] = KdNode::leaf(static_cast<uint32_t>(result.leaf_first.size() - 1));
            return;
        }
        const size_t low = result.nodes.size();
        result.nodes[at] = KdNode::inner(node.axis, node.plane, static_cast<uint32_t>(low));
        result.nodes.resize(low + 2);
        number(*node.low, low, result);
        number(*node.high, low + 1, result);
    }

    const Grids& grids_;
    const SweptBoxes& boxes_;
    const KdTreeOptions& options_;
    const KdPlanes planes_;
    int depth_limit_ = 0;
    std::atomic<uint64_t> guests_{0};
    std::vector<std::atomic<bool>> crosses_;  ///< of items: whether some plane made a guest of it
    std::atomic<bool> lacked_budget_{false};
    WorkSum work_, part_work_;
};

}  // namespace

KdTopology build_kd_topology(const Grids& grids, const SweptBoxes& boxes, const KdTreeOptions& options) {
    return KdBuilder(grids, boxes, options).build();
}

}  // namespace trapeze
