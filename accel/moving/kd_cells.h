/// When a moving micropolygon reaches into a cell: closer than its box can tell, as of a hair that runs
/// across many cells and whose box fills them.
#pragma once

#include <array>

#include "accel/moving/shutter_span.h"
#include "core/grid.h"

namespace trapeze {

/// A micropolygon along axes that may tell it from a cell: those of its plane and of its edges with the axes
/// of space, as they are at `pose_time`. Any fixed axis tells the truth while things move, these tell most.
/// For coordinates within kBoundableCoordinate.
class SeparatingAxes {
  public:
    SeparatingAxes(const Grid& grid, const MicropolygonId& id, float pose_time);

    /// The shortest span of `within` that the axes can tell to hold all times at which the micropolygon
    /// reaches into the cell.
    ShutterSpan when_in_cell(const Box3f& cell, ShutterSpan within) const;

  private:
    struct Axis {
        V3f unit;
        std::array<float, kMaxKeyCount> low, high;  ///< of the micropolygon, a key
    };
    size_t keys_ = 0, count_ = 0;
    float largest_ = 0;  ///< coordinate of the micropolygon
    std::array<Axis, 7> axes_;
};

}  // namespace trapeze
