#include "accel/dynamic/insertion_tree.h"

#include <algorithm>
#include <numeric>
#include <utility>

#include "accel/dynamic/box_tree.h"
#include "core/random.h"

namespace trapeze {

void InsertionTree::build(const Grids& grids) {
    objects_.read(grids);
    insert_all();
}

void InsertionTree::insert_all() {
    reset();
    inserting_all_ = true;
    const size_t count = objects_.boxes.size();
    const std::vector<uint32_t> order = insertion_order();
    for (const uint32_t object : order)
        if (root_ == kNone)
            root_ = object;
        else
            insert(object, root_);
    for (int pass = 0; pass < options_.passes && count > 1; ++pass)
        for (const uint32_t object : order) {
            climb(detach(object), empty_box(), 1);  // to the root, for nothing but the empty box fits in all
            insert(object, root_);
        }
    inserting_all_ = false;
    moved_ = dissolved_ = rebuilt_ = 0;
    // Nodes were made when little was below them: thinning is measured from the complete tree.
    for (size_t node = count; node < nodes_.size(); ++node)
        nodes_[node].first_quality = quality(nodes_[node]);
}

/// Shuffled by Fisher and Yates, so many objects in one way.
std::vector<uint32_t> InsertionTree::insertion_order() const {
    std::vector<uint32_t> order(objects_.boxes.size());
    std::iota(order.begin(), order.end(), 0u);
    if (options_.order == InsertionOptions::Order::Shuffled)
        for (uint32_t left = static_cast<uint32_t>(order.size()); left > 1; --left)
            std::swap(order[left - 1], order[hash(left) % left]);
    return order;
}

/// A binary tree over n leaves has n - 1 inner nodes: as many are free to begin with, and no insertion runs
/// out of them.
void InsertionTree::reset() {
    const size_t count = objects_.boxes.size();
    nodes_.assign(count < 2 ? count : 2 * count - 1, {});
    for (size_t i = 0; i < count; ++i) nodes_[i].box = objects_.boxes[i];
    free_.clear();
    for (size_t i = nodes_.size(); i-- > count;) free_.push_back(static_cast<uint32_t>(i));
    root_ = kNone;
}

/// A frame of as many objects is taken to have the same ones in the same order.
void InsertionTree::update(const Grids& grids) {
    const size_t count = objects_.boxes.size();
    objects_.read(grids);
    if (objects_.boxes.size() != count) {
        insert_all();
        return;
    }
    moved_ = 0;
    for (uint32_t object = 0; object < count; ++object) move_if_changed(object);
    finish_update();
}

void InsertionTree::update(const Grids& grids, std::span<const uint32_t> changed) {
    if (!objects_.reread(grids, changed)) return update(grids);
    moved_ = 0;
    for (const uint32_t grid : changed)
        for (uint32_t object = objects_.first_of(grid); object < objects_.first_of(grid + 1); ++object)
            move_if_changed(object);
    finish_update();
}

void InsertionTree::finish_update() {
    dissolved_ = rebuilt_ = 0;
    rebuild_marked();
    dissolve_thinned();
}

void InsertionTree::move_if_changed(uint32_t object) {
    if (!same_box(nodes_[object].box, objects_.boxes[object])) move(object, objects_.boxes[object]);
}

/// Takes an object out of the tree, climbs to where its new box fits, and inserts it from there on.
void InsertionTree::move(uint32_t object, const KeyBox& box) {
    ++moved_;
    if (object == root_) {
        nodes_[object].box = box;
        return;
    }
    const uint32_t above = detach(object);
    nodes_[object].box = box;
    if (options_.reinsertion == InsertionOptions::Reinsertion::Rebuilt) {
        waiting_.push_back({object, climb(above, box, 1)});
        return;
    }
    if (above == kNone) {  // there were two
        insert(object, root_);
        return;
    }
    // Nothing but the empty box fits in all, so that it climbs to the root.
    const bool to_root = options_.reinsertion == InsertionOptions::Reinsertion::Root;
    const uint32_t from = climb(above, to_root ? empty_box() : box, 1);
    // Above `from` the object has been counted all along; only boxes may be too large there. Read before the
    // insertion, which may put a new node above `from`.
    const uint32_t above_that = nodes_[from].parent;
    insert(object, from);
    tighten_above(above_that);
}

/// Takes a node, with what is below it, out of the tree: its sibling takes the place of their parent, which
/// is free. Returns the node above, whose box and number are as they were.
uint32_t InsertionTree::detach(uint32_t node) {
    const uint32_t parent = nodes_[node].parent;
    const uint32_t sibling = nodes_[parent].child[nodes_[parent].child[0] == node];
    const uint32_t above = nodes_[parent].parent;
    nodes_[sibling].parent = above;
    replace_child(above, parent, sibling);
    nodes_[node].parent = kNone;
    nodes_[parent] = {};
    nodes_[parent].parent = above;  // where what waits there goes (rebuild_marked())
    free_.push_back(parent);
    return above;
}

/// A parent of kNone is the place above the root.
void InsertionTree::replace_child(uint32_t parent, uint32_t old_child, uint32_t new_child) {
    if (parent == kNone)
        root_ = new_child;
    else
        nodes_[parent].child[nodes_[parent].child[1] == old_child] = new_child;
}

/// Up from a node below which some objects were taken away, to the first ancestor that held `box` before; the
/// root if none did. Makes boxes and numbers on the way those of what is left.
uint32_t InsertionTree::climb(uint32_t from, const KeyBox& box, uint32_t objects) {
    if (from == kNone) return root_;
    for (uint32_t at = from;; at = nodes_[at].parent) {
        Node& node = nodes_[at];
        const bool held = !is_empty(box) && holds(node.box, box);
        node.box = box_of_children(node);
        node.objects -= objects;
        touch(at);
        if (held || node.parent == kNone) return at;
    }
}

/// The node to pair an inserted box with: on the way down from `from`, always to the child that grows least,
/// the one where the tree's surface grows least [Goldsmith87]. Greedy: one path is looked at, so that it
/// takes as many steps as the tree has levels below `from`.
uint32_t InsertionTree::best_sibling(const KeyBox& box, uint32_t from) const {
    const auto with = [&](uint32_t node) { return half_area_of(joined(nodes_[node].box, box)); };
    uint32_t best = from;
    float least = with(from), inherited = 0;  // what nodes above have grown by
    for (uint32_t at = from; !is_leaf(at);) {
        inherited += with(at) - half_area_of(nodes_[at].box);
        const auto& [first, second] = nodes_[at].child;
        const float first_with = with(first), second_with = with(second);
        const bool to_second =
            second_with - half_area_of(nodes_[second].box) < first_with - half_area_of(nodes_[first].box);
        at = to_second ? second : first;
        const float cost = inherited + (to_second ? second_with : first_with);
        if (cost < least) least = cost, best = at;
    }
    return best;
}

/// Inserts a node, and what is below it, at or below `from`. Nodes from `from` down grow to hold it; those
/// above are the caller's to bring up to date.
void InsertionTree::insert(uint32_t inserted, uint32_t from) {
    const KeyBox box = nodes_[inserted].box;
    const uint32_t objects = nodes_[inserted].objects;
    const uint32_t at = best_sibling(box, from);
    if (at != from)
        for (uint32_t above = nodes_[at].parent;; above = nodes_[above].parent) {
            Node& node = nodes_[above];
            node.box = joined(node.box, box);
            node.objects += objects;
            touch(above);
            if (above == from) break;
        }
    pair_up(inserted, at);
}

/// A free node becomes the parent of a node and of one that is in no tree, in the place of the former.
void InsertionTree::pair_up(uint32_t inserted, uint32_t at) {
    const uint32_t pair = free_.back();
    free_.pop_back();
    Node& node = nodes_[pair];
    node.box = joined(nodes_[at].box, nodes_[inserted].box);
    node.objects = nodes_[at].objects + nodes_[inserted].objects;
    node.first_quality = quality(node);
    node.parent = nodes_[at].parent;
    node.child = {at, inserted};
    replace_child(node.parent, at, pair);
    nodes_[at].parent = nodes_[inserted].parent = pair;
}

/// Builds anew below nodes at which objects wait, but for those that are below another.
void InsertionTree::rebuild_marked() {
    if (waiting_.empty()) return;
    std::vector<bool> is_marked(nodes_.size(), false);
    for (Waiting& one : waiting_) {
        // A node that has become free has no children; those that waited there wait above it.
        while (one.at != kNone && !is_leaf(one.at) && nodes_[one.at].child[0] == kNone)
            one.at = nodes_[one.at].parent;
        if (one.at == kNone) one.at = root_;
        is_marked[one.at] = true;
    }
    for (Waiting& one : waiting_)
        for (uint32_t above = nodes_[one.at].parent; above != kNone; above = nodes_[above].parent)
            if (is_marked[above]) one.at = above;
    std::ranges::sort(waiting_, {}, [](const Waiting& one) { return std::pair(one.at, one.object); });
    for (size_t first = 0, end = 0; first < waiting_.size(); first = end) {
        const uint32_t top = waiting_[first].at;
        std::vector<uint32_t> objects;
        for (; end < waiting_.size() && waiting_[end].at == top; ++end)
            objects.push_back(waiting_[end].object);
        rebuild_below(top, std::move(objects));
    }
    waiting_.clear();
}

/// Builds a node and all below it anew, together with objects that are in no tree.
void InsertionTree::rebuild_below(uint32_t top, std::vector<uint32_t> objects) {
    std::vector<uint32_t> inner, todo{top};
    const uint32_t above = nodes_[top].parent;
    while (!todo.empty()) {
        const uint32_t at = todo.back();
        todo.pop_back();
        if (is_leaf(at)) {
            objects.push_back(at);
            continue;
        }
        inner.push_back(at);
        for (const uint32_t child : nodes_[at].child) todo.push_back(child);
    }
    while (inner.size() + 1 < objects.size()) inner.push_back(free_.back()), free_.pop_back();
    rebuilt_ += objects.size();
    // In the order of their numbers, so that the tree depends on nothing else.
    std::ranges::sort(objects);
    const TopTopology topology = topology_over(objects_, objects);
    const auto node_of = [&](TopLink link) {
        return link.is_leaf() ? objects[link.index()] : inner[link.index()];
    };
    for (size_t i = inner.size(); i-- > 0;) {
        Node& node = nodes_[inner[i]];
        node.objects = 0;
        for (size_t side = 0; side < 2; ++side) {
            const uint32_t child = node.child[side] = node_of(topology.inner[i][side]);
            nodes_[child].parent = inner[i];
            node.objects += nodes_[child].objects;
        }
        node.box = box_of_children(node);
        node.first_quality = quality(node);
    }
    const uint32_t new_top = node_of(topology.root);
    nodes_[new_top].parent = above;
    replace_child(above, top, new_top);
    tighten_above(above);
}

/// Makes the boxes of ancestors smaller, as far as anything changes. A box that stays as it is ends the
/// climb, since boxes above depend on nothing else.
void InsertionTree::tighten_above(uint32_t node) {
    for (; node != kNone; node = nodes_[node].parent) {
        const KeyBox box = box_of_children(nodes_[node]);
        if (same_box(box, nodes_[node].box)) return;
        nodes_[node].box = box;
        touch(node);
    }
}

/// Looks at nodes that the update has touched, and at no others: what it costs goes by what has moved.
void InsertionTree::dissolve_thinned() {
    if (!(options_.thinning > 0)) return;
    // What dissolving one changes is looked at in the next update.
    std::vector<uint32_t> touched = std::move(touched_);
    touched_.clear();
    std::sort(touched.begin(), touched.end());
    touched.erase(std::unique(touched.begin(), touched.end()), touched.end());
    for (const uint32_t at : touched) {
        const Node& node = nodes_[at];
        if (node.child[0] == kNone || node.parent == kNone) continue;  // free, or the root
        if (quality(node) > options_.thinning * node.first_quality) dissolve(at);
    }
}

/// Takes a node away; its children climb and are inserted again.
void InsertionTree::dissolve(uint32_t dissolved) {
    ++dissolved_;
    const std::array<uint32_t, 2> children = nodes_[dissolved].child;
    const uint32_t objects = nodes_[dissolved].objects;
    const uint32_t above = detach(dissolved);
    nodes_[dissolved] = {};
    free_.push_back(dissolved);
    for (const uint32_t child : children) nodes_[child].parent = kNone;
    // Both have left the ancestors as far as `to`; those above still count them.
    const uint32_t to = climb(above, nodes_[children[0]].box, objects);
    const uint32_t above_that = nodes_[to].parent;
    insert(children[0], to);
    uint32_t top = nodes_[to].parent == above_that ? to : nodes_[to].parent;
    const Node& second = nodes_[children[1]];
    if (!holds(nodes_[top].box, second.box)) top = climb(above_that, second.box, second.objects);
    const uint32_t above_top = nodes_[top].parent;
    insert(children[1], top);
    tighten_above(above_that);
    tighten_above(above_top);
}

double InsertionTree::expected_visits() const {
    if (root_ == kNone) return 0;
    double sum = 0;
    for (size_t node = objects_.boxes.size(); node < nodes_.size(); ++node)
        sum += static_cast<double>(half_area_of(nodes_[node].box));
    const auto root = static_cast<double>(half_area_of(nodes_[root_].box));
    return root > 0 ? sum / root : 0;
}

BuildStats InsertionTree::stats() const {
    BuildStats stats;
    stats.tree_bytes = sizeof(*this) + objects_.bytes() + nodes_.capacity() * sizeof(Node) +
                       (free_.capacity() + touched_.capacity()) * sizeof(uint32_t) +
                       waiting_.capacity() * sizeof(Waiting);
    stats.tree_nodes = nodes_.size();
    stats.tree_leaves = objects_.boxes.size();
    return stats;
}

std::string InsertionTree::contradiction() const {
    if (root_ == kNone) return nodes_.empty() ? "" : "there are nodes without a root";
    if (nodes_[root_].parent != kNone) return "the root has a parent";
    if (!free_.empty()) return "inner nodes are free";
    size_t reached = 0;
    std::vector<uint32_t> todo{root_};
    while (!todo.empty()) {
        const uint32_t at = todo.back();
        todo.pop_back();
        ++reached;
        const Node& node = nodes_[at];
        if (is_leaf(at)) {
            if (node.objects != 1 || !same_box(node.box, objects_.boxes[at]))
                return "a leaf is not its object";
            continue;
        }
        uint32_t below = 0;
        for (const uint32_t child : node.child) {
            if (nodes_[child].parent != at) return "a child has another parent";
            below += nodes_[child].objects;
            todo.push_back(child);
        }
        if (below != node.objects) return "a node counts other objects than it has";
        if (!same_box(node.box, box_of_children(node))) return "a node's box is not that of its children";
    }
    return reached == nodes_.size() ? "" : "not all nodes are in the tree";
}

}  // namespace trapeze
