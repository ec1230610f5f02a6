/// The binary tree over micropolygons in the order of their Morton codes [Morton66], divided where the codes'
/// highest differing bit changes [Lauterbach09]: built in the time of a sort, whatever it costs rays.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "accel/builders/sah_topology.h"
#include "core/memory/large_pages.h"

namespace trapeze {

/// A topology over names of items: the items themselves stay where they are.
struct LinearTopology {
    TopTopology tree;                  ///< its leaves are numbered from left to right
    std::vector<uint32_t> leaf_first;  ///< leaf -> its first item; one more than leaves
    UnsetVector<uint32_t> items;       ///< in the order of leaves; of one leaf in their own
};

/// `centroids`: of items at mid-shutter, all finite, in `box`. Codes have 18 bits an axis of it; what has one
/// code is halved in the order of items. Leaves have fewer items than `leaf_below`, at least 2. `names`: of
/// items, in rising order; without them their numbers. Deterministic, whatever the number of threads.
LinearTopology build_linear_topology(std::span<const V3f> centroids, const Box3f& box, size_t leaf_below,
                                     std::span<const uint32_t> names = {});

}  // namespace trapeze
