/// The levels of the paper's tree above grids: a binary tree of hyper-trapezoids, oriented or axis-aligned,
/// whose leaves are grids. (The leaves of a MicropolygonTree are lists of micropolygons.)
#pragma once

#include <array>
#include <memory>
#include <vector>

#include "accel/builders/sah_topology.h"
#include "accel/paper/beam.h"
#include "accel/ray_tree.h"
#include "accel/slabs.h"
#include "core/memory/large_pages.h"
#include "core/motion_keys.h"

namespace trapeze {

/// Nodes, and their boxes at all keys, in arrays beside each other. A plain value: a beam's part of it is
/// another TopLevel, traversed in the same way.
struct TopLevel {
    /// A node as its parent sees it, with key_count boxes.
    struct alignas(16) Node {
        float absolute_max = 0;  ///< largest coordinate of any grid below
        float quad_extent = 0;   ///< size of the largest micropolygon below
        TopLink link;
        uint32_t axes = 0;  ///< which of `axes_sets` its boxes are in
    };

    int key_count = 1;
    bool oriented = true;
    std::vector<Node, LargePages<Node>>
        nodes;  ///< children of inner node i at 2 i and 2 i + 1; the root last; none without grids
    /// A view keeps the rays that it has turned lately, for nodes that share axes: a node has those of one
    /// of its children.
    bool keeps_turned_rays = false;
    /// That nodes have; null unless oriented. Shared by the parts of a tree.
    std::shared_ptr<const std::vector<AxesColumns>> axes_sets;
    /// key_count boxes a node, in its axes.
    UnsetVector<KeyBox> boxes;

    /// What a node's boxes are coordinates of.
    const AxesColumns& axes_of(size_t node) const {
        return oriented ? (*axes_sets)[nodes[node].axes] : kAxes;
    }
    /// A node's boxes at keys 0 .. key_count - 1.
    const KeyBox* boxes_of(size_t node) const { return boxes.data() + node * key_count; }
    size_t bytes() const {
        return nodes.capacity() * sizeof(Node) +
               (axes_sets ? axes_sets->capacity() * sizeof(AxesColumns) : 0) +
               boxes.capacity() * sizeof(KeyBox);
    }

    /// The part of the tree that a beam may meet, into a tree whose memory is reused. An inner node of which
    /// one child is left gives way to it. Adds the nodes looked at to *looked_at.
    void within(const Beam& beam, TopLevel& part, uint64_t* looked_at) const;

  private:
    /// The axes of space, those of all nodes of an axis-aligned tree.
    inline static const AxesColumns kAxes{Axes{}};
};

/// A TopLevel prepared for one ray: its motion segment is found once, and, where all boxes are axis-aligned,
/// its directions are inverted once. A RayTree whose leaves are indices of grids.
class TopLevelView {
  public:
    static constexpr int kStackSize = kTopDepthLimit + 2;

    TopLevelView(const TopLevel& tree, const TraceRay& ray)
        : tree_(tree),
          axes_sets_(tree.axes_sets ? tree.axes_sets->data() : nullptr),
          segment_(segment_at(ray.axis.time, tree.key_count)) {
        if (!tree.oriented) along_axes_ = RayInAxes(ray);
        if (tree.keeps_turned_rays)
            for (Turned& held : turned_) held.axes = kNoAxes;
    }

    /// The root, if the ray may hit something in it; nothing in an empty tree.
    Visits enter(const TraceRay& ray) const;
    Visits step(const Visit& at, const TraceRay& ray) const;
    bool is_leaf(uint32_t node) const { return TopLink{node}.is_leaf(); }
    uint32_t leaf(uint32_t node) const { return TopLink{node}.index(); }

    /// The ray as all boxes of an axis-aligned tree see it; null of an oriented one.
    const RayInAxes* along_axes() const { return tree_.oriented ? nullptr : &along_axes_; }

  private:
    bool meet(size_t index, const TraceRay& ray, Visit& visit) const;
    const RayInAxes& turned(uint32_t axes, const TraceRay& ray) const;

    static constexpr uint32_t kNoAxes = ~uint32_t{0};
    static constexpr size_t kKept = 8;
    /// The ray in some axes.
    struct Turned {
        RayInAxes ray;
        uint32_t axes;
    };

    const TopLevel& tree_;
    const AxesColumns* axes_sets_;
    MotionSegment segment_;
    RayInAxes along_axes_;
    mutable std::array<Turned, kKept> turned_;  ///< each set of axes has one place
};

}  // namespace trapeze
