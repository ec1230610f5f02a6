/// Neighbours among subpatches, put together into bricks: parts of space that are made and forgotten as a
/// whole [Christensen03].
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "accel/wide/extent_tree.h"

namespace trapeze {

/// Subpatches of one primitive whose numbers follow each other.
struct SubpatchRun {
    uint32_t first = 0, count = 1;
};

/// What is known of subpatches before their brick is made.
struct RunExtent {
    SubpatchRun run;
    uint32_t bytes;     ///< of their grids
    GridExtent extent;  ///< of them all
};

struct BrickDivision {
    std::vector<SubpatchRun> runs;    ///< brick after brick, each in the order of their numbers
    std::vector<uint32_t> first;      ///< of a brick's runs; one more than there are bricks
    std::vector<GridExtent> extents;  ///< of bricks
};

/// Bricks of at most so many bytes, but for runs that alone have more: what the surface area heuristic
/// keeps together longest. Those without bounds (RunExtent::extent) have bricks of their own. Deterministic,
/// whatever the number of threads and the order of the runs.
BrickDivision divide_into_bricks(const std::vector<RunExtent>& runs, size_t most_bytes);

}  // namespace trapeze
