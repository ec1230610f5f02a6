/// The binary tree over micropolygons in the order of their Morton codes [Morton66], divided where the codes'
/// highest differing bit changes [Lauterbach09]: built in the time of a sort, whatever it costs rays.
#pragma once

#include <span>

#include "accel/moving/spatial_topology.h"

namespace trapeze {

/// `items`: a micropolygon each. Codes have 18 bits an axis of the centroids' box at mid-shutter; what has
/// one code is halved in the order of ids. Leaves have fewer references than `leaf_below`, at least 2.
/// Deterministic, whatever the number of threads.
SpatialTopology build_linear_topology(std::span<const SahItem> items, size_t leaf_below);

}  // namespace trapeze
