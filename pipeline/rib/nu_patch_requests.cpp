/// RISpec 5.2: NuPatch.
#include <algorithm>
#include <cstdint>

#include "pipeline/rib/primitive_variables.h"
#include "pipeline/rib/request_table.h"

namespace trapeze::rib {
namespace {

constexpr int kLargestOrder = 32;
constexpr int kLargestMesh = 1 << 20;  ///< control points along a side
constexpr int64_t kMostPoints = 1 << 28;

/// One direction: the number of points, the order, the knots and the range.
void read_direction(Reader& r, ArgumentCursor& c, const std::string& axis, int& points, int& order,
                    std::vector<float>& knots, float& begin, float& end) {
    points = c.integer(("the number of points along " + axis).c_str(), 2, kLargestMesh);
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
        r.warn_once("the range of " + axis + " reaches beyond the knots; it ends with them", "nupatch-range");
    begin = std::max(begin, first), end = std::min(end, last);
    if (!(begin < end)) throw RequestError{"the range of " + axis + " is empty", {}};
}

void nu_patch(Reader& r, ArgumentCursor& c) {
    NuPatch patch;
    read_direction(r, c, "u", patch.nu, patch.u_order, patch.u_knots, patch.u_begin, patch.u_end);
    read_direction(r, c, "v", patch.nv, patch.v_order, patch.v_knots, patch.v_begin, patch.v_end);
    if (int64_t{patch.nu} * patch.nv > kMostPoints)
        throw RequestError{"more than " + std::to_string(kMostPoints) + " points", {}};
    const uint64_t faces = static_cast<uint64_t>(patch.segments_u()) * patch.segments_v();
    Shape shape{std::move(patch), {}};
    ParameterList list = read_variables(r, c, PointForm::Patch);
    if (list.find("Pz")) throw RequestError{"\"Pz\" is not for this primitive", {}};
    if (point_count_of(list) == 0) throw RequestError{"\"P\" is missing", {}};
    shape.variables = checked_variables(r, std::move(list), shape.topology);
    r.add_shape("NuPatch", std::move(shape), faces);
}

constexpr RequestRow kRows[] = {
    {"NuPatch", nu_patch},
};

}  // namespace

std::span<const RequestRow> nu_patch_requests() {
    return kRows;
}

}  // namespace trapeze::rib
