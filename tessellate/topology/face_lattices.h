/// Points of several faces at once, by which they are measured. Lanes are faces.
#pragma once

#include <cstdint>

#include "core/math.h"

namespace trapeze {

/// Points at v = row / 8 and u = column / 4, all in object space at the first shape key; rows of odd number
/// have the outer columns alone. Nine rows along v and five columns along u: ribbons are long in v.
struct FaceLattices {
    static constexpr int kFaces = 16, kRows = 9, kColumns = 5;

    alignas(64) float P[kRows][kColumns][3][kFaces];
    uint32_t there = 0;  ///< the faces that have points, a bit each

    static V2f uv(int row, int column) {
        return {static_cast<float>(column) / (kColumns - 1), static_cast<float>(row) / (kRows - 1)};
    }
    static constexpr bool has(int row, int column) {
        return row % 2 == 0 || column == 0 || column == kColumns - 1;
    }
};

}  // namespace trapeze
