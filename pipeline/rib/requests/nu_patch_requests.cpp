/// RISpec 5.2: NuPatch, TrimCurve.
#include <algorithm>
#include <cstdint>

#include "pipeline/rib/requests/primitive_variables.h"
#include "pipeline/rib/requests/request_table.h"

namespace trapeze::rib {
namespace {

/// The degree and one. Higher ones are taken for damage.
constexpr int kLargestOrder = 32;

/// One direction: the number of points, the order, the knots and the range. A spline of n points and order k
/// has n + k knots, and is a curve from knot k - 1 to knot n alone: outside of these too few basis functions
/// overlap to sum to 1.
void read_direction(GeometryContext& r, ArgumentCursor& c, const std::string& axis, int& points, int& order,
                    std::vector<float>& knots, float& begin, float& end) {
    points = c.integer(("the number of points along " + axis).c_str(), 2, kMostPointsAlongSide);
    order = c.integer(("the order along " + axis).c_str(), 2, kLargestOrder);
    const std::string name = "the knots along " + axis;
    knots = c.number_array(name.c_str());
    begin = c.number(("the least " + axis).c_str());
    end = c.number(("the largest " + axis).c_str());
    if (points < order)
        throw RequestError{std::to_string(points) + " points along " + axis + " are fewer than the order " +
                               std::to_string(order),
                           {}};
    const size_t wanted = static_cast<size_t>(points) + static_cast<size_t>(order);
    if (knots.size() != wanted)
        throw RequestError{
            name + " are " + std::to_string(knots.size()) + ", needs " + std::to_string(wanted), {}};
    if (!std::is_sorted(knots.begin(), knots.end())) throw RequestError{name + " fall", {}};
    const float first = knots[order - 1], last = knots[points];
    if (begin < first || end > last)
        r.report.warn_once("the range of " + axis + " reaches beyond the knots; it ends with them",
                           "nupatch-range");
    begin = std::max(begin, first), end = std::min(end, last);
    if (!(begin < end)) throw RequestError{"the range of " + axis + " is empty", {}};
}

/// Trim curves of the attributes are copied into the shape: they are part of its form.
void nu_patch(GeometryContext& r, ArgumentCursor& c) {
    NuPatch patch;
    read_direction(r, c, "u", patch.nu, patch.u_order, patch.u_knots, patch.u_begin, patch.u_end);
    read_direction(r, c, "v", patch.nv, patch.v_order, patch.v_knots, patch.v_begin, patch.v_end);
    if (int64_t{patch.nu} * patch.nv > kMostPoints)
        throw RequestError{"more than " + std::to_string(kMostPoints) + " points", {}};
    if (r.state.attributes().trim_loops) patch.trim_loops = *r.state.attributes().trim_loops;
    patch.trim_outside = r.state.attributes().trim_outside;
    const uint64_t faces = static_cast<uint64_t>(patch.segments_u()) * patch.segments_v();
    Shape shape{std::move(patch), {}};
    ParameterList list = read_variables_with_points(r, c, PointForm::Patch);
    if (list.find("Pz")) throw RequestError{"\"Pz\" is not for this primitive", {}};
    shape.variables = checked_variables(r.report, std::move(list), shape.topology);
    r.add_shape("NuPatch", std::move(shape), faces);
}

/// The arrays of a TrimCurve request, and how far they have been read. RISpec stores all curves of all loops
/// one after another; the three places advance together, curve by curve.
struct TrimArrays {
    std::vector<int> orders, counts;
    std::vector<float> knots, begins, ends, u, v, w;
    size_t curve = 0, knot = 0, point = 0;
};

/// Arrays of a length that follows from those before.
template <class T>
const std::vector<T>& expect_length(const std::vector<T>& array, size_t wanted, const char* what) {
    if (array.size() == wanted) return array;
    throw RequestError{
        std::string(what) + " are " + std::to_string(array.size()) + ", needs " + std::to_string(wanted), {}};
}

/// All lengths are checked here; next_curve() only cuts the arrays up.
TrimArrays trim_arrays(ArgumentCursor& c, int64_t curves) {
    TrimArrays a;
    a.orders = c.int_array("the orders");
    a.knots = c.number_array("the knots");
    a.begins = c.number_array("the curves' begins");
    a.ends = c.number_array("the curves' ends");
    a.counts = c.int_array("the numbers of points");
    a.u = c.number_array("the points' u"), a.v = c.number_array("the points' v");
    a.w = c.number_array("the points' w");
    const auto wanted = static_cast<size_t>(curves);
    expect_length(a.orders, wanted, "the orders"), expect_length(a.counts, wanted, "the numbers of points");
    expect_length(a.begins, wanted, "the curves' begins"), expect_length(a.ends, wanted, "the curves' ends");
    int64_t points = 0, knots = 0;
    for (size_t i = 0; i < wanted; ++i) {
        if (a.orders[i] < 2 || a.orders[i] > kLargestOrder || a.counts[i] < a.orders[i])
            throw RequestError{"curve " + std::to_string(i) + " has the order " +
                                   std::to_string(a.orders[i]) + " and " + std::to_string(a.counts[i]) +
                                   " points",
                               {}};
        points += a.counts[i], knots += int64_t{a.counts[i]} + a.orders[i];
    }
    expect_length(a.knots, static_cast<size_t>(knots), "the knots");
    for (const std::vector<float>* axis : {&a.u, &a.v, &a.w})
        expect_length(*axis, static_cast<size_t>(points), "the points' coordinates");
    return a;
}

/// The range is clipped to the knots that have a curve: from knot order - 1 to knot n.
TrimCurve next_curve(TrimArrays& a) {
    const std::string name = "curve " + std::to_string(a.curve);
    TrimCurve curve;
    curve.order = a.orders[a.curve];
    const auto first = a.knots.begin() + static_cast<std::ptrdiff_t>(a.knot);
    const auto count = static_cast<size_t>(a.counts[a.curve]);
    curve.knots.assign(first, first + static_cast<std::ptrdiff_t>(count) + curve.order);
    if (!std::is_sorted(curve.knots.begin(), curve.knots.end()))
        throw RequestError{"the knots of " + name + " fall", {}};
    curve.begin = std::max(a.begins[a.curve], curve.knots[static_cast<size_t>(curve.order) - 1]);
    curve.end = std::min(a.ends[a.curve], curve.knots[count]);
    if (!(curve.begin < curve.end)) throw RequestError{"the range of " + name + " is empty", {}};
    for (size_t i = a.point; i < a.point + count; ++i) {
        if (!(a.w[i] > 0)) throw RequestError{"a weight of " + name + " is not positive", {}};
        curve.points.push_back({a.u[i], a.v[i], a.w[i]});
    }
    a.knot += curve.knots.size(), a.point += count;
    ++a.curve;
    return curve;
}

/// Replaces the loops that trim the NuPatches to come; none end it.
void trim_curve(StateContext& r, ArgumentCursor& c) {
    // The request has nine arguments; where there is a tenth, the first is a count that follows from the
    // others.
    if (c.peek(9))
        c.integer("the number of loops", 0, kMostPointsAlongSide);  // some write it before the arrays
    const std::vector<int> curves_of_loops = c.int_array("the numbers of curves");
    int64_t curves = 0;
    for (const int n : curves_of_loops) {
        if (n < 0) throw RequestError{"a loop of " + std::to_string(n) + " curves", {}};
        curves += n;
    }
    if (curves == 0) {
        r.state.change_attributes().trim_loops.reset();
        return;
    }
    TrimArrays arrays = trim_arrays(c, curves);
    auto loops = std::make_shared<std::vector<std::vector<TrimCurve>>>();
    for (const int n : curves_of_loops) {
        loops->emplace_back();
        for (int i = 0; i < n; ++i) loops->back().push_back(next_curve(arrays));
    }
    r.state.change_attributes().trim_loops = std::move(loops);
}

/// An attribute like others: motion blocks hold it, and patches to come are trimmed by it.
constexpr RequestRow kAttributeRows[] = {
    {"TrimCurve", trim_curve},
};

constexpr RequestRow kNuPatchRequests[] = {
    {"NuPatch", nu_patch},
};

}  // namespace

std::span<const RequestRow> nu_patch_requests() {
    return kNuPatchRequests;
}

std::span<const RequestRow> trim_requests() {
    return kAttributeRows;
}

}  // namespace trapeze::rib
