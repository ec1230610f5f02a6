#include "core/shapes.h"

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

}  // namespace

VariableCounts variable_counts(const Topology& topology) {
    return std::visit([](const auto& shape) { return counts_of(shape); }, topology);
}

}  // namespace trapeze
