/// Polygon meshes (RISpec 5.1): flat faces, bilinear or linear on each. Their u and v are x and y in object
/// space.
#include <algorithm>
#include <numeric>

#include "core/polygon_lean.h"
#include "tessellate/surfaces/face_evaluation.h"
#include "tessellate/surfaces/net_lattices.h"
#include "tessellate/surfaces/surface_variables.h"
#include "tessellate/topology/mesh_topology.h"
#include "tessellate/topology/polygon_faces.h"
#include "tessellate/topology/topology_surface.h"

namespace trapeze {
namespace {

/// With normals of its own a mesh is shaded smooth; only such as are numbers, three each, count.
bool has_normals(const ParameterList& variables) {
    const Parameter* N = variables.find("N");
    return N && N->declaration.floats_per_item() == 3 && !N->is_string();
}

/// What u and v of faces are: x and y in object space, or, for meshes that stand for a curved surface, the
/// parameters of the face's own square.
enum class FaceParameters { PlaceInObject, OwnSquare };

/// A polygon mesh cut into faces of three and four corners; a triangle's face is cut into three squares.
class PolygonSurface : public TopologySurface<PolygonSurface> {
  public:
    PolygonSurface(const Primitive& primitive, PolygonFaces faces, FaceParameters parameters)
        : primitive_(primitive),
          faces_(std::move(faces)),
          topology_(faces_.sizes, faces_.vertices,
                    std::get<PolygonMesh>(primitive.shape().topology).vertex_count, 4, {}),
          parameters_(parameters) {
        for (const auto& shape : primitive.shape_keys)
            positions_.push_back(shape->variables.find("P")->floats.data());
        const ParameterList& variables = primitive.shape().variables;
        is_faceted_ = !has_normals(variables);
    }

    const MeshTopology& topology() const { return topology_; }
    bool is_faceted() const override { return is_faceted_; }
    bool has_straight_lines() const override { return true; }
    bool is_linear(int face) const override { return topology_.piece(face).cut; }

    void evaluate(int face, std::span<const V2f> uv, int shape_key, SurfaceScratch* scratch, std::span<V3f> P,
                  std::span<V3f> dPdu, std::span<V3f> dPdv) const override;
    bool evaluate_variables(int face, std::span<const V2f> uv, SurfaceScratch* scratch,
                            ShadingGrid& grid) const override;
    Box3f bound(int face, V2f lo, V2f hi, int shape_key) const override;
    bool has_lattices() const override { return true; }
    void lattices(int first, int count, int shape_key, bool beside, FaceLattices& lattices) const override;

  private:
    class Values;

    /// Positions at the corners of a mesh face.
    std::array<float, 12> corner_positions(const FacePiece& piece, int shape_key) const;
    /// Object-space x and y of points of a face.
    void set_places(int face, std::span<const V2f> uv, std::span<float> x, std::span<float> y) const;
    /// Whether derivatives by x and y mean anything: not on faces nearly parallel to the z axis
    /// (core/polygon_lean.h).
    bool has_place_derivatives(int face) const;
    void differentiate_by_places(int face, V2f at, ShadingGrid& grid) const;

    const Primitive& primitive_;
    PolygonFaces faces_;
    MeshTopology topology_;
    std::vector<const float*> positions_;  ///< by shape key
    FaceParameters parameters_;
    bool is_faceted_ = true;
};

std::array<float, 12> PolygonSurface::corner_positions(const FacePiece& piece, int shape_key) const {
    // Up to four corners of three floats, in the order of the mesh face.
    std::array<float, 12> positions{};
    const std::span<const int> vertices = topology_.face_vertices(piece.mesh_face);
    for (size_t i = 0; i < vertices.size(); ++i)
        std::copy_n(positions_[shape_key] + 3 * static_cast<size_t>(vertices[i]), 3,
                    positions.data() + 3 * i);
    return positions;
}

void PolygonSurface::evaluate(int face, std::span<const V2f> uv, int shape_key, SurfaceScratch*,
                              std::span<V3f> P, std::span<V3f> dPdu, std::span<V3f> dPdv) const {
    const FacePiece piece = topology_.piece(face);
    const std::array<float, 12> positions = corner_positions(piece, shape_key);
    evaluate_linear_piece(piece, positions.data(), 3, uv, sink_of(P), sink_of(dPdu), sink_of(dPdv));
}

Box3f PolygonSurface::bound(int face, V2f lo, V2f hi, int shape_key) const {
    const FacePiece piece = topology_.piece(face);
    float corners[12];
    piece_corners(piece, corner_positions(piece, shape_key).data(), 3, corners);
    return bilinear_bound(corners, lo, hi);
}

/// Faces that are cut, or those that are not, as the first one is.
void PolygonSurface::lattices(int first, int count, int shape_key, bool beside,
                              FaceLattices& lattices) const {
    const bool cut = topology_.piece(first).cut;
    lattices.runs = cut ? FaceRuns::Piece : FaceRuns::Round;
    lattices.there = 0;
    NetLanes nets;
    float corners[12];
    for (int i = 0; i < FaceLattices::kFaces; ++i) {
        // Lanes without a face are as the one before.
        const FacePiece piece = topology_.piece(first + std::min(i, count - 1));
        if (piece.cut == cut) {
            piece_corners(piece, corner_positions(piece, shape_key).data(), 3, corners);
            lattices.there |= i < count ? 1u << i : 0u;
        }
        for (int p = 0; p < 4; ++p) nets.set(p, i, corners + 3 * p);
    }
    net_lattices(nets, NetForm::Corners, beside, lattices);
}

/// Values of variables on one face, by the class that says which of the primitive's numbers are its corners'.
class PolygonSurface::Values : public VariableSource {
  public:
    Values(const PolygonSurface& surface, int face, std::span<const V2f> uv)
        : surface_(surface), piece_(surface.topology_.piece(face)), uv_(uv) {}

    void component(const Parameter& parameter, int component, std::span<float> values) const override {
        const size_t stride = parameter.declaration.floats_per_item();
        // A triangle uses three of them; its pieces are linear in those.
        float corners[4] = {};
        for (int i = 0; i < piece_.size; ++i)
            corners[i] = parameter.floats[item(parameter, i) * stride + component];
        values_on_piece(piece_, corners, uv_, values);
    }

    /// Variables without values in between (strings) are those of a face's first corner.
    size_t uniform_index(const Parameter& parameter) const override { return item(parameter, 0); }

  private:
    /// Which of the parameter's values belongs to a corner of the face.
    size_t item(const Parameter& parameter, int corner) const {
        const int number = surface_.topology_.first_corner(piece_.mesh_face) + corner;
        switch (parameter.declaration.storage) {
            case StorageClass::Constant:
                return 0;
            case StorageClass::Uniform:
                return surface_.faces_.polygons[piece_.mesh_face];
            case StorageClass::Varying:
            case StorageClass::Vertex:
                return surface_.faces_.vertices[number];
            case StorageClass::FaceVarying:
            case StorageClass::FaceVertex:
                return surface_.faces_.corners[number];
        }
        return 0;
    }

    const PolygonSurface& surface_;
    FacePiece piece_;
    std::span<const V2f> uv_;
};

/// x and y in object space.
void PolygonSurface::set_places(int face, std::span<const V2f> uv, std::span<float> x,
                                std::span<float> y) const {
    const FacePiece piece = topology_.piece(face);
    const std::array<float, 12> positions = corner_positions(piece, 0);
    float corners[4];
    for (const auto& [axis, places] : {std::pair(0, x), std::pair(1, y)}) {
        for (int i = 0; i < 4; ++i) corners[i] = positions[3 * i + axis];
        values_on_piece(piece, corners, uv, places);
    }
}

/// As the shutter opens, where shading happens. Twice the face's area along its normal is the cross product
/// of a quad's diagonals, or of a triangle's two sides.
bool PolygonSurface::has_place_derivatives(int face) const {
    const FacePiece piece = topology_.piece(face);
    const std::array<float, 12> positions = corner_positions(piece, 0);
    const auto corner = [&](int i) {
        return V3d(positions[3 * i], positions[3 * i + 1], positions[3 * i + 2]);
    };
    const int last = piece.size - 1;  // of a quad these are the diagonals
    return trapeze::has_place_derivatives((corner(2) - corner(0)).cross(corner(last) - corner(1)));
}

/// dPdu and dPdv from those by the face's own parameters, by the chain rule: the same all over the face,
/// which is flat. `at`: of the grid's first vertex.
void PolygonSurface::differentiate_by_places(int face, V2f at, ShadingGrid& grid) const {
    const FacePiece piece = topology_.piece(face);
    V3f P, du, dv;
    evaluate_linear_piece(piece, corner_positions(piece, 0).data(), 3, {&at, 1}, sink_of({&P, 1}),
                          sink_of({&du, 1}), sink_of({&dv, 1}));
    // Of the matrix from (u, v) of the face to (x, y).
    const double determinant = double{du.x} * dv.y - double{dv.x} * du.y;
    if (determinant == 0 || grid.dPdu.size() == 0) return;
    const V3d by_u(grid.dPdu.at(0)), by_v(grid.dPdv.at(0));
    const size_t count = grid.dPdu.size();
    grid.dPdu.fill(count, V3f((by_u * double{dv.y} - by_v * double{du.y}) / determinant));
    grid.dPdv.fill(count, V3f((by_v * double{du.x} - by_u * double{dv.x}) / determinant));
}

/// RISpec gives polygons the x and y of object space for u, v, s and t, whatever the faces' own squares are.
bool PolygonSurface::evaluate_variables(int face, std::span<const V2f> uv, SurfaceScratch*,
                                        ShadingGrid& grid) const {
    const bool by_place = parameters_ == FaceParameters::PlaceInObject;
    set_places(face, uv, grid.s, grid.t);
    for (size_t i = 0; i < uv.size(); ++i) {
        grid.u[i] = by_place ? grid.s[i] : uv[i].x;
        grid.v[i] = by_place ? grid.t[i] : uv[i].y;
    }
    // Where derivatives by place mean nothing, those by the face's own square stay.
    if (by_place && has_place_derivatives(face)) differentiate_by_places(face, uv[0], grid);
    return set_variables(primitive_.shape().variables, Values(*this, face, uv), grid);
}

/// Whether the counts agree with each other, so that nothing is read outside its array.
bool is_consistent(const PolygonMesh& mesh) {
    const auto sum = [](const std::vector<int>& counts) {
        return std::accumulate(counts.begin(), counts.end(), size_t{0});
    };
    const auto negative = [](int n) { return n < 0; };
    if (std::any_of(mesh.loops_per_polygon.begin(), mesh.loops_per_polygon.end(), negative)) return false;
    if (std::any_of(mesh.vertices_per_loop.begin(), mesh.vertices_per_loop.end(), negative)) return false;
    return sum(mesh.loops_per_polygon) == mesh.vertices_per_loop.size() &&
           sum(mesh.vertices_per_loop) == mesh.vertices.size() &&
           std::all_of(mesh.vertices.begin(), mesh.vertices.end(),
                       [&](int v) { return v >= 0 && v < mesh.vertex_count; });
}

/// Whether all shape keys have positions for all vertices and counts agree; else an error.
bool is_valid(const Primitive& primitive, Diagnostics& diagnostics) {
    const PolygonMesh& mesh = std::get<PolygonMesh>(primitive.shape().topology);
    for (const auto& shape : primitive.shape_keys) {
        const Parameter* P = shape->variables.find("P");
        if (P && P->floats.size() >= 3 * static_cast<size_t>(mesh.vertex_count)) continue;
        diagnostics.error(primitive.location, "Polygon: has no vertex positions P; skipped",
                          "polygon-points");
        return false;
    }
    if (!is_consistent(mesh)) {
        diagnostics.error(primitive.location, "Polygon: its counts do not agree; skipped", "polygon-counts");
        return false;
    }
    return true;
}

/// Null where nothing has an area, with a warning and no error: the picture is right without it.
std::unique_ptr<Surface> surface_of(const Primitive& primitive, PolygonFaces faces, FaceParameters parameters,
                                    Diagnostics& diagnostics) {
    if (faces.sizes.empty()) {
        diagnostics.warning(primitive.location, "Polygon: has no area; skipped", "polygon-empty");
        return nullptr;
    }
    return std::make_unique<PolygonSurface>(primitive, std::move(faces), parameters);
}

}  // namespace

std::unique_ptr<Surface> make_polygon_surface(const Primitive& primitive, Diagnostics& diagnostics) {
    if (!is_valid(primitive, diagnostics)) return nullptr;
    const auto& mesh = std::get<PolygonMesh>(primitive.shape().topology);
    std::vector<std::span<const float>> keys;
    for (const auto& shape : primitive.shape_keys) keys.emplace_back(shape->variables.find("P")->floats);
    return surface_of(primitive, make_polygon_faces(mesh, keys), FaceParameters::PlaceInObject, diagnostics);
}

/// For what makes meshes itself (Blobby): its quads are not flat, and must not be cut.
std::unique_ptr<Surface> make_bilinear_surface(const Primitive& primitive, Diagnostics& diagnostics) {
    if (!is_valid(primitive, diagnostics)) return nullptr;
    return surface_of(primitive, make_whole_faces(std::get<PolygonMesh>(primitive.shape().topology)),
                      FaceParameters::OwnSquare, diagnostics);
}

}  // namespace trapeze
