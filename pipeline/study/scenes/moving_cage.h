/// Cages whose points move by themselves: skin that is animated by hand or by a formula.
#pragma once

#include <functional>

#include "pipeline/study/scenes/cage.h"
#include "pipeline/study/scenes/scenes.h"

namespace trapeze::scenes {

/// A cage at a time in seconds; it has the same faces at all times.
using CageAt = std::function<Cage(double time)>;

/// Writes a cage that moves around parameters.time while the shutter is open, for `shutter` seconds at motion
/// 1: as three poses, since points go along curves; as one where parameters.motion is 0.
void write_moving_cage(RibWriter& rib, const CageAt& cage_at, double shutter,
                       const SceneParameters& parameters);

/// A closed tube. `place` and `color` are asked for points by u in [0, 1], along it, and by the angle around.
struct Tube {
    int rings = 8;   ///< between its two poles
    int around = 8;  ///< points of a ring
    std::function<V3d(double u, double angle)> place, color;
};

void add_tube(Cage& cage, const Tube& tube);

/// Adds a ball as a cube of cells x cells faces a side; `place` is given unit vectors.
void add_ball(Cage& cage, int cells, const std::function<V3d(const V3d& direction)>& place,
              const std::function<V3d(const V3d& direction)>& color);

}  // namespace trapeze::scenes
