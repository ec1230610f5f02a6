/// What stays of a mesh when faces are left out: the mesh's own arrays, its variables and its tags all shrink
/// alike, so that later stages see a mesh that was whole from the beginning.
#include "pipeline/rib/requests/degenerate_faces.h"

#include <algorithm>

#include "pipeline/rib/requests/select_values.h"
#include "pipeline/rib/syntax/arguments.h"

namespace trapeze::rib {
namespace {

/// Walks over a mesh and says what stays of it.
class FaceCheck {
  public:
    FaceCheck(const std::vector<int>& vertices, int vertex_count)
        : vertices_(vertices), vertex_count_(vertex_count), kept_corners_(vertices.size(), 1) {}

    /// The next loop, of so many of the mesh's vertices. A loop with an index outside is dropped whole: a
    /// corner without a point cannot be mended. Corners advance either way, so that loops stay in step with
    /// the arrays.
    bool keeps_next(int count) {
        const auto first = vertices_.begin() + static_cast<std::ptrdiff_t>(corner_), last = first + count;
        const auto outside =
            std::find_if(first, last, [&](int index) { return index < 0 || index >= vertex_count_; });
        if (outside != last && !outside_) outside_ = *outside;
        const bool keeps = count >= 3 && outside == last;
        if (count < 3) ++slivers_;
        if (!keeps) drop_next(count);
        if (keeps) corner_ += static_cast<size_t>(count);
        return keeps;
    }
    /// Corners of a loop that is left out with its face.
    void drop_next(int count) {
        std::fill_n(kept_corners_.begin() + static_cast<std::ptrdiff_t>(corner_), count, char{0});
        corner_ += static_cast<size_t>(count);
    }
    /// To be called once for each face, after its loops.
    void end_face(bool keeps) { kept_faces_.push_back(keeps); }

    /// The common case, in which nothing is copied.
    bool keeps_all() const {
        return std::find(kept_corners_.begin(), kept_corners_.end(), 0) == kept_corners_.end() &&
               std::find(kept_faces_.begin(), kept_faces_.end(), 0) == kept_faces_.end();
    }
    const std::vector<char>& kept_corners() const { return kept_corners_; }
    const std::vector<char>& kept_faces() const { return kept_faces_; }

    /// Slivers are what exporters write; indices beyond the points are damage, and an error. The first such
    /// index is shown.
    void report(RequestReport& report) const {
        const std::string text =
            outside_ ? "vertex " + std::to_string(*outside_) + " is outside of the " +
                           std::to_string(vertex_count_) + " points of \"P\""
                     : std::to_string(slivers_) + " of the faces and holes have fewer than 3 vertices";
        if (std::find(kept_faces_.begin(), kept_faces_.end(), 1) == kept_faces_.end())
            throw RequestError{text, {}};
        if (outside_)
            report.error(text + "; faces that name such are left out");
        else
            report.warn_once(text + "; they are left out", "slivers");
    }

  private:
    const std::vector<int>& vertices_;
    int vertex_count_;
    /// The first corner that has not been looked at.
    size_t corner_ = 0;
    /// Loops of fewer than three vertices.
    size_t slivers_ = 0;
    std::optional<int> outside_;
    /// 0 or 1 for each corner of the mesh, and for each face.
    std::vector<char> kept_corners_, kept_faces_;
};

/// Class uniform goes by faces, the classes of corners by corners; values of points stay, as the points do.
void keep(ParameterList& variables, const FaceCheck& check) {
    for (Parameter& p : variables.values) {
        const StorageClass storage = p.declaration.storage;
        if (storage == StorageClass::Uniform)
            select_items(p, check.kept_faces());
        else if (storage == StorageClass::FaceVarying || storage == StorageClass::FaceVertex)
            select_items(p, check.kept_corners());
    }
}

/// The common case: nothing is wrong with any loop.
bool is_whole(const std::vector<int>& vertices_per_loop, const std::vector<int>& vertices, int vertex_count) {
    return std::all_of(vertices_per_loop.begin(), vertices_per_loop.end(), [](int n) { return n >= 3; }) &&
           std::all_of(vertices.begin(), vertices.end(),
                       [vertex_count](int index) { return index >= 0 && index < vertex_count; });
}

/// A polygon without its outline is none; a hole that is none leaves the polygon whole.
void leave_out(RequestReport& report, PolygonMesh& mesh, ParameterList& variables) {
    FaceCheck check(mesh.vertices, mesh.vertex_count);
    std::vector<int> loops_per_polygon, vertices_per_loop;
    size_t loop = 0;
    for (const int loops : mesh.loops_per_polygon) {
        int kept_loops = 0;
        for (int i = 0; i < loops; ++i, ++loop) {
            const int count = mesh.vertices_per_loop[loop];
            if (i > 0 && kept_loops == 0) {
                check.drop_next(count);
            } else if (check.keeps_next(count)) {
                ++kept_loops;
                vertices_per_loop.push_back(count);
            }
        }
        check.end_face(kept_loops > 0);
        if (kept_loops > 0) loops_per_polygon.push_back(kept_loops);
    }
    if (check.keeps_all()) return;
    check.report(report);
    select_values(mesh.vertices, check.kept_corners());
    mesh.loops_per_polygon = std::move(loops_per_polygon);
    mesh.vertices_per_loop = std::move(vertices_per_loop);
    keep(variables, check);
}

/// Tags that name faces name them by their new numbers. Creases and corners name points, whose numbers stay.
void renumber_faces(std::vector<SubdivisionMesh::Tag>& tags, const std::vector<char>& kept) {
    std::vector<int> number(kept.size(), -1);
    int next = 0;
    for (size_t face = 0; face < kept.size(); ++face)
        if (kept[face]) number[face] = next++;
    for (SubdivisionMesh::Tag& tag : tags) {
        if (tag.name != "hole") continue;
        for (int& face : tag.ints) face = number[static_cast<size_t>(face)];
        std::erase(tag.ints, -1);
    }
}

/// Faces are left out before their topology is built: with a hole where a bad face was, the mesh has a
/// boundary there, and its neighbours round off as at any other.
void leave_out(RequestReport& report, SubdivisionMesh& mesh, ParameterList& variables) {
    FaceCheck check(mesh.vertices, mesh.vertex_count);
    for (const int count : mesh.vertices_per_face) check.end_face(check.keeps_next(count));
    if (check.keeps_all()) return;
    check.report(report);
    renumber_faces(mesh.tags, check.kept_faces());
    select_values(mesh.vertices, check.kept_corners());
    select_values(mesh.vertices_per_face, check.kept_faces());
    keep(variables, check);
}

}  // namespace

/// Meshes alone: shapes of other kinds have no lists of corners that could be wrong.
void leave_out_degenerate_faces(RequestReport& report, Shape& shape) {
    if (auto* polygons = std::get_if<PolygonMesh>(&shape.topology)) {
        const bool has_outlines = std::all_of(polygons->loops_per_polygon.begin(),
                                              polygons->loops_per_polygon.end(), [](int n) { return n > 0; });
        if (!has_outlines ||
            !is_whole(polygons->vertices_per_loop, polygons->vertices, polygons->vertex_count))
            leave_out(report, *polygons, shape.variables);
    } else if (auto* mesh = std::get_if<SubdivisionMesh>(&shape.topology)) {
        if (!is_whole(mesh->vertices_per_face, mesh->vertices, mesh->vertex_count))
            leave_out(report, *mesh, shape.variables);
    }
}

}  // namespace trapeze::rib
