/// RISpec 5.6: Geometry, shapes that the renderer knows by name.
#include "pipeline/rib/requests/primitive_variables.h"
#include "pipeline/rib/requests/request_table.h"
#include "pipeline/rib/requests/teapot.h"
#include "pipeline/rib/ris/ris_light_surfaces.h"
#include "pipeline/rib/ris/ris_lights.h"
#include "pipeline/rib/state/bases.h"

namespace trapeze::rib {
namespace {

/// Adds a shape that the summary counts as one face.
void add(GeometryContext& r, const char* kind, Topology topology, ParameterList list) {
    Shape shape{std::move(topology), std::move(list)};
    r.add_shape(kind, std::move(shape), 1);
}

/// 32 patches in one request: a motion block has no place for them.
void teapot(GeometryContext& r, const ParameterList& given) {
    if (r.state.in_motion())
        throw RequestError{"a teapot does not deform; move it by its transformation", {}};
    PatchMesh mesh;
    mesh.bicubic = true;
    mesh.nu = mesh.nv = 4;
    mesh.u_basis = mesh.v_basis = bezier_basis();
    const ParameterList variables = checked_variables(r.report, given, mesh);
    for (const std::array<V3f, 16>& points : teapot_patches()) {
        Parameter P{"P", {StorageClass::Vertex, ValueType::Point, 1}, {}, {}};
        for (const V3f& p : points) P.floats.insert(P.floats.end(), {p.x, p.y, p.z});
        ParameterList list = variables;
        list.set(std::move(P));
        add(r, "Patch", mesh, std::move(list));
    }
}

/// Spheres about the origin, whole: for "sphere" and for lights of that form.
void sphere(GeometryContext& r, const ParameterList& given, float radius) {
    Quadric q;
    q.values = {radius, -radius, radius, 360};
    q.value_count = 4;
    add(r, "Sphere", q, checked_variables(r.report, given, q));
}

/// Edges of length 1 about the origin.
void cube(GeometryContext& r, const ParameterList& given) {
    PolygonMesh mesh;
    mesh.loops_per_polygon.assign(6, 1);
    mesh.vertices_per_loop.assign(6, 4);
    // Corner c is at the signs of its bits; seen from outside, (1 - 0) x (3 - 0) points to the viewer.
    mesh.vertices = {0, 2, 3, 1, 4, 5, 7, 6, 0, 1, 5, 4, 2, 6, 7, 3, 0, 4, 6, 2, 1, 3, 7, 5};
    mesh.vertex_count = 8;
    Parameter P{"P", {StorageClass::Vertex, ValueType::Point, 1}, {}, {}};
    for (int c = 0; c < 8; ++c)
        for (int axis = 0; axis < 3; ++axis) P.floats.push_back(c >> axis & 1 ? 0.5f : -0.5f);
    ParameterList list = checked_variables(r.report, given, mesh);
    list.set(std::move(P));
    add(r, "PointsPolygons", std::move(mesh), std::move(list));
}

/// The path tracer's rectangular light.
void rectangle(GeometryContext& r, const ParameterList& given) {
    const PatchMesh mesh;
    ParameterList list = checked_variables(r.report, given, mesh);
    list.set(points_of_square());
    add(r, "Patch", mesh, std::move(list));
}

/// A parameter of the primitive itself, which no shader looks at.
float number_of(const ParameterList& given, const char* name, float otherwise) {
    const Parameter* p = given.find(name);
    return p && p->floats.size() == 1 ? p->floats[0] : otherwise;
}

/// Geometry name parameters. RISpec leaves the names to renderers; "teapot" is customary, and RIS names
/// shapes of lights so.
void geometry(GeometryContext& r, ArgumentCursor& c) {
    const std::string name = c.string("the name");
    const ParameterList given = read_variables(r, c, PointForm::None);
    if (name == "teapot") return teapot(r, given);
    if (name == "sphere") return sphere(r, given, 1);
    if (name == "cube") return cube(r, given);
    if (name == "rectlight") return rectangle(r, given);
    if (name == "spherelight") return sphere(r, given, number_of(given, "radius", 0.5f));
    if (name == "envsphere") return r.place_far_emitter(FarShape::Dome);
    if (name == "distantlight")
        return r.place_far_emitter(FarShape::Direction, number_of(given, "anglesubtended", 0));
    r.report.warn_once(
        "no geometry " + in_quotes(name) + "; known are teapot, sphere, cube, rectlight and spherelight",
        "geometry-" + name);
}

/// In a motion block a shape is a pose like any other.
constexpr RequestRow kGeometryRequests[] = {
    {"Geometry", geometry},
};

}  // namespace

std::span<const RequestRow> geometry_requests() {
    return kGeometryRequests;
}

}  // namespace trapeze::rib
