#include "tessellate/out_of_view.h"

#include <algorithm>
#include <cmath>
#include <vector>

namespace trapeze {
namespace {

/// A box, at a key, of a face and of the edges of which its sides are parts: a corner within an edge may lie
/// anywhere on it. Empty where no sure bound is known.
Box3f bound_with_edges(const PlacedSurface& placed, int face, int key) {
    const Surface& surface = placed.surface();
    Box3f box = placed.bound(face, {0, 0}, {1, 1}, key);
    if (box.isEmpty()) return box;
    for (const SurfaceSide& side : surface.sides(face)) {
        if (std::min(side.begin, side.end) == 0 && std::max(side.begin, side.end) == 1) continue;
        const EdgeLine line = surface.edge(side.edge);
        const auto [low_u, high_u] = std::minmax(line.from.x, line.to.x);
        const auto [low_v, high_v] = std::minmax(line.from.y, line.to.y);
        const Box3f edge = placed.bound(line.face, {low_u, low_v}, {high_u, high_v}, key);
        if (edge.isEmpty()) return edge;
        box.extendBy(edge);
    }
    return box;
}

}  // namespace

/// Each face is bounded at all keys together: it may pass through the picture between two that are both
/// outside.
bool is_out_of_view(const PlacedSurface& placed, const RasterBound& raster, float displacement_bound,
                    float farthest) {
    std::vector<Box3f> boxes(static_cast<size_t>(placed.key_count()));
    for (int face = 0; face < placed.surface().face_count(); ++face) {
        if (placed.surface().is_hole(face)) continue;
        for (int key = 0; key < placed.key_count(); ++key) {
            const Box3f box = bound_with_edges(placed, face, key);
            for (int k = 0; k < 3; ++k)
                if (!(std::abs(box.min[k]) < farthest && std::abs(box.max[k]) < farthest)) return false;
            boxes[static_cast<size_t>(key)] = grown(box, displacement_bound);
        }
        if (!raster.of(boxes).rect.empty()) return false;
    }
    return true;
}

}  // namespace trapeze
