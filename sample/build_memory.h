/// What visibility methods take while they are prepared, as is known before.
#pragma once

#include <algorithm>
#include <cstddef>

#include "core/grid.h"

namespace trapeze {

/// Upper estimates in bytes, beside the grids themselves, of what a method takes while it is prepared. They
/// are asked for before there are grids: pipeline/frame cuts the picture into regions so small that grids and
/// method fit the memory. By default: what a tree of a few bytes takes.
struct BuildMemory {
    size_t per_micropolygon = 0;
    size_t per_segment = 20;  ///< for each micropolygon and segment between motion keys, one at least
    size_t per_grid = 256;
    size_t fixed = 0;

    /// Of a grid, without what is fixed.
    size_t bytes(size_t micropolygons, int key_count) const {
        const auto segments = static_cast<size_t>(std::max(1, key_count - 1));
        return per_grid + micropolygons * (per_micropolygon + per_segment * segments);
    }
    /// Of all grids together.
    size_t bytes(const Grids& grids) const {
        size_t sum = fixed;
        for (const Grid& grid : grids.grids)
            sum += bytes(static_cast<size_t>(grid.shape.micropolygon_count()), grid.key_count);
        return sum;
    }
};

}  // namespace trapeze
