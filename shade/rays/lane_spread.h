/// How much wider rays of one direction grow: as far as those of the vertices beside it go apart [Igehy99].
#pragma once

#include <algorithm>

#include "core/math.h"
#include "core/scene/shading_grid.h"
#include "shade/rays/ray_asker.h"

namespace trapeze {

/// RaySegment::spread of a lane's ray that goes along `direction`. Of other lanes direction_of(lane) tells;
/// those for which it is no unit vector send no ray.
template <class DirectionOf>
float spread_beside(const RayLane& asking, const V3f& direction, const DirectionOf& direction_of) {
    if (!asking.grid) return 0;
    const GridShape shape = asking.grid->shape;
    const size_t vertex = asking.lane - asking.first_of_grid, row = size_t{shape.nu} + 1;
    const size_t u = vertex % row, v = vertex / row;
    float most = 0;
    const auto look_at = [&](size_t beside) {
        const V3f other = direction_of(asking.first_of_grid + beside);
        if (other.length2() > 0.5f) most = std::max(most, (other - direction).length());
    };
    if (u > 0) look_at(vertex - 1);
    if (u < shape.nu) look_at(vertex + 1);
    if (v > 0) look_at(vertex - row);
    if (v < shape.nv) look_at(vertex + row);
    return most;
}

}  // namespace trapeze
