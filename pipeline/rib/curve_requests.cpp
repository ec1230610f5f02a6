/// RISpec 5.5, 5.6: points and curves.
#include <cstdint>

#include "pipeline/rib/primitive_variables.h"
#include "pipeline/rib/request_table.h"

namespace trapeze::rib {
namespace {

constexpr int64_t kMostPoints = 1 << 28;

/// Points beyond the last whole segment are left over, but where the curve closes.
void check_curve(Reader& r, const Curves& curves, int vertices, size_t number) {
    const int least = curves.cubic ? (curves.periodic ? 3 : 4) : (curves.periodic ? 3 : 2);
    const bool fits = !curves.cubic || (curves.periodic ? vertices : vertices - 4) % curves.step == 0;
    if (vertices >= least && fits) return;
    const std::string has =
        "curve " + std::to_string(number) + " has " + std::to_string(vertices) + " points";
    if (vertices < least) throw RequestError{has + ", needs at least " + std::to_string(least), {}};
    const std::string misfit = has + ", which do not fit the basis' step of " + std::to_string(curves.step);
    if (curves.periodic) throw RequestError{misfit, {}};
    r.warn_once(misfit + "; the rest is left over", "surplus-points");
}

void curves(Reader& r, ArgumentCursor& c) {
    Curves curves;
    const std::string type = c.string("the type");
    if (type != "linear" && type != "cubic")
        throw RequestError{in_quotes(type) + " is neither linear nor cubic", {}};
    curves.cubic = type == "cubic";
    curves.basis = r.attributes().v_basis, curves.step = r.attributes().v_step;
    curves.vertices_per_curve = c.int_array("the numbers of points");
    const std::string wrap = c.string("the wrap mode");
    if (wrap != "periodic" && wrap != "nonperiodic")
        throw RequestError{in_quotes(wrap) + " is neither periodic nor nonperiodic", {}};
    curves.periodic = wrap == "periodic";
    if (curves.vertices_per_curve.empty()) throw RequestError{"has no curves", {}};
    int64_t sum = 0;
    for (size_t i = 0; i < curves.vertices_per_curve.size(); ++i) {
        check_curve(r, curves, curves.vertices_per_curve[i], i);
        sum += curves.vertices_per_curve[i];
    }
    if (sum > kMostPoints) throw RequestError{"more than " + std::to_string(kMostPoints) + " points", {}};
    const uint64_t count = curves.vertices_per_curve.size();
    Shape shape{std::move(curves), {}};
    ParameterList list = read_variables(r, c, PointForm::Mesh);
    if (point_count_of(list) == 0) throw RequestError{"\"P\" is missing", {}};
    shape.variables = checked_variables(r, std::move(list), shape.topology);
    r.add_shape("Curves", std::move(shape), count);
}

void points(Reader& r, ArgumentCursor& c) {
    ParameterList list = read_variables(r, c, PointForm::Mesh);
    Points points;
    points.count = point_count_of(list);
    if (points.count == 0) throw RequestError{"\"P\" is missing", {}};
    if (points.count > kMostPoints)
        throw RequestError{"more than " + std::to_string(kMostPoints) + " points", {}};
    Shape shape{points, {}};
    shape.variables = checked_variables(r, std::move(list), shape.topology);
    r.add_shape("Points", std::move(shape), static_cast<uint64_t>(points.count));
}

constexpr RequestRow kRows[] = {
    {"Curves", curves},
    {"Points", points},
};

}  // namespace

std::span<const RequestRow> curve_requests() {
    return kRows;
}

}  // namespace trapeze::rib
