/// How finely faces are diced that need no split, many at once.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "tessellate/measure/flat_faces.h"
#include "tessellate/measure/line_measure.h"
#include "tessellate/vertex_table.h"

namespace trapeze {

/// Segments that a face wants; 0 where that takes a closer look. It spares most small faces, hairs above all,
/// the walk through EdgeCutter and FaceSplitter.
struct FaceEstimate {
    std::array<uint8_t, 4> sides{};     ///< of edges along its sides, by SideName
    FaceRuns runs = FaceRuns::Upwards;  ///< how those edges run
    uint8_t nu = 0, nv = 0;             ///< of its interior; both or none
    bool bounded = false;               ///< `bound` is there
    Box3f bound;                        ///< Surface::bound() of the whole face, at all keys alike

    /// Segments of an edge that is evaluated on the face; 0 where that takes a closer look.
    uint8_t segments_of(const EdgeLine& line) const;
};

/// The estimates of a surface's faces, all that EdgeTessellations::add() and split_faces() would find for
/// their own whole lines and faces; empty where the surface has no lattices of many faces or few faces, where
/// the view is orthographic, and where shapes are mixed at keys that are looked at. `vertices` takes those
/// that are met on the way.
std::vector<FaceEstimate> estimate_faces(const PlacedSurface& surface, const LineMeasure& measure,
                                         const EdgeRate& rate, VertexTableMaker& vertices);

/// Has estimates keep to what flat cuts want: faces that want more get none for their interior.
void cut_estimates(const PlacedSurface& surface, const FlatCuts& cuts, std::span<FaceEstimate> estimates);

}  // namespace trapeze
