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
    /// For each micropolygon and segment of the grid that has most: trees whose nodes all have one number of
    /// keys.
    size_t per_most_segment = 0;

    /// Of a grid, without what is fixed, and per_most_segment.
    size_t bytes(size_t micropolygons, int key_count) const {
        return per_grid + micropolygons * (per_micropolygon + per_segment * segments(key_count));
    }
    /// What there is besides for so many micropolygons, no grid of which has more keys.
    size_t bytes_of_all(size_t micropolygons, int most_keys) const {
        return fixed + micropolygons * per_most_segment * segments(most_keys);
    }
    /// Of all grids together.
    size_t bytes(const Grids& grids) const {
        size_t sum = bytes_of_all(grids.micropolygon_count(), grids.max_key_count());
        for (const Grid& grid : grids.grids)
            sum += bytes(static_cast<size_t>(grid.shape.micropolygon_count()), grid.key_count);
        return sum;
    }

  private:
    static size_t segments(int key_count) { return static_cast<size_t>(std::max(1, key_count - 1)); }
};

}  // namespace trapeze
