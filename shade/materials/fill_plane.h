/// A plane of a primitive variable, for the lanes of a run.
#pragma once

#include <algorithm>
#include <span>

#include "core/scene/shading_grid.h"

namespace trapeze {

/// Fills the plane with plane p of a variable of each grid, one after the other; `variable_of` finds it, or
/// gives null where a grid has none, and the fallback is taken. Lanes behind the last vertex are like that.
template <typename VariableOf>
void fill_plane(std::span<const ShadingGrid* const> grids, const VariableOf& variable_of, size_t p,
                float fallback, std::span<float> to) {
    size_t at = 0;
    for (const ShadingGrid* grid : grids) {
        const GridVariable* const own = variable_of(*grid);
        const size_t count = grid->vertex_count();
        if (!own || own->uniform || own->planes[p].size() < count)
            std::fill_n(to.begin() + static_cast<std::ptrdiff_t>(at), count,
                        own ? own->planes[p].front() : fallback);
        else
            std::copy_n(own->planes[p].begin(), count, to.begin() + static_cast<std::ptrdiff_t>(at));
        at += count;
    }
    std::fill(to.begin() + static_cast<std::ptrdiff_t>(at), to.end(), at ? to[at - 1] : 0.0f);
}

}  // namespace trapeze
