/// Polygons and subdivision meshes (RISpec 5.1, 5.3).
#include <algorithm>
#include <climits>

#include "pipeline/ri/call.h"
#include "pipeline/ri/parameters.h"

namespace trapeze::ri {
namespace {

/// The number of points that vertex indices need: one more than the largest.
int points_for(std::span<const int> indices) {
    int points = 0;
    for (const int index : indices) {
        if (index < 0 || index == INT_MAX)
            throw CallError{RIE_RANGE, "vertex " + std::to_string(index) + " is no index"};
        points = std::max(points, index + 1);
    }
    return points;
}

/// How many values variables of each class have on a mesh; face-varying ones have one for each corner of each
/// face.
VariableCounts mesh_counts(size_t faces, size_t corners, int points) {
    return {static_cast<int>(faces), points, points, static_cast<int>(corners)};
}

void write_mesh(Context& context, const char* request, std::initializer_list<std::span<const int>> arrays,
                const std::vector<RiParameter>& parameters) {
    context.writer().request(request);
    for (const std::span<const int> array : arrays) context.writer().integers(array);
    write_parameters(context.writer(), parameters);
}

/// A subdivision mesh's tags and all of their arguments.
struct Tags {
    std::vector<std::string> names;
    std::span<const int> counts, ints;
    std::span<const float> floats;
};

/// The tags of RiSubdivisionMesh; `counts` has two numbers for each: of its integers and of its floats.
Tags tags_of(RtInt ntags, const RtToken* names, const RtInt* counts, const RtInt* ints,
             const RtFloat* floats) {
    Tags tags;
    tags.names = strings_of(names, ntags, "tags");
    tags.counts = array_of(counts, int64_t{2} * ntags, "the tags' arguments");
    int64_t sums[2] = {0, 0};
    for (size_t i = 0; i < tags.counts.size(); ++i) {
        if (tags.counts[i] < 0) throw CallError{RIE_RANGE, "a tag has a negative number of arguments"};
        sums[i % 2] += tags.counts[i];
    }
    tags.ints = array_of(ints, sums[0], "the tags' integers");
    tags.floats = array_of(floats, sums[1], "the tags' floats");
    return tags;
}

}  // namespace
}  // namespace trapeze::ri

using namespace trapeze::ri;

RtVoid RiPolygonV(RtInt nvertices, RtInt n, RtToken tokens[], RtPointer values[]) {
    call("RiPolygon", [&](Context& context) {
        if (nvertices < 3) throw CallError{RIE_RANGE, "needs 3 vertices or more"};
        const auto corners = static_cast<size_t>(nvertices);
        write_mesh(context, "Polygon", {},
                   checked_parameters(context, {n, tokens, values}, mesh_counts(1, corners, nvertices)));
    });
}

RtVoid RiGeneralPolygonV(RtInt nloops, RtInt nvertices[], RtInt n, RtToken tokens[], RtPointer values[]) {
    call("RiGeneralPolygon", [&](Context& context) {
        const auto loops = array_of(nvertices, nloops, "loops");
        const int points = sum_of(loops, 3, "vertices of a loop");
        const auto corners = static_cast<size_t>(points);
        write_mesh(context, "GeneralPolygon", {loops},
                   checked_parameters(context, {n, tokens, values}, mesh_counts(1, corners, points)));
    });
}

RtVoid RiPointsPolygonsV(RtInt npolys, RtInt nvertices[], RtInt vertices[], RtInt n, RtToken tokens[],
                         RtPointer values[]) {
    call("RiPointsPolygons", [&](Context& context) {
        const auto polygons = array_of(nvertices, npolys, "polygons");
        const auto indices = array_of(vertices, sum_of(polygons, 3, "vertices of a polygon"), "vertices");
        const trapeze::VariableCounts counts =
            mesh_counts(polygons.size(), indices.size(), points_for(indices));
        write_mesh(context, "PointsPolygons", {polygons, indices},
                   checked_parameters(context, {n, tokens, values}, counts));
    });
}

RtVoid RiPointsGeneralPolygonsV(RtInt npolys, RtInt nloops[], RtInt nvertices[], RtInt vertices[], RtInt n,
                                RtToken tokens[], RtPointer values[]) {
    call("RiPointsGeneralPolygons", [&](Context& context) {
        const auto polygons = array_of(nloops, npolys, "polygons");
        const auto loops = array_of(nvertices, sum_of(polygons, 1, "loops of a polygon"), "loops");
        const auto indices = array_of(vertices, sum_of(loops, 3, "vertices of a loop"), "vertices");
        const trapeze::VariableCounts counts =
            mesh_counts(polygons.size(), indices.size(), points_for(indices));
        write_mesh(context, "PointsGeneralPolygons", {polygons, loops, indices},
                   checked_parameters(context, {n, tokens, values}, counts));
    });
}

RtVoid RiSubdivisionMeshV(RtToken scheme, RtInt nfaces, RtInt nvertices[], RtInt vertices[], RtInt ntags,
                          RtToken tags[], RtInt nargs[], RtInt intargs[], RtFloat floatargs[], RtInt n,
                          RtToken tokens[], RtPointer values[]) {
    call("RiSubdivisionMesh", [&](Context& context) {
        required(scheme, "the scheme");
        const auto faces = array_of(nvertices, nfaces, "faces");
        const auto indices = array_of(vertices, sum_of(faces, 3, "vertices of a face"), "vertices");
        const Tags all = tags_of(ntags, tags, nargs, intargs, floatargs);
        const auto parameters = checked_parameters(
            context, {n, tokens, values}, mesh_counts(faces.size(), indices.size(), points_for(indices)));
        trapeze::rib::RibWriter& writer = context.writer();
        writer.request("SubdivisionMesh");
        writer.string(scheme);
        writer.integers(faces), writer.integers(indices);
        if (ntags > 0) {
            writer.strings(all.names);
            writer.integers(all.counts), writer.integers(all.ints), writer.numbers(all.floats);
        }
        write_parameters(writer, parameters);
    });
}
