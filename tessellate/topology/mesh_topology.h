/// How a mesh of polygonal faces becomes a surface of unit squares. A face with as many corners as
/// `whole_size` is one square; any other of n corners is cut into n: piece i has corner i at (0, 0), the
/// midpoint of side i at (1, 0), the face's centre at (1, 1) and the midpoint of side i - 1 at (0, 1).
///
///     whole:  3---2     pieces of a triangle:  2
///             |   |                            | \.
///             0---1                            m2  m1     side i runs from corner i to corner i + 1
///                                              |  C  \.
///                                              0--m0--1
///
/// Edges are pairs of vertices, so that faces which name the same two vertices share them; then come the
/// spokes, from the midpoints of sides to centres, n for each cut face. Vertices are the mesh's, then
/// centres.
///
/// The edge of a cut face is one line on piece i: it goes on to u = 2 at v = 0, over piece i + 1's border.
/// Evaluators of pieces accept that.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "tessellate/topology/surface.h"

namespace trapeze {

/// A unit square as a part of a mesh face.
struct FacePiece {
    int mesh_face = 0;
    int size = 4;   ///< corners of the mesh face
    int piece = 0;  ///< of a cut face
    bool cut = false;
    int next() const { return piece + 1 == size ? 0 : piece + 1; }
    int previous() const { return piece == 0 ? size - 1 : piece - 1; }
};

/// Numbers of faces, edges and vertices, and how they join. Nothing of where they are. Memory is a few
/// integers a corner; pieces are computed from the mesh face's when they are asked for.
class MeshTopology {
  public:
    /// `vertices` outlives the topology. `evaluable[f]`: face f has a surface of its own, so that edges and
    /// vertices are evaluated there rather than on others; empty: all have.
    MeshTopology(std::span<const int> vertices_per_face, std::span<const int> vertices, int vertex_count,
                 int whole_size, std::span<const uint8_t> evaluable);

    int face_count() const { return static_cast<int>(mesh_face_.size()); }
    /// The mesh's own, then the spokes of faces that are cut, from their middles to the middles of their
    /// sides.
    uint32_t edge_count() const { return spokes_begin() + static_cast<uint32_t>(first_spoke_.back()); }
    uint32_t vertex_count() const { return static_cast<uint32_t>(vertices_at_.size() + cut_faces_.size()); }

    /// The part of a mesh face that face number `face` is.
    FacePiece piece(int face) const;
    std::array<SurfaceSide, 4> sides(int face) const;
    EdgeLine edge(uint32_t edge) const;
    SurfacePoint vertex(uint32_t vertex) const;

    int mesh_face_count() const { return static_cast<int>(first_corner_.size()) - 1; }
    int mesh_vertex_count() const { return static_cast<int>(vertices_at_.size()); }
    /// A corner's number among all faces' corners, in the order of the mesh.
    int first_corner(int mesh_face) const { return first_corner_[mesh_face]; }
    /// The vertices at a mesh face's corners, in the order of the mesh.
    std::span<const int> face_vertices(int mesh_face) const {
        return vertices_.subspan(first_corner_[mesh_face],
                                 first_corner_[mesh_face + 1] - first_corner_[mesh_face]);
    }

  private:
    /// A corner of a mesh face; -1: none.
    struct Corner {
        int mesh_face = -1;
        int corner = 0;
    };
    /// An edge of the mesh, between two vertices.
    struct MeshEdge {
        int a = 0, b = 0;  ///< vertices; the edge's parameter runs from a to b
        Corner at;         ///< the side on which it is evaluated
    };

    uint32_t spokes_begin() const { return static_cast<uint32_t>(edges_.size()); }
    bool is_cut(int mesh_face) const { return first_spoke_[mesh_face + 1] != first_spoke_[mesh_face]; }
    /// The first face that is made of a mesh face; its pieces follow.
    int first_face(int mesh_face) const;
    /// Side `side` of a mesh face, from corner `side` to the next.
    SurfaceSide mesh_side(int mesh_face, int side) const;
    uint32_t spoke(int mesh_face, int number) const {
        return spokes_begin() + static_cast<uint32_t>(first_spoke_[mesh_face] + number);
    }
    void number_faces(std::span<const int> vertices_per_face, int whole_size);
    /// Gives each pair of neighbouring vertices one number, in the order of its first use.
    void number_edges();
    void place(std::span<const uint8_t> evaluable);

    std::span<const int> vertices_;
    std::vector<int> first_corner_;  ///< by mesh face, and the end
    std::vector<int> first_spoke_;   ///< by mesh face, and the end
    std::vector<int> mesh_face_;     ///< by face
    std::vector<int> cut_faces_;     ///< mesh faces, ascending
    std::vector<int> corner_edge_;   ///< the side from a corner to the next
    std::vector<MeshEdge> edges_;
    std::vector<Corner> vertices_at_;  ///< where the mesh's vertices are evaluated
};

}  // namespace trapeze
