#include "tessellate/camera_variables.h"

#include <cmath>

#include "tessellate/topology/placed_surface.h"

namespace trapeze {
namespace {

/// Calls transform(triple, index, planes) for each element of a variable and stores what it gives; arrays are
/// several elements of `floats_per_element` planes each. A fourth float is left as it is.
template <class F>
void for_each_triple(GridVariable& variable, int floats_per_element, F&& transform) {
    for (size_t plane = 0; plane + floats_per_element <= variable.planes.size();
         plane += floats_per_element) {
        std::vector<float>* const p = &variable.planes[plane];
        for (size_t i = 0; i < p[0].size(); ++i) {
            const V3f out = transform(V3f(p[0][i], p[1][i], p[2][i]), i, p);
            p[0][i] = out.x, p[1][i] = out.y, p[2][i] = out.z;
        }
    }
}

/// What a matrix takes to object space it takes to camera space afterwards.
void matrices_to_camera_space(const M44f& camera_from_object, GridVariable& variable) {
    for (size_t plane = 0; plane + 16 <= variable.planes.size(); plane += 16)
        for (size_t i = 0; i < variable.planes[plane].size(); ++i) {
            M44f m;
            for (size_t k = 0; k < 16; ++k) m[k / 4][k % 4] = variable.planes[plane + k][i];
            m = m * camera_from_object;
            for (size_t k = 0; k < 16; ++k) variable.planes[plane + k][i] = m[k / 4][k % 4];
        }
}

}  // namespace

/// The matrix is that of the first motion key: shading happens once a frame, as the shutter opens, and sees
/// the variables of moving primitives as they are then.
void to_camera_space(const M44f& camera_from_object, GridVariable& variable) {
    const M44f& m = camera_from_object;
    using Planes = std::vector<float>*;
    switch (variable.declaration.type) {
        case ValueType::Point:
            for_each_triple(variable, 3, [&](const V3f& p, size_t, Planes) { return transform_point(m, p); });
            break;
        case ValueType::Vector:
            for_each_triple(variable, 3,
                            [&](const V3f& v, size_t, Planes) { return transform_vector(m, v); });
            break;
        case ValueType::Normal: {
            // The cofactors are the inverse transpose times the determinant; its amount comes out here, since
            // normals of primitive variables need not be of unit length.
            const M44f normals = normal_matrix(m);
            const float x = m[0][0] * normals[0][0] + m[0][1] * normals[0][1] + m[0][2] * normals[0][2];
            const float scale =
                x != 0 ? 1 / std::abs(x) : 1.0f;  // the determinant: exactly inverse transpose
            for_each_triple(variable, 3, [&](const V3f& n, size_t, Planes) {
                return transform_vector(normals, n) * scale;
            });
            break;
        }
        case ValueType::HPoint:  // w stays: the matrix is affine
            for_each_triple(variable, 4, [&](const V3f& p, size_t i, Planes planes) {
                return transform_vector(m, p) + V3f(m[3][0], m[3][1], m[3][2]) * planes[3][i];
            });
            break;
        case ValueType::Matrix:
            matrices_to_camera_space(m, variable);
            break;
        default:
            break;
    }
}

/// A normal of no length, or none that a singular matrix leaves, would make shading black for no reason that
/// the scene shows.
void normals_to_camera_space(const M44f& camera_from_object, const Triples& fallback, Triples& normals) {
    const M44f m = normal_matrix(camera_from_object);
    for (size_t i = 0; i < normals.size(); ++i) {
        const V3f n = transform_vector(m, normals.at(i));
        const float length = n.length();
        normals.set(i, length > 0 && std::isfinite(length) ? n / length : fallback.at(i));
    }
}

}  // namespace trapeze
