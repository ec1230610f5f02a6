/// One micropolygon over the whole shutter, and the vector code that tests rays against it.
#pragma once

#include <cstddef>
#include <cstdint>

#include "core/grid.h"

namespace trapeze {

/// Corners of a micropolygon in each motion segment: where they start and how far they go.
struct MovingQuad {
    int key_count = 1;
    Facing facing = Facing::Both;
    float start[3][4][kMaxKeyCount - 1];  ///< component, corner, segment
    float delta[3][4][kMaxKeyCount - 1];

    /// Copies the corners of micropolygon (u, v) of a grid: 00, 10, 01, 11, camera space. Without motion
    /// there is one segment, whose delta is 0.
    MovingQuad(const Grid& grid, int u, int v);
};

/// Camera rays (oz is 0) in planes, each readable kRayPadding floats past its end.
struct RayPlanes {
    const float *ox, *oy, *ux, *uy, *time;
};
/// At least the floats of the longest vector of any instruction set.
inline constexpr size_t kRayPadding = 64;

/// Tests rays first .. first + count - 1; lists those that hit, ascending, with their depths. Returns how
/// many. Runs on the best instruction set at hand.
size_t find_hits(const RayPlanes& rays, size_t first, size_t count, const MovingQuad& quad, uint32_t* found,
                 float* depth);

}  // namespace trapeze
