/// Geometric primitives as the RIB border hands them on: validated, in object space, all counts consistent.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <initializer_list>
#include <memory>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "core/math.h"
#include "core/scene/parameters.h"

namespace trapeze {

/// All four RISpec polygon primitives, as PointsGeneralPolygons: polygon -> loops -> vertices. The first loop
/// of a polygon is its outline, further ones are holes. "P" (vertex point) is in the primitive's variables.
struct PolygonMesh {
    std::vector<int> loops_per_polygon;
    std::vector<int> vertices_per_loop;
    std::vector<int> vertices;  ///< indices into P, below vertex_count
    int vertex_count = 0;
};

/// SubdivisionMesh (RISpec 5.3). Face vertex indices are below vertex_count; every face has at least three
/// vertices.
struct SubdivisionMesh {
    enum class Scheme : uint8_t { CatmullClark, Loop, Bilinear };

    /// A tag with its arguments, not yet checked (tessellate/surfaces/subdivision reads them).
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

/// A quadric (RISpec 5.4). `values` are the numeric arguments in the order of the request, angles in degrees,
/// thetamax last: Sphere radius zmin zmax; Cone height radius; Cylinder radius zmin zmax; Hyperboloid p1 p2
/// (6 floats); Paraboloid rmax zmin zmax; Disk height radius; Torus majorradius minorradius phimin phimax.
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

    /// Patches along u; patches_v(): along v.
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

/// A curve in the parameter plane of a NuPatch: homogeneous control points, a knot vector of
/// points + order entries.
struct TrimCurve {
    int order = 2;
    std::vector<float> knots;
    float begin = 0, end = 1;  ///< its parameters
    std::vector<V3f> points;   ///< (u w, v w, w), u and v in the patch's own parameters
};

/// NuPatch (RISpec 5.2): a tensor-product NURBS. Control points ("P" or "Pw") are in the primitive's
/// variables, u fastest. Knots never fall; u_knots has nu + u_order entries.
struct NuPatch {
    int nu = 2, u_order = 2, nv = 2, v_order = 2;
    std::vector<float> u_knots, v_knots;
    float u_begin = 0, u_end = 1, v_begin = 0, v_end = 1;
    std::vector<std::vector<TrimCurve>> trim_loops;  ///< each curve joined to the next, the last to the first
    bool trim_outside = false;                       ///< Attribute "trimcurve" "sense" is "outside"

    /// Segments count with empty knot intervals (RISpec table 5.2).
    int segments_u() const { return 1 + nu - u_order; }
    int segments_v() const { return 1 + nv - v_order; }
};

/// Curves (RISpec 5.6). "P" is in the primitive's variables; widths are "width" (varying) or
/// "constantwidth", in object space; with "N" they are ribbons across N, else they face the camera.
struct Curves {
    bool cubic = false;
    bool periodic = false;
    std::vector<int> vertices_per_curve;
    M44f basis;    ///< cubic only: the v basis of the attributes
    int step = 3;  ///< cubic only

    /// Spans of a curve of so many control points.
    int segments(int vertices) const {
        if (!cubic) return periodic ? vertices : vertices - 1;
        return periodic ? vertices / step : (vertices - 4) / step + 1;
    }
    /// Values of a varying variable on such a curve: one for each joint.
    int varying(int vertices) const { return segments(vertices) + (periodic ? 0 : 1); }
};

/// Points (RISpec 5.5): disks that face the camera, of diameter "width" or "constantwidth" (1 without), in
/// object space.
struct Points {
    int count = 0;
};

/// Blobby (RISpec 5.6): a program of primitive fields and operators.
struct Blobby {
    int leaf_count = 0;
    std::vector<int> code;
    std::vector<float> floats;
    std::vector<std::string> strings;
};

using Topology =
    std::variant<PolygonMesh, SubdivisionMesh, Quadric, PatchMesh, NuPatch, Curves, Points, Blobby>;

/// Topology and variables of a primitive at one motion key.
struct Shape {
    Topology topology;
    ParameterList variables;
};

/// Poses of a deforming shape; of most primitives there is one, which has its place here.
class ShapeKeys {
  public:
    using Pointer = std::shared_ptr<const Shape>;

    ShapeKeys() = default;
    ShapeKeys(Pointer only) : one_(std::move(only)) {}
    ShapeKeys(const std::vector<Pointer>& keys) {
        if (keys.size() == 1)
            one_ = keys.front();
        else
            several_ = keys;
    }
    ShapeKeys(std::initializer_list<Pointer> keys) : ShapeKeys(std::vector<Pointer>(keys)) {}

    size_t size() const { return several_.empty() ? one_ != nullptr : several_.size(); }
    bool empty() const { return size() == 0; }
    const Pointer* data() const { return several_.empty() ? &one_ : several_.data(); }
    const Pointer* begin() const { return data(); }
    const Pointer* end() const { return data() + size(); }
    const Pointer& front() const { return *data(); }
    const Pointer& back() const { return data()[size() - 1]; }
    const Pointer& operator[](size_t key) const { return data()[key]; }
    /// Whether they are the same shapes, and not just equal ones.
    bool operator==(const ShapeKeys&) const = default;
    /// What it takes beside itself.
    size_t allocated_bytes() const { return several_.capacity() * sizeof(Pointer); }

  private:
    Pointer one_;
    std::vector<Pointer> several_;  ///< then one_ is null
};

/// Whether one shape in different places has different surfaces: it faces the camera, or is as fine as the
/// screen wants it.
inline bool depends_on_view(const Topology& topology) {
    return std::holds_alternative<Curves>(topology) || std::holds_alternative<Points>(topology) ||
           std::holds_alternative<Blobby>(topology);
}

/// How many values a variable of each class has on a primitive.
struct VariableCounts {
    int uniform = 1, varying = 1, vertex = 1, face_varying = 1;

    /// The number for one class.
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

/// The counts of a topology (RISpec section 5), which the RIB border checks all variables against.
VariableCounts variable_counts(const Topology& topology);

}  // namespace trapeze
