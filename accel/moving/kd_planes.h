/// Which plane divides a node of the k-d tree for motion blur: the surface area heuristic over micropolygons
/// at one time of the shutter, each of which counts on a side as long as it is there [Yang17 sec. 3.1.1].
#pragma once

#include <cstdint>
#include <limits>
#include <span>

#include "accel/moving/kd_options.h"
#include "accel/moving/shutter_span.h"
#include "accel/moving/swept_boxes.h"

namespace trapeze {

/// A micropolygon in a cell, and when it is there.
struct KdReference {
    Box3f box;          ///< of what is in the cell of its pose, at pose_time(when)
    uint32_t item = 0;  ///< of SweptBoxes
    ShutterSpan when;
    /// It is not in the cell at the time for which planes are chosen, and came across the plane that bounds
    /// the cell: of the BP_node, not of the Normal_node, in the paper's words.
    bool guest = false;
};

/// A plane, and what a node costs that it divides; the cost is infinite if there is none.
struct KdPlane {
    double cost = std::numeric_limits<double>::infinity();
    int axis = 0;
    float at = 0;
};

/// What those who vote say of a node: its best plane, and what it costs as a leaf.
struct KdVote {
    KdPlane best;
    double leaf_cost = 0;
};

/// Chooses planes for nodes. Costs are tests of a micropolygon.
class KdPlanes {
  public:
    KdPlanes(const SweptBoxes& boxes, const KdTreeOptions& options) : boxes_(boxes), options_(options) {}

    /// The best of some planes along each axis, all strictly within the cell. The same whatever the number of
    /// threads. Guests do not vote, but where they are more than the others.
    KdVote vote(std::span<const KdReference> references, const Box3f& cell) const;

    /// When in its span a micropolygon's pose decides where it belongs: the plane time, or what is nearest.
    float pose_time(const ShutterSpan& when) const;

  private:
    template <size_t kMost>
    KdPlane best_plane(std::span<const KdReference> references, const Box3f& cell, const Box3f& extent,
                       bool guests_too, size_t slabs) const;

    const SweptBoxes& boxes_;
    const KdTreeOptions& options_;
};

}  // namespace trapeze
