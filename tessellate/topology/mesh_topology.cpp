#include "tessellate/topology/mesh_topology.h"

#include <algorithm>
#include <bit>

namespace trapeze {
namespace {

constexpr V2f kCorners[4] = {{0, 0}, {1, 0}, {1, 1}, {0, 1}};

/// Numbers pairs of vertices in the order of their first use: a hash table with open addressing.
class PairNumbers {
  public:
    explicit PairNumbers(size_t most) : slots_(std::bit_ceil(2 * most + 2), -1) {}

    /// `matches` tells whether a number is that of the pair, `add` gives a new pair its number.
    template <class Matches, class Add>
    int number(uint64_t key, Matches&& matches, Add&& add) {
        uint64_t hash = key * 0x9e3779b97f4a7c15ull;
        hash ^= hash >> 32;
        for (size_t i = hash & (slots_.size() - 1);; i = (i + 1) & (slots_.size() - 1)) {
            if (slots_[i] < 0) return slots_[i] = add();
            if (matches(slots_[i])) return slots_[i];
        }
    }

  private:
    std::vector<int> slots_;
};

}  // namespace

MeshTopology::MeshTopology(std::span<const int> vertices_per_face, std::span<const int> vertices,
                           int vertex_count, int whole_size, std::span<const uint8_t> evaluable)
    : vertices_(vertices), vertices_at_(vertex_count) {
    number_faces(vertices_per_face, whole_size);
    number_edges();
    place(evaluable);
}

/// Faces follow the mesh's order; the pieces of a cut face stand together, so that a piece's number is its
/// distance from the first.
void MeshTopology::number_faces(std::span<const int> vertices_per_face, int whole_size) {
    first_corner_.reserve(vertices_per_face.size() + 1);
    first_spoke_.reserve(vertices_per_face.size() + 1);
    mesh_face_.reserve(vertices_per_face.size());
    int corner = 0, spoke = 0;
    for (int size : vertices_per_face) {
        const int mesh_face = static_cast<int>(first_corner_.size());
        first_corner_.push_back(corner);
        first_spoke_.push_back(spoke);
        corner += size;
        if (size == whole_size) {
            mesh_face_.push_back(mesh_face);
            continue;
        }
        mesh_face_.insert(mesh_face_.end(), size, mesh_face);
        cut_faces_.push_back(mesh_face);
        spoke += size;
    }
    first_corner_.push_back(corner);
    first_spoke_.push_back(spoke);
}

/// A pair of vertices is one edge however many faces name it: three faces at an edge share it all alike.
void MeshTopology::number_edges() {
    PairNumbers numbers(vertices_.size());
    corner_edge_.resize(vertices_.size());
    for (int face = 0; face < mesh_face_count(); ++face) {
        const std::span<const int> corners = face_vertices(face);
        for (size_t i = 0; i < corners.size(); ++i) {
            const int a = corners[i], b = corners[(i + 1) % corners.size()];
            const int low = std::min(a, b), high = std::max(a, b);
            const uint64_t key = static_cast<uint64_t>(low) << 32 | static_cast<uint32_t>(high);
            corner_edge_[first_corner_[face] + i] = numbers.number(
                key,
                [&](int edge) {
                    return std::min(edges_[edge].a, edges_[edge].b) == low &&
                           std::max(edges_[edge].a, edges_[edge].b) == high;
                },
                [&] {
                    edges_.push_back({a, b, {}});
                    return static_cast<int>(edges_.size()) - 1;
                });
        }
    }
}

/// Edges and vertices go to the first face that has a surface, or else to the first face at all.
void MeshTopology::place(std::span<const uint8_t> evaluable) {
    for (const bool any : {false, true})
        for (int face = 0; face < mesh_face_count(); ++face) {
            if (!any && !evaluable.empty() && !evaluable[face]) continue;
            for (int corner = first_corner_[face]; corner < first_corner_[face + 1]; ++corner) {
                const Corner here{face, corner - first_corner_[face]};
                MeshEdge& edge = edges_[corner_edge_[corner]];
                Corner& vertex = vertices_at_[vertices_[corner]];
                if (edge.at.mesh_face < 0) edge.at = here;
                if (vertex.mesh_face < 0) vertex = here;
            }
        }
}

/// Cut faces before this one have as many pieces as spokes, all others one face each.
int MeshTopology::first_face(int mesh_face) const {
    if (cut_faces_.empty()) return mesh_face;
    const auto cut_before =
        std::lower_bound(cut_faces_.begin(), cut_faces_.end(), mesh_face) - cut_faces_.begin();
    return mesh_face - static_cast<int>(cut_before) + first_spoke_[mesh_face];
}

/// Pieces of a cut face are numbered by its corners, whole faces have the number 0.
FacePiece MeshTopology::piece(int face) const {
    FacePiece piece;
    piece.mesh_face = mesh_face_[face];
    piece.size = first_corner_[piece.mesh_face + 1] - first_corner_[piece.mesh_face];
    piece.cut = is_cut(piece.mesh_face);
    if (piece.cut) piece.piece = face - first_face(piece.mesh_face);
    return piece;
}

/// The parameter runs up where the face goes round in the sense of the edge's first use, else down.
SurfaceSide MeshTopology::mesh_side(int mesh_face, int side) const {
    const int corner = first_corner_[mesh_face] + side;
    const int edge = corner_edge_[corner];
    if (edges_[edge].a == vertices_[corner]) return {static_cast<uint32_t>(edge), 0, 1};
    return {static_cast<uint32_t>(edge), 1, 0};
}

/// Sides of a piece are half of a mesh edge each, or a spoke.
std::array<SurfaceSide, 4> MeshTopology::sides(int face) const {
    const FacePiece p = piece(face);
    if (!p.cut) {
        std::array<SurfaceSide, 4> sides;
        for (int i = 0; i < 4; ++i) sides[i] = mesh_side(p.mesh_face, i);
        // The square's corners go round, its sides' low ends do not.
        std::swap(sides[kTop].begin, sides[kTop].end);
        std::swap(sides[kLeft].begin, sides[kLeft].end);
        return sides;
    }
    SurfaceSide bottom = mesh_side(p.mesh_face, p.piece);
    bottom.end = 0.5f;
    SurfaceSide left = mesh_side(p.mesh_face, p.previous());
    left.begin = left.end;
    left.end = 0.5f;
    return {bottom, SurfaceSide{spoke(p.mesh_face, p.piece), 0, 1},
            SurfaceSide{spoke(p.mesh_face, p.previous()), 0, 1}, left};
}

/// Spokes belong to the piece on whose u = 1 they lie.
EdgeLine MeshTopology::edge(uint32_t edge) const {
    EdgeLine line;
    if (edge < spokes_begin()) {
        const MeshEdge& e = edges_[edge];
        const bool forward = vertices_[first_corner_[e.at.mesh_face] + e.at.corner] == e.a;
        line.face = first_face(e.at.mesh_face);
        if (is_cut(e.at.mesh_face)) {
            line.face += e.at.corner;
            line.from = {0, 0}, line.to = {2, 0};
        } else {
            line.from = kCorners[e.at.corner], line.to = kCorners[(e.at.corner + 1) & 3];
        }
        if (!forward) std::swap(line.from, line.to);
        line.start.id = static_cast<uint32_t>(e.a);
        line.finish.id = static_cast<uint32_t>(e.b);
        return line;
    }
    const int number = static_cast<int>(edge - spokes_begin());
    // The last mesh face whose spokes begin at or before it is the cut one: others own none.
    const auto after = std::upper_bound(first_spoke_.begin(), first_spoke_.end(), number);
    const int mesh_face = static_cast<int>(after - first_spoke_.begin()) - 1;
    const int side = number - first_spoke_[mesh_face];
    const auto cut = std::lower_bound(cut_faces_.begin(), cut_faces_.end(), mesh_face) - cut_faces_.begin();
    line.face = first_face(mesh_face) + side;
    line.from = {1, 0}, line.to = {1, 1};
    line.start = {true, static_cast<uint32_t>(corner_edge_[first_corner_[mesh_face] + side]), 0.5f};
    line.finish.id = static_cast<uint32_t>(mesh_vertex_count() + cut);
    return line;
}

/// Centres of cut faces are the corner (1, 1) of the first piece.
SurfacePoint MeshTopology::vertex(uint32_t vertex) const {
    if (vertex >= vertices_at_.size()) {
        const int mesh_face = cut_faces_[vertex - vertices_at_.size()];
        return {first_face(mesh_face), {1, 1}};
    }
    const Corner& at = vertices_at_[vertex];
    if (at.mesh_face < 0) return {};  // belongs to no face
    const int face = first_face(at.mesh_face);
    if (is_cut(at.mesh_face)) return {face + at.corner, {0, 0}};
    return {face, kCorners[at.corner]};
}

}  // namespace trapeze
