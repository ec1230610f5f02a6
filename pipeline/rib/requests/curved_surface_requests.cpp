/// RISpec 5.2, 5.4: patches and quadrics.
#include <algorithm>
#include <cmath>
#include <cstdint>

#include "pipeline/rib/requests/primitive_variables.h"
#include "pipeline/rib/requests/request_table.h"
#include "pipeline/rib/requests/wrap_mode.h"

namespace trapeze::rib {
namespace {

/// The basis counts for bicubic patches only; bilinear ones keep it unused.
PatchMesh mesh_of_type(GeometryContext& r, const std::string& type) {
    PatchMesh mesh;
    if (type != "bilinear" && type != "bicubic")
        throw RequestError{in_quotes(type) + " is neither bilinear nor bicubic", {}};
    mesh.bicubic = type == "bicubic";
    mesh.u_basis = r.state.attributes().u_basis, mesh.v_basis = r.state.attributes().v_basis;
    mesh.u_step = r.state.attributes().u_step, mesh.v_step = r.state.attributes().v_step;
    return mesh;
}

/// "P" is in rows of u, v by v; a "Pz" gives heights over the unit square.
void add_patches(GeometryContext& r, ArgumentCursor& c, const char* request, const PatchMesh& mesh) {
    Shape shape{mesh, {}};
    ParameterList list = read_variables_with_points(r, c, PointForm::Patch);
    shape.variables = checked_variables(r.report, std::move(list), shape.topology);
    r.add_shape(request, std::move(shape), static_cast<uint64_t>(mesh.patches_u()) * mesh.patches_v());
}

/// Patch type parameters: 2 by 2 or 4 by 4 points.
void patch(GeometryContext& r, ArgumentCursor& c) {
    PatchMesh mesh = mesh_of_type(r, c.string("the type"));
    mesh.nu = mesh.nv = mesh.bicubic ? 4 : 2;
    add_patches(r, c, "Patch", mesh);
}

/// n points of a cubic side make (n - 4) / step + 1 patches, n / step where it closes (RISpec 5.2). Points
/// that fit no step are an error here, unlike those of curves: which of them were meant cannot be told.
void patch_mesh(GeometryContext& r, ArgumentCursor& c) {
    PatchMesh mesh = mesh_of_type(r, c.string("the type"));
    const auto side = [&](const char* axis, int& n, bool& wraps, int step) {
        n = c.integer((std::string("the number of points along ") + axis).c_str(), 2, kMostPointsAlongSide);
        wraps = takes_periodic(r.report, c);
        if (!mesh.bicubic) return;
        if (wraps ? (n % step != 0 || n < 3) : (n < 4 || (n - 4) % step != 0))
            throw RequestError{std::to_string(n) + " points along " + axis +
                                   " do not fit the basis' step of " + std::to_string(step),
                               {}};
    };
    side("u", mesh.nu, mesh.u_wraps, mesh.u_step);
    side("v", mesh.nv, mesh.v_wraps, mesh.v_step);
    if (int64_t{mesh.nu} * mesh.nv > kMostPoints)
        throw RequestError{"more than " + std::to_string(kMostPoints) + " points", {}};
    add_patches(r, c, "PatchMesh", mesh);
}

/// Their numbers as RISpec 5.4 lists them; the sweep comes last.
struct QuadricRow {
    Quadric::Kind kind;
    const char* name;
    int count;  ///< numbers, thetamax included
};

constexpr QuadricRow kQuadrics[] = {
    {Quadric::Kind::Sphere, "Sphere", 4},         {Quadric::Kind::Cone, "Cone", 3},
    {Quadric::Kind::Cylinder, "Cylinder", 4},     {Quadric::Kind::Hyperboloid, "Hyperboloid", 7},
    {Quadric::Kind::Paraboloid, "Paraboloid", 4}, {Quadric::Kind::Disk, "Disk", 3},
    {Quadric::Kind::Torus, "Torus", 5},
};

/// What grows from nothing, or shrinks to it, in a motion block is as good as nothing there: it has normals.
/// Elsewhere nothing is a mistake.
void end_with_size(const GeometryContext& r, Quadric& q) {
    constexpr float kNothing = 1e-6f;
    const bool moves = r.state.in_motion();
    if (q.kind == Quadric::Kind::Sphere && q.values[0] == 0) {
        if (!moves) throw RequestError{"the radius is 0", {}};
        q.values[0] = q.values[2] = kNothing, q.values[1] = -kNothing;
    }
    if (q.kind == Quadric::Kind::Paraboloid && q.values[2] == 0) {
        if (!moves) throw RequestError{"zmax is 0", {}};
        q.values[2] = kNothing;
    }
}

/// RISpec 5.4: spheres reach from -radius to radius, whatever zmin and zmax say, and paraboloids from their
/// apex on. Rounded numbers are no mistake.
void end_with_surface(GeometryContext& r, Quadric& q) {
    constexpr float kRounding = 1 + 1e-5f;
    if (q.kind == Quadric::Kind::Sphere) {
        const float radius = std::abs(q.values[0]);
        for (const int i : {1, 2}) {
            float& z = q.values[i];
            if (std::abs(z) > radius * kRounding)
                r.report.warn_once(
                    std::string(i == 1 ? "zmin" : "zmax") + " is beyond the sphere, which ends there",
                    i == 1 ? "sphere-zmin" : "sphere-zmax");
            z = std::clamp(z, -radius, radius);
        }
    }
    if (q.kind == Quadric::Kind::Paraboloid && q.values[1] / q.values[2] < 0) {
        r.report.warn_once("zmin and zmax lie on both sides of the apex; zmin is 0", "paraboloid-zmin");
        q.values[1] = 0;
    }
}

/// Limits how far a quadric turns, and says so. Each turn is drawn over the last one: with a great many,
/// which nobody means, work would have no end.
void end_turning(GeometryContext& r, Quadric& q) {
    constexpr float kMost = 3600;  // degrees
    const auto limited = [&](float sweep) {
        if (std::abs(sweep) > kMost)
            r.report.warn_once("turns more than ten times; ten are drawn", "quadric-turns");
        return std::clamp(sweep, -kMost, kMost);
    };
    float& theta = q.values[q.value_count - 1];
    theta = limited(theta);
    if (q.kind == Quadric::Kind::Torus) q.values[3] = q.values[2] + limited(q.values[3] - q.values[2]);
}

/// A template over the row, since handlers are plain function pointers, which cannot carry a kind with them.
template <int kRow>
void quadric(GeometryContext& r, ArgumentCursor& c) {
    const QuadricRow& row = kQuadrics[kRow];
    Quadric q;
    q.kind = row.kind, q.value_count = row.count;
    // All in one array, or number by number (a hyperboloid's points may be arrays of three).
    const std::vector<float> values = c.numbers_up_to(static_cast<size_t>(row.count));
    if (static_cast<int>(values.size()) != row.count)
        throw RequestError{
            "has " + std::to_string(values.size()) + " numbers, needs " + std::to_string(row.count), {}};
    std::copy(values.begin(), values.end(), q.values.begin());
    end_with_size(r, q);
    end_with_surface(r, q);
    end_turning(r, q);
    Shape shape{q, {}};
    shape.variables = checked_variables(r.report, read_variables(r, c, PointForm::None), shape.topology);
    r.add_shape(row.name, std::move(shape), 1);
}

/// The number of `quadric` is its row of kQuadrics.
constexpr RequestRow kCurvedSurfaceRequests[] = {
    {"Patch", patch},           {"PatchMesh", patch_mesh}, {"Sphere", quadric<0>},
    {"Cone", quadric<1>},       {"Cylinder", quadric<2>},  {"Hyperboloid", quadric<3>},
    {"Paraboloid", quadric<4>}, {"Disk", quadric<5>},      {"Torus", quadric<6>},
};

}  // namespace

std::span<const RequestRow> curved_surface_requests() {
    return kCurvedSurfaceRequests;
}

}  // namespace trapeze::rib
