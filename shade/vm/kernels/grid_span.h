/// A grid's part of a batch of lanes.
#pragma once

#include <cstddef>
#include <cstdint>

#include "core/grid.h"
#include "core/math.h"
#include "core/random.h"
#include "core/scene/vertex_set.h"

namespace trapeze {
struct ShadingGrid;
}

namespace trapeze::vm {

/// Lanes first .. first + shape.vertex_count() - 1, row by row, u fastest. Spans of a batch stand in the
/// order of their lanes and leave no gap; only behind the last one may lanes be left over, up to a whole
/// vector.
struct GridSpan {
    size_t first = 0;
    GridShape shape;
    bool reverse_orientation = false;   ///< dPdu x dPdv points inside
    uint64_t seed = 0;                  ///< of random numbers: the grid's own
    int hit_vertex = -1;                ///< the one that asks for rays, for all of the grid; -1: each does
    V2f steps{0, 0};                    ///< where not 0, Du and Dv are differences along the axes over these
    const VertexSet* wanted = nullptr;  ///< the vertices that ask for rays; null: all
    const ShadingGrid* grid = nullptr;  ///< null where it is a piece, or there is none

    bool wants(size_t vertex) const { return !wanted || wanted->test(vertex); }
    /// A random word of the grid for each number [decision 0019].
    uint32_t word(uint32_t number) const {
        return hash(static_cast<uint32_t>(seed), static_cast<uint32_t>(seed >> 32), number);
    }
};

}  // namespace trapeze::vm
