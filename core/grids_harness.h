/// Synthetic grids for tests and benchmarks.
#pragma once

#include <algorithm>
#include <functional>

#include "core/grid.h"

namespace trapeze::testing {

/// Where vertex (i, j) is at time 0..1.
using Surface = std::function<V3f(int i, int j, float time01)>;

/// Collects grids as the packing stage would leave them: tiled, padded, deltas between keys.
class GridMaker {
  public:
    Grid& add(int nu, int nv, int key_count, const Surface& surface) {
        if (grids_.arenas.empty()) grids_.arenas.emplace_back();
        Grid grid;
        grid.shape = {static_cast<uint8_t>(nu), static_cast<uint8_t>(nv)};
        grid.key_count = static_cast<uint8_t>(key_count);
        grid.ordinal = grids_.grids.size();
        grid.opaque = opaque;
        grid.facing = facing;
        grids_.arenas.back().allocate(grid);
        std::fill_n(grid.half_colors(), grid.color_count(), Imath::half(1.0f));
        for (int segment = 0; segment < segment_count(key_count); ++segment)
            for (int tv = 0; tv < grid.shape.tiles_v() * 4; ++tv)
                for (int tu = 0; tu < grid.shape.tiles_u() * 4; ++tu) {
                    const int i = std::min(tu, nu), j = std::min(tv, nv), at = grid.shape.tiled_index(tu, tv);
                    const V3f from = surface(i, j, time_of_key(segment, key_count));
                    const V3f to = surface(i, j, time_of_key(segment + 1, key_count));
                    for (int k = 0; k < 3; ++k) {
                        grid.plane(segment, k)[at] = from[k];
                        if (grid.moves()) grid.plane(segment, 3 + k)[at] = to[k] - from[k];
                    }
                }
        grids_.grids.push_back(grid);
        return grids_.grids.back();
    }

    bool opaque = true;  ///< of the next grids
    Facing facing = Facing::Both;

    const Grids& grids() const { return grids_; }
    Grids& grids() { return grids_; }

  private:
    static float time_of_key(int key, int key_count) {
        return key_count == 1 ? 0.0f : static_cast<float>(key) / static_cast<float>(key_count - 1);
    }

    Grids grids_;
};

}  // namespace trapeze::testing
