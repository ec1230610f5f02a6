/// Geometric primitives as the RIB border hands them on: validated, in object space, all counts consistent.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <variant>
#include <vector>

#include "core/math.h"
#include "core/parameters.h"

namespace trapeze {

/// All four RISpec polygon primitives, as PointsGeneralPolygons: polygon -> loops -> vertices. The first loop
/// of a polygon is its outline, further ones are holes. "P" (vertex point) is in the primitive's variables.
struct PolygonMesh {
    std::vector<int> loops_per_polygon;
    std::vector<int> vertices_per_loop;
    std::vector<int> vertices;  ///< indices into P, below vertex_count
    int vertex_count = 0;
};

/// RISpec 5.3. Face vertex indices are below vertex_count; every face has at least three vertices.
struct SubdivisionMesh {
    enum class Scheme : uint8_t { CatmullClark, Loop, Bilinear };

    struct Tag {
        std::string name;  ///< hole, crease, corner, interpolateboundary, facevaryinginterpolateboundary, ...
        std::vector<int> ints;
        std::vector<float> floats;
        std::vector<std::string> strings;
    };

    Scheme scheme = Scheme::CatmullClark;
    std::vector<int> vertices_per_face;
    std::vector<int> vertices;
    std::vector<Tag> tags;
    int vertex_count = 0;
};

/// RISpec 5.4. `values` are the numeric arguments in the order of the request, angles in degrees, thetamax
/// last: Sphere radius zmin zmax; Cone height radius; Cylinder radius zmin zmax; Hyperboloid p1 p2 (6
/// floats); Paraboloid rmax zmin zmax; Disk height radius; Torus majorradius minorradius phimin phimax.
struct Quadric {
    enum class Kind : uint8_t { Sphere, Cone, Cylinder, Hyperboloid, Paraboloid, Disk, Torus };

    Kind kind = Kind::Sphere;
    std::array<float, 7> values{};
    int value_count = 0;  ///< thetamax included
    float theta_max() const { return values[value_count - 1]; }
};

/// Patch and PatchMesh (RISpec 5.2). A Patch is a 2x2 (bilinear) or 4x4 (bicubic) mesh without wrap and with
/// steps of the patch's own size. Control points ("P" or "Pw") are in the primitive's variables, u fastest.
struct PatchMesh {
    bool bicubic = false;
    int nu = 2, nv = 2;  ///< control points
    bool u_wraps = false, v_wraps = false;
    M44f u_basis, v_basis;       ///< bicubic only
    int u_step = 3, v_step = 3;  ///< bicubic only

    int patches_u() const {
        if (!bicubic) return u_wraps ? nu : nu - 1;
        return u_wraps ? nu / u_step : (nu - 4) / u_step + 1;
    }
    int patches_v() const {
        if (!bicubic) return v_wraps ? nv : nv - 1;
        return v_wraps ? nv / v_step : (nv - 4) / v_step + 1;
    }
    /// Numbers of values that varying variables have along u and v (RISpec table 5.2).
    int varying_u() const { return patches_u() + (u_wraps ? 0 : 1); }
    int varying_v() const { return patches_v() + (v_wraps ? 0 : 1); }
};

using Topology = std::variant<PolygonMesh, SubdivisionMesh, Quadric, PatchMesh>;

/// Topology and variables of a primitive at one motion key.
struct Shape {
    Topology topology;
    ParameterList variables;
};

/// How many values a variable of each class has on a primitive.
struct VariableCounts {
    int uniform = 1, varying = 1, vertex = 1, face_varying = 1;

    int of(StorageClass storage) const {
        switch (storage) {
            case StorageClass::Constant:
                return 1;
            case StorageClass::Uniform:
                return uniform;
            case StorageClass::Varying:
                return varying;
            case StorageClass::Vertex:
                return vertex;
            case StorageClass::FaceVarying:
            case StorageClass::FaceVertex:
                return face_varying;
        }
        return 1;
    }
};

VariableCounts variable_counts(const Topology& topology);

}  // namespace trapeze
