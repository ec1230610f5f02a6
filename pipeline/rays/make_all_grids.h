/// Makes all grids that rays meet once, to keep them or to know where they are.
#pragma once

#include <vector>

#include "pipeline/rays/ray_bricks.h"
#include "pipeline/rays/ray_dicer.h"

namespace trapeze {

/// What came of it.
struct AllRayGrids {
    bool are_kept = true;            ///< all are in `grids`; else none is, and `extents` are known
    std::vector<Grid> grids;         ///< in the order of subpatches
    std::vector<GridArena> arenas;   ///< their memory
    std::vector<RunExtent> extents;  ///< of all, in the order of subpatches
};

/// In parallel, alike for any number of threads. Grids are kept where all together take `most_bytes` at most.
/// Only some of it, when the render is cancelled.
AllRayGrids make_all_grids(const RayDicer& dicer, size_t most_bytes);

}  // namespace trapeze
