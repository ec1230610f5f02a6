/// The binary tree that objects are inserted into one by one, where the surfaces of the nodes on their way
/// grow least [Goldsmith87], and which is updated from frame to frame instead of rebuilt: "Dynamic
/// Goldsmith-Salmon" [DynBvh06 sec. 3.1].
///
/// Departs from the papers: nodes have two children; leaves are micropolygons, of which each is an object, in
/// boxes of the whole shutter.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "accel/dynamic/frame_boxes.h"
#include "accel/dynamic/pending_visits.h"

namespace trapeze {

/// How an InsertionTree is kept.
struct InsertionOptions {
    /// How often all objects are inserted again when the tree is built: the first ones were inserted when
    /// there was little to choose from.
    int passes = 0;
    /// A node whose surface for each object below it has become more than this times what it was when the
    /// node was made is dissolved, and its children are inserted again; 0: none is.
    float thinning = 0;
    /// In which order objects are inserted. The papers leave that open; as they are given they lie in rows
    /// beside each other, and the tree becomes a list where each makes what is there grow by little: long
    /// walls of a building, of which a million take hours.
    enum class Order { Shuffled, Given } order = Order::Shuffled;
    /// Where an object that has moved is inserted again.
    enum class Reinsertion {
        Ancestor,  ///< below the nearest ancestor that holds its new box [DynBvh06 algorithm 1]
        Root,      ///< from the root, as any other [Goldsmith87]
        /// Nowhere yet: all below that ancestor is built anew when all have moved, by the surface area
        /// heuristic [DynBvh06 sec. 3.1 proposes to mark and rebuild].
        Rebuilt
    } reinsertion = Reinsertion::Ancestor;
};

/// Objects are those of FrameBoxes: leaf i is object i, so that one that moves is found without a search.
/// Frames are read by many threads, the tree is changed by one; rays may be traced from many while it stays.
class InsertionTree {
  public:
    explicit InsertionTree(const InsertionOptions& options = {}) : options_(options) {}

    /// Forgets what there was, and inserts all objects of a frame. Keeps a reference to the grids, as
    /// update() does.
    void build(const Grids& grids);

    /// Moves the objects whose boxes have changed: each climbs to the nearest ancestor that holds its new
    /// box, and is inserted again from there (algorithm 1). A frame with another number of objects is built.
    void update(const Grids& grids);
    /// The same where only these grids, by number, differ from the frame before: in time linear in what
    /// moves.
    void update(const Grids& grids, std::span<const uint32_t> changed);

    /// Shows the policy the hits of a ray, near ones first as far as boxes tell.
    template <class Policy>
    void trace(TraceRay& ray, Policy& policy, SampleStats& stats) const;

    BuildStats stats() const;
    /// What the surface area heuristic says of the tree: nodes that a ray through the root's box visits.
    double expected_visits() const;

    /// Objects that were inserted again, and nodes that were dissolved, by the last update.
    uint64_t moved() const { return moved_; }
    uint64_t dissolved() const { return dissolved_; }
    /// Objects below nodes that the last update has built anew.
    uint64_t rebuilt() const { return rebuilt_; }

    /// What must always hold; for tests. Empty: it does.
    std::string contradiction() const;

  private:
    static constexpr uint32_t kNone = ~uint32_t{0};

    /// The first nodes are the leaves: leaf i is object i.
    struct alignas(16) Node {
        KeyBox box;
        uint32_t parent = kNone;
        std::array<uint32_t, 2> child{kNone, kNone};
        uint32_t objects = 1;  ///< below it
        float first_quality = 0;
    };

    /// An object that is in no tree until all below a node is built anew.
    struct Waiting {
        uint32_t object, at;
    };

    bool is_leaf(uint32_t node) const { return node < objects_.boxes.size(); }
    /// [DynBvh06 eq. 1]
    float quality(const Node& node) const {
        return half_area_of(node.box) / static_cast<float>(node.objects);
    }
    /// Of the objects as they have been read.
    void insert_all();
    std::vector<uint32_t> insertion_order() const;
    void reset();
    void move_if_changed(uint32_t object);
    void move(uint32_t object, const KeyBox& box);
    void dissolve_thinned();
    void dissolve(uint32_t node);
    uint32_t detach(uint32_t node);
    uint32_t climb(uint32_t from, const KeyBox& box, uint32_t objects);
    uint32_t best_sibling(const KeyBox& box, uint32_t from) const;
    void insert(uint32_t node, uint32_t from);
    void pair_up(uint32_t inserted, uint32_t at);
    void finish_update();
    void rebuild_marked();
    void rebuild_below(uint32_t top, std::vector<uint32_t> objects);
    void tighten_above(uint32_t node);
    void replace_child(uint32_t parent, uint32_t old_child, uint32_t new_child);
    KeyBox box_of_children(const Node& node) const {
        return joined(nodes_[node.child[0]].box, nodes_[node.child[1]].box);
    }
    /// Remembers a node whose quality has changed for dissolve_thinned(). Not while all objects are inserted:
    /// qualities are taken anew after that.
    void touch(uint32_t node) {
        if (options_.thinning > 0 && !inserting_all_) touched_.push_back(node);
    }

    InsertionOptions options_;
    FrameBoxes objects_;
    std::vector<Node> nodes_;
    std::vector<uint32_t> free_;     ///< inner nodes that are in no tree
    std::vector<uint32_t> touched_;  ///< inner nodes whose quality has changed, some of them several times
    uint32_t root_ = kNone;
    bool inserting_all_ = false;
    std::vector<Waiting> waiting_;
    uint64_t moved_ = 0, dissolved_ = 0, rebuilt_ = 0;
};

template <class Policy>
void InsertionTree::trace(TraceRay& ray, Policy& policy, SampleStats& stats) const {
    ++stats.rays;
    objects_.test_unbounded(ray, policy, stats);
    if (root_ == kNone) return;
    PendingVisits visits(ray, objects_);
    visits.push(root_, nodes_[root_].box);
    for (uint32_t at; visits.pop(at);) {
        if (is_leaf(at)) {
            ++stats.leaves_visited;
            objects_.test_object(at, ray, policy, stats);
            continue;
        }
        ++stats.nodes_visited;
        const auto& [first, second] = nodes_[at].child;
        visits.push(first, nodes_[first].box, second, nodes_[second].box);
    }
}

}  // namespace trapeze
