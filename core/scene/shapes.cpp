#include "core/scene/shapes.h"

#include <algorithm>

namespace trapeze {
namespace {

VariableCounts counts_of(const PolygonMesh& mesh) {
    const int corners = static_cast<int>(mesh.vertices.size());
    return {static_cast<int>(mesh.loops_per_polygon.size()), mesh.vertex_count, mesh.vertex_count, corners};
}

VariableCounts counts_of(const SubdivisionMesh& mesh) {
    const int corners = static_cast<int>(mesh.vertices.size());
    return {static_cast<int>(mesh.vertices_per_face.size()), mesh.vertex_count, mesh.vertex_count, corners};
}

VariableCounts counts_of(const Quadric&) {
    return {1, 4, 4, 4};
}

VariableCounts counts_of(const PatchMesh& mesh) {
    const int patches = mesh.patches_u() * mesh.patches_v();
    const int varying = mesh.varying_u() * mesh.varying_v();
    return {patches, varying, mesh.nu * mesh.nv, 4 * patches};
}

VariableCounts counts_of(const NuPatch& patch) {
    const int segments = patch.segments_u() * patch.segments_v();
    const int varying = (patch.segments_u() + 1) * (patch.segments_v() + 1);
    return {segments, varying, patch.nu * patch.nv, 4 * segments};
}

VariableCounts counts_of(const Curves& curves) {
    int varying = 0, vertices = 0;
    for (const int n : curves.vertices_per_curve) varying += std::max(0, curves.varying(n)), vertices += n;
    return {static_cast<int>(curves.vertices_per_curve.size()), varying, vertices, varying};
}

VariableCounts counts_of(const Points& points) {
    return {1, points.count, points.count, points.count};
}

VariableCounts counts_of(const Blobby& blobby) {
    return {1, blobby.leaf_count, blobby.leaf_count, blobby.leaf_count};
}

}  // namespace

VariableCounts variable_counts(const Topology& topology) {
    return std::visit([](const auto& shape) { return counts_of(shape); }, topology);
}

}  // namespace trapeze
