/// The k-d tree for motion blur [Yang17]: cells of space, and in those that are leaves the micropolygons that
/// are there at some time of the shutter, with the time in which they are.
///
/// A micropolygon that crosses a plane while it moves is duplicated: it is a resident of the side on which it
/// is at the plane time, and a guest of the other (the paper's Normal_node and BP_node, figure 3). Guests do
/// not vote for planes. Further down the same cases decide on which sides they are (the six cases of the
/// propagation), and whether they vote there is an option: so a guest is not a list of its own but a mark,
/// which leaves do not keep.
#pragma once

#include <cstdint>
#include <vector>

#include "accel/moving/kd_options.h"
#include "accel/moving/kd_planes.h"
#include "accel/moving/swept_boxes.h"

namespace trapeze {

/// Nodes of the k-d tree are at most so many levels below the root.
inline constexpr int kKdDepthLimit = 64;

/// A node: a plane and where its children are, or the number of a leaf.
struct KdNode {
    static constexpr uint32_t kLeaf = 3;

    float plane = 0;
    uint32_t bits = kLeaf;  ///< the axis, or kLeaf; above, four times the lower child, or the leaf

    static KdNode inner(int axis, float plane, uint32_t low) {
        return {plane, low << 2 | static_cast<uint32_t>(axis)};
    }
    static KdNode leaf(uint32_t number) { return {0, number << 2 | kLeaf}; }
    bool is_leaf() const { return (bits & kLeaf) == kLeaf; }
    int axis() const { return static_cast<int>(bits & 3); }
    /// The lower child; the upper one follows it. Or the number of the leaf.
    uint32_t index() const { return bits >> 2; }
};

/// What build_kd_topology() makes: the two children of a node stand side by side, and a leaf is a range of
/// `references`.
struct KdTopology {
    Box3f box;                         ///< of all micropolygons at all times
    std::vector<KdNode> nodes;         ///< the root first; none without micropolygons
    std::vector<uint32_t> leaf_first;  ///< leaf -> its first reference; one more than leaves
    std::vector<KdReference> references;
    /// Duplicates that planes made because something moves across them, and how many micropolygons do.
    uint64_t guests = 0, incoherent = 0;
    bool lacked_budget = false;  ///< some node would have been divided, had there been more
    double work = 0;             ///< seconds of all threads, in all
    double part_work = 0;        ///< of these, on putting references on sides, where they are duplicated
};

/// Of everything in `boxes`. Deterministic, whatever the number of threads: the budget is shared out from the
/// root down. At most 2^30 nodes.
KdTopology build_kd_topology(const Grids& grids, const SweptBoxes& boxes, const KdTreeOptions& options);

}  // namespace trapeze
