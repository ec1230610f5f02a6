/// A street along the z axis at dusk, for cars to drive on: lanes, barriers, lamps, traffic lights, a town.
#pragma once

#include "pipeline/study/scenes/car_model.h"

namespace trapeze::scenes {

/// Where things are along x, in metres: the mark between the lanes, the road's edge, the barrier between the
/// directions, the far wall.
inline constexpr double kLaneMark = 1.75, kRoadEdge = -1.95, kBarrier = 5.9, kFarWall = 15.2;

/// Asphalt, a little wet.
inline const Plastic kRoad = {{.052, .053, .057}, .9, .45, .16};

/// Writes what streams past, all of it at rest in the current space.
void write_street(RibWriter& rib);

/// Writes what is too far away to be seen moving: the sky, and the town's outline with its windows.
void write_horizon(RibWriter& rib);

}  // namespace trapeze::scenes
