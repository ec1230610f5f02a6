/// What a ray of a lane stands for: the rays up to those that the vertices beside it would send [Igehy99].
#pragma once

#include <array>
#include <optional>

#include "core/math.h"
#include "core/ray_footprint.h"
#include "core/scene/shading_grid.h"
#include "shade/rays/ray_aim.h"
#include "shade/rays/ray_asker.h"
#include "shade/vm/footprint.h"

namespace trapeze {

/// Of a lane's ray that goes along `aim`. aim_of(lane) tells where another lane's goes, if anywhere. The rays
/// beside it are those at the ends of the axes of the vertex' footprint; without `footprints`, those of the
/// next vertices. They are not known where these send none.
template <class AimOf>
RayFootprint footprint_of(const RayLane& asking, const RayAim& aim, vm::Footprints* footprints,
                          const AimOf& aim_of) {
    RayFootprint ray;
    if (!asking.grid) return ray;
    const GridShape shape = asking.grid->shape;
    const size_t vertex = asking.lane - asking.first_of_grid, row = size_t{shape.nu} + 1;
    const std::array<size_t, 2> at{vertex % row, vertex / row}, last{shape.nu, shape.nv}, next{1, row};
    std::array<V3f, 2> origin, direction;
    for (size_t k = 0; k < 2; ++k) {
        const bool is_last = at[k] == last[k];
        if (is_last && at[k] == 0) return ray;
        const std::optional<RayAim> other = aim_of(is_last ? asking.lane - next[k] : asking.lane + next[k]);
        if (!other || !other->leads()) return ray;
        const float sign = is_last ? -1.0f : 1.0f;
        origin[k] = (other->P - aim.P) * sign, direction[k] = (other->direction - aim.direction) * sign;
    }
    float uu = 1, uv = 0, vv = 1;
    if (footprints) {
        const vm::Footprint& of = footprints->get();
        uu = of.uu[asking.lane], uv = of.uv[asking.lane], vv = of.vv[asking.lane];
    }
    ray.origin = {origin[0] * uu + origin[1] * uv, origin[0] * uv + origin[1] * vv};
    ray.direction = {direction[0] * uu + direction[1] * uv, direction[0] * uv + direction[1] * vv};
    return ray;
}

}  // namespace trapeze
