#include "shade/materials/polygon_parameters.h"

#include <cmath>
#include <variant>

#include "core/polygon_lean.h"
#include "core/scene/scene.h"

namespace trapeze {
namespace {

/// The normal of the plane that dPdu and dPdv (camera space) span, in object space; its length says nothing.
/// Normals go back to object space by the transpose of the matrix that takes points forward.
V3d object_normal(const Primitive& primitive, const V3f& dPdu, const V3f& dPdv) {
    const V3d normal = V3d(dPdu).cross(V3d(dPdv));
    const M44f& m = primitive.camera_from_object.front();
    V3d in_object;
    for (int i = 0; i < 3; ++i) in_object[i] = V3d(m[i][0], m[i][1], m[i][2]).dot(normal);
    return in_object;
}

}  // namespace

bool has_places_as_parameters(const ShadingGrid& grid) {
    return grid.primitive && !grid.primitive->shape_keys.empty() &&
           !grid.primitive->camera_from_object.empty() &&
           std::holds_alternative<PolygonMesh>(grid.primitive->shape().topology);
}

V2f steps_of_face(const ShadingGrid& grid, size_t piece) {
    if (!has_places_as_parameters(grid)) return {0, 0};
    const GridShape& shape = grid.shape;
    const size_t first = piece * static_cast<size_t>(shape.vertex_count());
    if (has_place_derivatives(object_normal(*grid.primitive, grid.dPdu.at(first), grid.dPdv.at(first))))
        return {0, 0};
    // Measured along the middle: vertices of borders may have been moved to where a neighbour has its own.
    const auto step = [&](const Triples& derivative, int begin, int end, int count) {
        const Triples& P = grid.P.front();
        const size_t from = first + static_cast<size_t>(begin), to = first + static_cast<size_t>(end);
        const V3f along = derivative.at(from), way = P.at(to) - P.at(from);
        const float size = way.dot(along) / (along.length2() * static_cast<float>(count));
        return std::isfinite(size) && size != 0 ? size : 1.0f;
    };
    return {
        step(grid.dPdu, shape.row_index(0, shape.nv / 2), shape.row_index(shape.nu, shape.nv / 2), shape.nu),
        step(grid.dPdv, shape.row_index(shape.nu / 2, 0), shape.row_index(shape.nu / 2, shape.nv), shape.nv)};
}

}  // namespace trapeze
