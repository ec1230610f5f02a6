/// Neighbours among subpatches, put together into bricks: parts of space that are made and forgotten as a
/// whole [Christensen03].
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "accel/wide/extent_tree.h"

namespace trapeze {

/// What is known of a subpatch before its brick is made.
struct SubpatchExtent {
    uint32_t subpatch;
    uint32_t bytes;  ///< of its grid
    GridExtent extent;
};

struct BrickDivision {
    std::vector<uint32_t> subpatches;  ///< brick after brick, each in the order of their numbers
    std::vector<uint32_t> first;       ///< of a brick's subpatches; one more than there are bricks
    std::vector<GridExtent> extents;   ///< of bricks
};

/// Bricks of at most so many bytes, but for subpatches that alone have more: what the surface area heuristic
/// keeps together longest. Those without bounds (SubpatchExtent::extent) have bricks of their own.
/// Deterministic, whatever the number of threads and the order of the subpatches.
BrickDivision divide_into_bricks(const std::vector<SubpatchExtent>& subpatches, size_t most_bytes);

}  // namespace trapeze
