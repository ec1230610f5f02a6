/// How finely faces are diced that need no split, many at once.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "tessellate/measure/line_measure.h"
#include "tessellate/topology/placed_surface.h"

namespace trapeze {

/// Segments that a face wants; 0 where that takes a closer look. It spares most small faces, hairs above all,
/// the walk through EdgeCutter and FaceSplitter.
struct FaceEstimate {
    std::array<uint8_t, 4> sides{};  ///< of lines along its sides, by SideName
    uint8_t nu = 0, nv = 0;          ///< of its interior; both or none
};

/// The estimates of a surface's faces, all that EdgeTessellations::add() and split_faces() would find for
/// their own whole lines and faces; empty where the surface has no lattices of many faces.
std::vector<FaceEstimate> estimate_faces(const PlacedSurface& surface, const LineMeasure& measure,
                                         const EdgeRate& rate);

/// The side of a face's unit square along which an edge runs upwards from end to end; -1: none.
int side_along(const EdgeLine& line);

}  // namespace trapeze
