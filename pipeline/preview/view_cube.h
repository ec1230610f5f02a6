/// A view of colours as a table, for a page that has no OpenColorIO.
#pragma once

#include <vector>

#include "core/colors/color_management.h"

namespace trapeze {

/// Of red, green and blue each, kSide values from 0 to kMost, by the logarithm: value v is at
/// log2(v / kToe + 1) / log2(kMost / kToe + 1) of the way.
struct ViewCube {
    static constexpr int kSide = 48;
    static constexpr float kToe = 1.0f / 1024, kMost = 64;
    /// What the display shows, red, green and blue by turns; of kSide^3 colours, red changing first.
    std::vector<float> rgb;
};

ViewCube bake_view(const ColorTransform& view);

}  // namespace trapeze
