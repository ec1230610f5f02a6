/// The binary tree over micropolygons at mid-shutter by the surface area heuristic, with spatial splits:
/// where a plane that cuts micropolygons costs less than parting them by their middles, a node is cut, and
/// both sides refer to what the plane goes through [Stich09].
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "accel/builders/sah_topology.h"
#include "accel/moving/lane_pose.h"
#include "accel/moving/micropolygon_parts.h"
#include "core/memory/large_pages.h"

namespace trapeze {

/// A reference to a micropolygon, or to the part of one that is in its box: an SahItem whose id says which.
struct PartId {
    static constexpr uint32_t kPart = uint32_t{1} << 31;

    static uint32_t index(uint32_t id) { return id & ~kPart; }
    static bool is_part(uint32_t id) { return id & kPart; }
};

/// The budget bounds memory: planes that cut much could else double the references at each level.
struct SpatialOptions {
    size_t leaf_below = 8;  ///< leaves have fewer references
    size_t budget = 0;      ///< references that splits may add in all; 0: no spatial splits
    bool tight = true;  ///< parts' boxes are those of their polygons; else what planes leave of the whole box
};

/// Leaf i has references leaf_first[i] to leaf_first[i + 1] - 1. What planes have cut is in several leaves.
struct SpatialTopology {
    TopTopology tree;                  ///< its leaves are numbered from left to right
    std::vector<uint32_t> leaf_first;  ///< leaf -> its first reference; one more than leaves
    UnsetVector<SahItem> references;   ///< in the order of leaves
    UnsetVector<LanePose> poses;       ///< of micropolygons at mid-shutter; none without a budget
    uint64_t splits = 0;               ///< nodes that a plane cuts
    bool lacked_budget = false;        ///< some node would have been cut, had there been more
    double work = 0, cut_work = 0;     ///< seconds of all threads: in all, and on planes that cut
};

/// `items`: a micropolygon each, as micropolygon_items() has them; the box of one that is a point is never
/// cut. They are sorted. Deterministic, whatever the number of threads: the budget is shared out from the
/// root down.
SpatialTopology build_spatial_topology(std::span<SahItem> items, const Grids& grids,
                                       const SpatialOptions& options);

}  // namespace trapeze
