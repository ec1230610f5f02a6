/// Counts capacities, which is what memory is taken for; small strings and allocators' own needs are left
/// out.
#include "pipeline/rib/state/scene_size.h"

#include <string>
#include <vector>

namespace trapeze::rib {
namespace {

template <class T>
size_t bytes_of(const std::vector<T>& values) {
    return values.capacity() * sizeof(T);
}

size_t bytes_of(const std::vector<std::string>& strings) {
    size_t bytes = strings.capacity() * sizeof(std::string);
    for (const std::string& string : strings) bytes += string.capacity();
    return bytes;
}

/// Variables are most of a scene: points, normals and texture coordinates of its meshes.
template <class Parameters>
size_t bytes_of_all(const Parameters& parameters) {
    size_t bytes = 0;
    for (const Parameter& parameter : parameters)
        bytes += sizeof(Parameter) + bytes_of(parameter.floats) + bytes_of(parameter.strings);
    return bytes;
}

/// What a primitive has beside its variables: indices, knots, code.
struct OfTopology {
    size_t operator()(const PolygonMesh& mesh) const {
        return bytes_of(mesh.loops_per_polygon) + bytes_of(mesh.vertices_per_loop) + bytes_of(mesh.vertices);
    }
    size_t operator()(const SubdivisionMesh& mesh) const {
        size_t bytes = bytes_of(mesh.vertices_per_face) + bytes_of(mesh.vertices);
        for (const SubdivisionMesh::Tag& tag : mesh.tags)
            bytes += sizeof tag + bytes_of(tag.ints) + bytes_of(tag.floats) + bytes_of(tag.strings);
        return bytes;
    }
    size_t operator()(const NuPatch& patch) const {
        size_t bytes = bytes_of(patch.u_knots) + bytes_of(patch.v_knots);
        for (const std::vector<TrimCurve>& loop : patch.trim_loops)
            for (const TrimCurve& curve : loop)
                bytes += sizeof curve + bytes_of(curve.knots) + bytes_of(curve.points);
        return bytes;
    }
    size_t operator()(const Curves& curves) const { return bytes_of(curves.vertices_per_curve); }
    size_t operator()(const Blobby& blobby) const {
        return bytes_of(blobby.code) + bytes_of(blobby.floats) + bytes_of(blobby.strings);
    }
    size_t operator()(const Quadric&) const { return 0; }
    size_t operator()(const PatchMesh&) const { return 0; }
    size_t operator()(const Points&) const { return 0; }
};

}  // namespace

/// The shape with all that it owns.
size_t bytes_of(const Shape& shape) {
    return sizeof shape + std::visit(OfTopology(), shape.topology) + bytes_of_all(shape.variables.values);
}

size_t bytes_of(const Attributes& attributes) {
    return sizeof attributes + bytes_of(attributes.lights) + attributes.name.capacity() +
           attributes.asset.capacity() + attributes.user.count_bytes();
}

size_t bytes_of(const Primitive& primitive) {
    return sizeof primitive + primitive.shape_keys.allocated_bytes();
}

}  // namespace trapeze::rib
