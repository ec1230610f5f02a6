#include "accel/builders/grid_pose.h"

#include <limits>

#include "accel/builders/grid_summary.h"

namespace trapeze {
namespace {

using Lanes = GridPose::Lanes;

/// Four vertices of a tile's row along one axis, and so the next ones, at a key: as KeyVertices has them.
Lanes at_key(const float* start, const float* delta) {
    Lanes at;
    std::memcpy(&at, start, sizeof at);
    if (delta) {
        Lanes moved;
        std::memcpy(&moved, delta, sizeof moved);
        at += moved;
    }
    return at;
}

}  // namespace

float GridPose::read(const Grid& grid, int key) {
    shape_ = grid.shape;
    const bool at_end = grid.moves() && key == grid.key_count - 1;
    const int segment = at_end ? key - 1 : key;
    // Coordinates without their signs; lanes past the last column repeat it.
    Lanes largest{};
    auto bounded = largest == largest;
    for (int j = 0; j <= shape_.nv; ++j)
        for (int i = 0; i <= shape_.nu; i += 4) {
            const int at = shape_.tiled_index(i, j);
            Lanes p[3];
            for (int k = 0; k < 3; ++k) {
                p[k] =
                    at_key(grid.plane(segment, k) + at, at_end ? grid.plane(segment, 3 + k) + at : nullptr);
                const Lanes size = p[k] < 0 ? -p[k] : p[k];
                // So that a NaN is as little to be bounded as what is too large.
                bounded &= size <= kBoundableCoordinate;
                largest = most(size, largest);
            }
            Lanes* const to = vertices_ + j * kRow + i;
            const Lanes xy_low = __builtin_shufflevector(p[0], p[1], 0, 4, 1, 5);
            const Lanes xy_high = __builtin_shufflevector(p[0], p[1], 2, 6, 3, 7);
            const Lanes zz_low = __builtin_shufflevector(p[2], p[2], 0, 0, 1, 1);
            const Lanes zz_high = __builtin_shufflevector(p[2], p[2], 2, 2, 3, 3);
            to[0] = __builtin_shufflevector(xy_low, zz_low, 0, 1, 4, 5);
            to[1] = __builtin_shufflevector(xy_low, zz_low, 2, 3, 6, 7);
            to[2] = __builtin_shufflevector(xy_high, zz_high, 0, 1, 4, 5);
            to[3] = __builtin_shufflevector(xy_high, zz_high, 2, 3, 6, 7);
        }
    float of_all = 0;
    for (int lane = 0; lane < 4; ++lane) {
        if (!bounded[lane]) return std::numeric_limits<float>::infinity();
        of_all = std::max(of_all, largest[lane]);
    }
    return of_all;
}

}  // namespace trapeze
