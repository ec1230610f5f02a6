/// RISpec 5.5, 5.6: points and curves.
#include <algorithm>
#include <cstdint>

#include "pipeline/rib/requests/primitive_variables.h"
#include "pipeline/rib/requests/request_table.h"
#include "pipeline/rib/requests/select_values.h"
#include "pipeline/rib/requests/wrap_mode.h"

namespace trapeze::rib {
namespace {

/// RISpec 5.5: of one segment; a closed cubic may share its first points with its last.
int least_points(const Curves& curves) {
    return curves.cubic ? (curves.periodic ? 3 : 4) : 2;
}

/// Messages about a curve begin so; curves count from 0.
std::string has_points(int vertices, size_t number) {
    return "curve " + std::to_string(number) + " has " + std::to_string(vertices) + " points";
}

/// Points beyond the last whole segment are left over, but where the curve closes. A closed curve uses all of
/// its points, so that one whose number is no multiple of the step has no meaning, and is an error.
void check_step(GeometryContext& r, const Curves& curves, int vertices, size_t number) {
    if (!curves.cubic || (curves.periodic ? vertices : vertices - 4) % curves.step == 0) return;
    const std::string misfit =
        has_points(vertices, number) + ", which do not fit the basis' step of " + std::to_string(curves.step);
    if (curves.periodic) throw RequestError{misfit, {}};
    r.report.warn_once(misfit + "; the rest is left over", "surplus-points");
}

/// Leaves out curves that have too few points for one segment, unless all have. Three masks are kept, since a
/// curve has one uniform value, one vertex value a point, and for cubics one varying value at each end of a
/// segment, which is fewer.
void leave_out_short_curves(GeometryContext& r, Curves& curves, ParameterList& variables) {
    const int least = least_points(curves);
    if (std::all_of(curves.vertices_per_curve.begin(), curves.vertices_per_curve.end(),
                    [least](int n) { return n >= least; }))
        return;
    std::vector<char> kept, kept_varying, kept_points;
    std::string first;
    for (size_t i = 0; i < curves.vertices_per_curve.size(); ++i) {
        const int n = curves.vertices_per_curve[i];
        const char keeps = n >= least;
        kept.push_back(keeps);
        kept_varying.insert(kept_varying.end(), static_cast<size_t>(std::max(0, curves.varying(n))), keeps);
        kept_points.insert(kept_points.end(), static_cast<size_t>(n), keeps);
        if (!keeps && first.empty()) first = has_points(n, i) + ", needs at least " + std::to_string(least);
    }
    if (std::find(kept.begin(), kept.end(), 1) == kept.end()) throw RequestError{first, {}};
    r.report.warn_once(first + "; curves of fewer are left out", "short-curves");
    select_values(curves.vertices_per_curve, kept);
    for (Parameter& p : variables.values) {
        const StorageClass storage = p.declaration.storage;
        if (storage == StorageClass::Constant) continue;
        select_items(p, storage == StorageClass::Uniform  ? kept
                        : storage == StorageClass::Vertex ? kept_points
                                                          : kept_varying);
    }
}

/// Counts of points are checked before the points: they say how long the arrays must be. The basis is that of
/// v, along which RISpec has curves run; it is copied, as the attribute may change afterwards.
void curves(GeometryContext& r, ArgumentCursor& c) {
    Curves curves;
    const std::string type = c.string("the type");
    if (type != "linear" && type != "cubic")
        throw RequestError{in_quotes(type) + " is neither linear nor cubic", {}};
    curves.cubic = type == "cubic";
    curves.basis = r.state.attributes().v_basis, curves.step = r.state.attributes().v_step;
    curves.vertices_per_curve = c.int_array("the numbers of points");
    curves.periodic = takes_periodic(r.report, c);
    if (curves.vertices_per_curve.empty()) throw RequestError{"has no curves", {}};
    int64_t sum = 0;
    for (size_t i = 0; i < curves.vertices_per_curve.size(); ++i) {
        const int vertices = curves.vertices_per_curve[i];
        if (vertices < 0) throw RequestError{has_points(vertices, i), {}};
        if (vertices >= least_points(curves)) check_step(r, curves, vertices, i);
        sum += vertices;
    }
    if (sum > kMostPoints) throw RequestError{"more than " + std::to_string(kMostPoints) + " points", {}};
    Shape shape{std::move(curves), {}};
    ParameterList list = read_variables_with_points(r, c, PointForm::Mesh);
    shape.variables = checked_variables(r.report, std::move(list), shape.topology);
    Curves& kept = std::get<Curves>(shape.topology);
    leave_out_short_curves(r, kept, shape.variables);
    const uint64_t count = kept.vertices_per_curve.size();
    r.add_shape("Curves", std::move(shape), count);
}

/// Points parameters: disks that face the eye, as wide as "width" or "constantwidth" in object space.
void points(GeometryContext& r, ArgumentCursor& c) {
    ParameterList list = read_variables_with_points(r, c, PointForm::Mesh);
    Points points;
    points.count = point_count_of(list);
    if (points.count > kMostPoints)
        throw RequestError{"more than " + std::to_string(kMostPoints) + " points", {}};
    Shape shape{points, {}};
    shape.variables = checked_variables(r.report, std::move(list), shape.topology);
    r.add_shape("Points", std::move(shape), static_cast<uint64_t>(points.count));
}

/// Requests of this file; both may deform in a motion block.
constexpr RequestRow kCurveRequests[] = {
    {"Curves", curves},
    {"Points", points},
};

}  // namespace

std::span<const RequestRow> curve_requests() {
    return kCurveRequests;
}

}  // namespace trapeze::rib
