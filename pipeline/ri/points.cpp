/// Points, curves, implicit surfaces (RISpec 5.5, 5.6), and RiGeometry.
#include "pipeline/ri/call.h"
#include "pipeline/ri/parameters.h"

namespace trapeze::ri {
namespace {

/// Whether a word is `first`, and not `second`; throws RIE_BADTOKEN when it is neither.
bool is_first_of(RtToken word, const std::string& first, const std::string& second) {
    const std::string name = required(word, "the word");
    if (name != first && name != second)
        throw CallError{RIE_BADTOKEN, "\"" + name + "\" is neither " + first + " nor " + second};
    return name == first;
}

/// Throws for curves whose points do not make whole segments.
void check_curves(const Curves& curves) {
    const int least = curves.cubic && !curves.periodic ? 4 : curves.periodic ? 3 : 2;
    for (const int points : curves.vertices_per_curve) {
        if (points < least)
            throw CallError{RIE_RANGE, "a curve has " + std::to_string(points) + " points, needs at least " +
                                           std::to_string(least)};
        if (curves.cubic && (curves.periodic ? points : points - 4) % curves.step != 0)
            throw CallError{RIE_CONSISTENCY, std::to_string(points) +
                                                 " points do not fit the basis' step of " +
                                                 std::to_string(curves.step)};
    }
}

}  // namespace
}  // namespace trapeze::ri

using namespace trapeze::ri;

RtVoid RiPointsV(RtInt npoints, RtInt n, RtToken tokens[], RtPointer values[]) {
    call("RiPoints", [&](Context& context) {
        if (npoints < 1) throw CallError{RIE_RANGE, "there are no points"};
        const auto parameters =
            checked_parameters(context, {n, tokens, values}, variable_counts(trapeze::Points{npoints}));
        context.writer().request("Points");
        write_parameters(context.writer(), parameters);
    });
}

RtVoid RiCurvesV(RtToken type, RtInt ncurves, RtInt nvertices[], RtToken wrap, RtInt n, RtToken tokens[],
                 RtPointer values[]) {
    call("RiCurves", [&](Context& context) {
        trapeze::Curves curves;
        curves.cubic = is_first_of(type, "cubic", "linear");
        curves.periodic = is_first_of(wrap, "periodic", "nonperiodic");
        curves.step = context.counting.v_step;
        const auto counts = array_of(nvertices, ncurves, "curves");
        sum_of(counts, 2, "points of a curve");
        curves.vertices_per_curve.assign(counts.begin(), counts.end());
        check_curves(curves);
        const auto parameters = checked_parameters(context, {n, tokens, values}, variable_counts(curves));
        context.writer().request("Curves");
        context.writer().string(type);
        context.writer().integers(counts);
        context.writer().string(wrap);
        write_parameters(context.writer(), parameters);
    });
}

RtVoid RiBlobbyV(RtInt nleaf, RtInt ncode, RtInt code[], RtInt nfloats, RtFloat floats[], RtInt nstrings,
                 RtString strings[], RtInt n, RtToken tokens[], RtPointer values[]) {
    call("RiBlobby", [&](Context& context) {
        if (nleaf < 0) throw CallError{RIE_RANGE, "the number of leaves is negative"};
        const auto operations = array_of(code, ncode, "code");
        const auto numbers = array_of(floats, nfloats, "floats");
        const std::vector<std::string> texts = strings_of(strings, nstrings, "strings");
        trapeze::Blobby blobby;
        blobby.leaf_count = nleaf;
        const auto parameters = checked_parameters(context, {n, tokens, values}, variable_counts(blobby));
        context.writer().request("Blobby");
        context.writer().number(nleaf);
        context.writer().integers(operations);
        context.writer().numbers(numbers);
        context.writer().strings(texts);
        write_parameters(context.writer(), parameters);
    });
}

RtVoid RiGeometryV(RtToken type, RtInt n, RtToken tokens[], RtPointer values[]) {
    call("RiGeometry", [&](Context& context) {
        required(type, "the type");
        const auto parameters = checked_parameters(context, {n, tokens, values});
        context.writer().request("Geometry");
        context.writer().string(type);
        write_parameters(context.writer(), parameters);
    });
}
