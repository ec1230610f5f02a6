/// Grids that threads have made, each with memory of its own, as those of a region.
#pragma once

#include <tbb/parallel_sort.h>

#include <utility>

#include "core/grid.h"

namespace trapeze {

/// In the order of their ordinals. Makers have `grids` and the `arena` that these are in, which is taken.
template <class Makers>
Grids collect_grids(Makers& makers) {
    Grids all;
    for (auto& maker : makers) {
        all.grids.insert(all.grids.end(), maker.grids.begin(), maker.grids.end());
        all.arenas.push_back(std::move(maker.arena));
    }
    tbb::parallel_sort(all.grids.begin(), all.grids.end(),
                       [](const Grid& a, const Grid& b) { return a.ordinal < b.ordinal; });
    return all;
}

}  // namespace trapeze
