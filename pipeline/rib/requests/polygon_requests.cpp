/// RISpec 5.1, 5.3: polygons and subdivision meshes.
#include <algorithm>
#include <numeric>
#include <type_traits>

#include "pipeline/rib/requests/degenerate_faces.h"
#include "pipeline/rib/requests/primitive_variables.h"
#include "pipeline/rib/requests/request_table.h"

namespace trapeze::rib {
namespace {

/// Sums that cannot overflow: counts come from strangers.
int64_t checked_sum(const std::vector<int>& counts, int smallest, const char* what) {
    int64_t sum = 0;
    for (const int count : counts) {
        if (count < smallest)
            throw RequestError{std::string(what) + " has " + std::to_string(count) + ", needs at least " +
                                   std::to_string(smallest),
                               {}};
        sum += count;
    }
    return sum;
}

/// Leaves out what is too much, with an error. Throws a RequestError that says how many numbers there should
/// be where there are fewer.
void expect_length(GeometryContext& r, std::vector<int>& numbers, int64_t wanted, const char* what) {
    const auto got = static_cast<int64_t>(numbers.size());
    if (got == wanted) return;
    const std::string problem =
        std::string(what) + " has " + std::to_string(got) + " numbers, needs " + std::to_string(wanted);
    if (got < wanted) throw RequestError{problem, {}};
    r.report.error(problem + "; the rest is left out");
    numbers.resize(static_cast<size_t>(wanted));
}

/// What is wrong with a tag; empty when nothing is. RISpec 5.3: a crease is a chain of n vertices with one
/// sharpness or n - 1, a corner any n vertices with one or n; a hole names faces and has no sharpness.
std::string problem_of(const SubdivisionMesh::Tag& tag, const SubdivisionMesh& mesh) {
    const bool crease = tag.name == "crease", corner = tag.name == "corner", hole = tag.name == "hole";
    if (!crease && !corner && !hole) return {};
    if (crease && tag.ints.size() < 2) return "needs two vertices or more";
    const size_t sharp = tag.ints.size() - (crease ? 1 : 0);
    if (!hole && tag.floats.size() != 1 && tag.floats.size() != sharp)
        return "has " + std::to_string(tag.floats.size()) + " floats, needs 1 or " + std::to_string(sharp);
    const int count = hole ? static_cast<int>(mesh.vertices_per_face.size()) : mesh.vertex_count;
    for (const int index : tag.ints)
        if (index < 0 || index >= count)
            return "names " + std::string(hole ? "face " : "vertex ") + std::to_string(index) + " of " +
                   std::to_string(count);
    return {};
}

/// A wrong tag costs itself. Tags of unknown names are kept for later stages to pass over. Before faces are
/// left out, as tags name faces by the file's numbers.
void check_tags(GeometryContext& r, SubdivisionMesh& mesh) {
    std::erase_if(mesh.tags, [&](const SubdivisionMesh::Tag& tag) {
        const std::string problem = problem_of(tag, mesh);
        if (!problem.empty())
            r.report.error("tag " + in_quotes(tag.name) + " " + problem + "; the tag is left out");
        return !problem.empty();
    });
}

/// Faces as files count them: a polygon with its holes is one.
uint64_t face_count(const PolygonMesh& mesh) {
    return mesh.loops_per_polygon.size();
}

uint64_t face_count(const SubdivisionMesh& mesh) {
    return mesh.vertices_per_face.size();
}

/// Reads the variables of a mesh whose points are counted by its "P". The vertex count is that of "P", not
/// the largest index and one: points that no face uses still have values of class vertex.
template <class Mesh>
void add_mesh(GeometryContext& r, ArgumentCursor& c, const char* request, Mesh mesh) {
    if (face_count(mesh) == 0) throw RequestError{"has no faces", {}};
    ParameterList list = read_variables_with_points(r, c, PointForm::Mesh);
    mesh.vertex_count = point_count_of(list);
    if constexpr (std::is_same_v<Mesh, SubdivisionMesh>) check_tags(r, mesh);
    Shape shape{std::move(mesh), {}};
    shape.variables = checked_variables(r.report, std::move(list), shape.topology);
    leave_out_degenerate_faces(r.report, shape);
    const uint64_t faces = face_count(std::get<Mesh>(shape.topology));
    r.add_shape(request, std::move(shape), faces);
}

/// One polygon of consecutive points. Polygon and GeneralPolygon become meshes of one face, so that later
/// stages know one kind of polygon.
PolygonMesh consecutive(std::vector<int> loops) {
    PolygonMesh mesh;
    mesh.loops_per_polygon = {static_cast<int>(loops.size())};
    mesh.vertices.resize(static_cast<size_t>(std::accumulate(loops.begin(), loops.end(), int64_t{0})));
    std::iota(mesh.vertices.begin(), mesh.vertices.end(), 0);
    mesh.vertices_per_loop = std::move(loops);
    return mesh;
}

/// Polygon parameters: its vertices are the points of "P", in their order.
void polygon(GeometryContext& r, ArgumentCursor& c) {
    ParameterList list = read_variables(r, c, PointForm::Mesh);
    const int points = point_count_of(list);
    if (points < 3)
        throw RequestError{"\"P\" has " + std::to_string(points) + " points, needs at least 3", {}};
    PolygonMesh mesh = consecutive({points});
    mesh.vertex_count = points;
    Shape shape{std::move(mesh), {}};
    shape.variables = checked_variables(r.report, std::move(list), shape.topology);
    r.add_shape("Polygon", std::move(shape), 1);
}

/// GeneralPolygon [vertices of each loop] parameters: an outline, then holes, of consecutive points. Unlike a
/// mesh of many it is an error when the outline is none, as nothing is left to draw.
void general_polygon(GeometryContext& r, ArgumentCursor& c) {
    std::vector<int> loops = c.int_array("the loops");
    const int64_t sum = checked_sum(loops, 0, "a loop");
    ParameterList list = read_variables(r, c, PointForm::Mesh);
    const int points = point_count_of(list);
    if (points != sum)
        throw RequestError{"\"P\" has " + std::to_string(points) + " points, needs " + std::to_string(sum),
                           {}};
    if (loops.empty()) throw RequestError{"has no loops", {}};
    PolygonMesh mesh = consecutive(std::move(loops));
    mesh.vertex_count = points;
    Shape shape{std::move(mesh), {}};
    shape.variables = checked_variables(r.report, std::move(list), shape.topology);
    leave_out_degenerate_faces(r.report, shape);
    r.add_shape("GeneralPolygon", std::move(shape), 1);
}

/// PointsPolygons [vertices of each face] [indices of points] parameters.
void points_polygons(GeometryContext& r, ArgumentCursor& c) {
    PolygonMesh mesh;
    mesh.vertices_per_loop = c.int_array("the numbers of vertices");
    mesh.loops_per_polygon.assign(mesh.vertices_per_loop.size(), 1);
    mesh.vertices = c.int_array("the vertices");
    expect_length(r, mesh.vertices, checked_sum(mesh.vertices_per_loop, 0, "a polygon"),
                  "the array of vertices");
    add_mesh(r, c, "PointsPolygons", std::move(mesh));
}

/// PointsGeneralPolygons [loops of each face] [vertices of each loop] [indices of points] parameters.
void points_general_polygons(GeometryContext& r, ArgumentCursor& c) {
    PolygonMesh mesh;
    mesh.loops_per_polygon = c.int_array("the numbers of loops");
    mesh.vertices_per_loop = c.int_array("the numbers of vertices");
    mesh.vertices = c.int_array("the vertices");
    expect_length(r, mesh.vertices_per_loop, checked_sum(mesh.loops_per_polygon, 0, "a polygon"),
                  "the numbers of vertices");
    expect_length(r, mesh.vertices, checked_sum(mesh.vertices_per_loop, 0, "a loop"),
                  "the array of vertices");
    add_mesh(r, c, "PointsGeneralPolygons", std::move(mesh));
}

/// Tags, numbers of their arguments (two or, with strings, three for each tag), integers, floats, strings.
/// The arguments of all tags stand one after another in three common arrays; each tag takes its next ones
/// from each of them.
std::vector<SubdivisionMesh::Tag> subdivision_tags(GeometryContext& r, ArgumentCursor& c) {
    const std::vector<std::string> names = c.string_array("the tags");
    std::vector<int> counts = c.int_array("the tags' numbers of arguments");
    if (counts.empty()) counts.resize(2 * names.size());  // tags without arguments, as some files have it
    const std::vector<int> ints = c.int_array("the tags' integers");
    const std::vector<float> floats = c.number_array("the tags' floats");
    const size_t per_tag = names.empty() ? 2 : counts.size() / names.size();
    if (!names.empty() && (counts.size() % names.size() != 0 || (per_tag != 2 && per_tag != 3)))
        throw RequestError{"the tags' numbers of arguments has " + std::to_string(counts.size()) +
                               " numbers, needs 2 or 3 for each of " + std::to_string(names.size()) + " tags",
                           {}};
    std::vector<std::string> strings;
    if (c.next_is_array() && c.peek()->floats.empty()) strings = c.string_array("the tags' strings");
    size_t at[3] = {0, 0, 0};
    const size_t sizes[3] = {ints.size(), floats.size(), strings.size()};
    std::vector<SubdivisionMesh::Tag> tags;
    for (size_t i = 0; i < names.size(); ++i) {
        SubdivisionMesh::Tag tag;
        tag.name = names[i];
        for (size_t k = 0; k < per_tag; ++k) {
            const int count = counts[i * per_tag + k];
            if (count < 0 || at[k] + static_cast<size_t>(count) > sizes[k]) {
                r.report.error("tag " + in_quotes(names[i]) +
                               " wants more arguments than there are; it and those after it are left out");
                return tags;
            }
            const auto from = static_cast<std::ptrdiff_t>(at[k]), to = from + count;
            if (k == 0) tag.ints.assign(ints.begin() + from, ints.begin() + to);
            if (k == 1) tag.floats.assign(floats.begin() + from, floats.begin() + to);
            if (k == 2) tag.strings.assign(strings.begin() + from, strings.begin() + to);
            at[k] += static_cast<size_t>(count);
        }
        tags.push_back(std::move(tag));
    }
    return tags;
}

/// Tags may be left out altogether; a single one may stand without brackets. A parameter's name is never
/// followed by two arrays.
bool has_tags(const ArgumentCursor& c) {
    const Argument* third = c.peek(2);
    return c.next_is_array() || (third && third->kind == Argument::Kind::Array);
}

/// Faces of fewer than three vertices are sorted out later (leave_out_degenerate_faces).
SubdivisionMesh read_subdivision(GeometryContext& r, ArgumentCursor& c) {
    SubdivisionMesh mesh;
    const std::string scheme = c.string("the scheme");
    if (scheme == "catmull-clark")
        mesh.scheme = SubdivisionMesh::Scheme::CatmullClark;
    else if (scheme == "loop")
        mesh.scheme = SubdivisionMesh::Scheme::Loop;
    else if (scheme == "bilinear")
        mesh.scheme = SubdivisionMesh::Scheme::Bilinear;
    else
        throw RequestError{"no scheme " + in_quotes(scheme), {}};
    mesh.vertices_per_face = c.int_array("the numbers of vertices");
    mesh.vertices = c.int_array("the vertices");
    expect_length(r, mesh.vertices, checked_sum(mesh.vertices_per_face, 0, "a face"),
                  "the array of vertices");
    if (mesh.scheme == SubdivisionMesh::Scheme::Loop &&
        std::any_of(mesh.vertices_per_face.begin(), mesh.vertices_per_face.end(),
                    [](int n) { return n > 3; }))
        throw RequestError{"scheme \"loop\" needs triangles", {}};
    if (has_tags(c)) mesh.tags = subdivision_tags(r, c);
    return mesh;
}

/// SubdivisionMesh scheme [vertices of each face] [indices] [tags] [counts] [integers] [floats] parameters.
void subdivision_mesh(GeometryContext& r, ArgumentCursor& c) {
    add_mesh(r, c, "SubdivisionMesh", read_subdivision(r, c));
}

/// PRMan's, whose tags may also edit vertices, edges and faces of finer levels: that is left out.
void hierarchical_subdivision_mesh(GeometryContext& r, ArgumentCursor& c) {
    SubdivisionMesh mesh = read_subdivision(r, c);
    std::erase_if(mesh.tags, [&](const SubdivisionMesh::Tag& tag) {
        const bool is_edit = tag.name.ends_with("edit");
        if (is_edit)
            r.report.warn_once("edits of finer levels are not supported; left out", "hierarchical-edits");
        return is_edit;
    });
    add_mesh(r, c, "HierarchicalSubdivisionMesh", std::move(mesh));
}

constexpr RequestRow kPolygonRequests[] = {
    {"Polygon", polygon},
    {"GeneralPolygon", general_polygon},
    {"PointsPolygons", points_polygons},
    {"PointsGeneralPolygons", points_general_polygons},
    {"SubdivisionMesh", subdivision_mesh},
    {"HierarchicalSubdivisionMesh", hierarchical_subdivision_mesh},
};

}  // namespace

std::span<const RequestRow> polygon_requests() {
    return kPolygonRequests;
}

}  // namespace trapeze::rib
