/// Patches, their bases and trims (RISpec 5.2).
#include <cstdint>

#include "pipeline/ri/call.h"
#include "pipeline/ri/names.h"
#include "pipeline/ri/parameters.h"

namespace trapeze::ri {
namespace {

constexpr int kLargestMesh = 1 << 20;     ///< control points along a side, at most; as the reader has it
constexpr int64_t kMostPoints = 1 << 28;  ///< control points in all, at most

/// Throws for a mesh that is too small or too large.
void check_size(int nu, int nv) {
    if (nu < 2 || nv < 2) throw CallError{RIE_RANGE, "needs 2 points or more along each side"};
    if (nu > kLargestMesh || nv > kLargestMesh || int64_t{nu} * nv > kMostPoints)
        throw CallError{RIE_LIMIT, "more than " + std::to_string(kLargestMesh) + " points along a side, or " +
                                       std::to_string(kMostPoints) + " in all"};
}

PatchMesh mesh_of_type(const Context& context, RtToken type) {
    const std::string name = required(type, "the type");
    if (name != "bilinear" && name != "bicubic")
        throw CallError{RIE_BADTOKEN, "\"" + name + "\" is neither bilinear nor bicubic"};
    PatchMesh mesh;
    mesh.bicubic = name == "bicubic";
    mesh.u_step = context.counting.u_step, mesh.v_step = context.counting.v_step;
    return mesh;
}

bool wraps(RtToken wrap) {
    const std::string name = required(wrap, "the wrap mode");
    if (name != "periodic" && name != "nonperiodic")
        throw CallError{RIE_BADTOKEN, "\"" + name + "\" is neither periodic nor nonperiodic"};
    return name == "periodic";
}

/// Throws unless control points make whole segments of a cubic basis.
void check_fit(int points, bool periodic, int step) {
    if (periodic ? points % step == 0 : points >= 4 && (points - 4) % step == 0) return;
    throw CallError{RIE_CONSISTENCY,
                    std::to_string(points) + " points do not fit the basis' step of " + std::to_string(step)};
}

void write_basis(rib::RibWriter& writer, const RtFloat (*basis)[4], RtInt step) {
    if (const char* const name = basis_name(basis))
        writer.string(name);
    else
        writer.numbers({&basis[0][0], 16});
    writer.number(step);
}

/// A NuPatch's points, order, knots and range along one direction.
struct Direction {
    int points, order;
    const RtFloat* knots;
    float min, max;

    void check() const {
        if (order < 2 || points < order)
            throw CallError{RIE_RANGE, std::to_string(points) + " points do not do for the order " +
                                           std::to_string(order)};
    }
    void write(rib::RibWriter& writer) const {
        writer.number(points), writer.number(order);
        writer.numbers({knots, static_cast<size_t>(points) + static_cast<size_t>(order)});
        writer.number(min), writer.number(max);
    }
};

}  // namespace
}  // namespace trapeze::ri

using namespace trapeze::ri;

RtVoid RiBasis(RtBasis ubasis, RtInt ustep, RtBasis vbasis, RtInt vstep) {
    call("RiBasis", [&](Context& context) {
        required(ubasis, "the u basis"), required(vbasis, "the v basis");
        if (ustep < 1 || vstep < 1) throw CallError{RIE_RANGE, "a step is below 1"};
        context.counting.u_step = ustep, context.counting.v_step = vstep;
        context.writer().request("Basis");
        write_basis(context.writer(), ubasis, ustep);
        write_basis(context.writer(), vbasis, vstep);
    });
}

RtVoid RiPatchV(RtToken type, RtInt n, RtToken tokens[], RtPointer values[]) {
    call("RiPatch", [&](Context& context) {
        trapeze::PatchMesh mesh = mesh_of_type(context, type);
        mesh.nu = mesh.nv = mesh.bicubic ? 4 : 2;
        const auto parameters = checked_parameters(context, {n, tokens, values}, variable_counts(mesh));
        context.writer().request("Patch");
        context.writer().string(type);
        write_parameters(context.writer(), parameters);
    });
}

RtVoid RiPatchMeshV(RtToken type, RtInt nu, RtToken uwrap, RtInt nv, RtToken vwrap, RtInt n, RtToken tokens[],
                    RtPointer values[]) {
    call("RiPatchMesh", [&](Context& context) {
        trapeze::PatchMesh mesh = mesh_of_type(context, type);
        check_size(nu, nv);
        mesh.nu = nu, mesh.nv = nv, mesh.u_wraps = wraps(uwrap), mesh.v_wraps = wraps(vwrap);
        if (mesh.bicubic) check_fit(nu, mesh.u_wraps, mesh.u_step), check_fit(nv, mesh.v_wraps, mesh.v_step);
        const auto parameters = checked_parameters(context, {n, tokens, values}, variable_counts(mesh));
        context.writer().request("PatchMesh");
        context.writer().string(type);
        context.writer().number(nu), context.writer().string(uwrap);
        context.writer().number(nv), context.writer().string(vwrap);
        write_parameters(context.writer(), parameters);
    });
}

RtVoid RiNuPatchV(RtInt nu, RtInt uorder, RtFloat uknot[], RtFloat umin, RtFloat umax, RtInt nv, RtInt vorder,
                  RtFloat vknot[], RtFloat vmin, RtFloat vmax, RtInt n, RtToken tokens[],
                  RtPointer values[]) {
    call("RiNuPatch", [&](Context& context) {
        const Direction u{nu, uorder, required(uknot, "the u knots"), umin, umax};
        const Direction v{nv, vorder, required(vknot, "the v knots"), vmin, vmax};
        u.check(), v.check();
        check_size(nu, nv);
        trapeze::NuPatch patch;
        patch.nu = nu, patch.nv = nv, patch.u_order = uorder, patch.v_order = vorder;
        const auto parameters = checked_parameters(context, {n, tokens, values}, variable_counts(patch));
        context.writer().request("NuPatch");
        u.write(context.writer()), v.write(context.writer());
        write_parameters(context.writer(), parameters);
    });
}

RtVoid RiTrimCurve(RtInt nloops, RtInt ncurves[], RtInt order[], RtFloat knot[], RtFloat min[], RtFloat max[],
                   RtInt n[], RtFloat u[], RtFloat v[], RtFloat w[]) {
    call("RiTrimCurve", [&](Context& context) {
        const auto loops = array_of(ncurves, nloops, "loops");
        const int curves = sum_of(loops, 1, "curves of a loop");
        const auto orders = array_of(order, curves, "orders"), points = array_of(n, curves, "points");
        const int coordinates = sum_of(points, 1, "points of a curve");
        const int64_t knots = int64_t{coordinates} + sum_of(orders, 1, "order of a curve");
        const std::span<const float> arrays[] = {
            array_of(knot, knots, "knots"), array_of(min, curves, "ends"), array_of(max, curves, "ends")};
        const std::span<const float> uvw[] = {array_of(u, coordinates, "coordinates"),
                                              array_of(v, coordinates, "coordinates"),
                                              array_of(w, coordinates, "coordinates")};
        trapeze::rib::RibWriter& writer = context.writer();
        writer.request("TrimCurve");
        writer.integers(loops), writer.integers(orders);
        for (const auto array : arrays) writer.numbers(array);
        writer.integers(points);
        for (const auto array : uvw) writer.numbers(array);
    });
}
