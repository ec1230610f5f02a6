/// The faces of a Curves primitive: strips of one or a few segments, u across, v along the curve. Faces of a
/// curve share the edges across its joints; a periodic curve's last face ends at the first one's edge.
/// Nothing is kept for an edge or a vertex: their numbers follow from those of the faces.
///
/// Face f has the edges 3 f (u = 0), 3 f + 1 (u = 1) and 3 f + 2 (v = 0), and the vertices 2 f and 2 f + 1 at
/// v = 0. The ends of curves that are not periodic come after those of all faces; where segments do not join
/// every face has an end.
#pragma once

#include <vector>

#include "tessellate/topology/surface.h"

namespace trapeze {

/// Faces, edges and vertices of all curves of a primitive.
class CurveTopology {
  public:
    /// `curves` outlives the topology. `joins`: segments begin where those before them end.
    CurveTopology(const Curves& curves, int segments_per_face, bool joins);

    int face_count() const { return static_cast<int>(curve_of_face_.size()); }
    /// Two along each face, one across where it begins, and one across each end that joins nothing.
    uint32_t edge_count() const { return 3 * faces() + end_count(); }
    uint32_t vertex_count() const { return 2 * (faces() + end_count()); }
    std::array<SurfaceSide, 4> sides(int face) const;
    EdgeLine edge(uint32_t edge) const;
    SurfacePoint vertex(uint32_t vertex) const;
    /// Faces that join nothing, not even themselves.
    bool stands_alone(int face) const;

    /// The segments that one face holds; faces of a curve hold equally many, to within one.
    struct Strip {
        int curve = 0;
        int first = 0, count = 1;  ///< segments
        int all = 1;               ///< the curve's segments
    };
    /// What a face holds; its v runs over the strip's segments evenly.
    Strip strip(int face) const;
    int vertices_of(int curve) const { return curves_.vertices_per_curve[curve]; }
    /// The number of a curve's first value of class vertex; first_varying(): of class varying.
    int first_vertex(int curve) const { return first_vertex_[curve]; }
    int first_varying(int curve) const { return first_varying_[curve]; }

  private:
    uint32_t faces() const { return static_cast<uint32_t>(curve_of_face_.size()); }
    uint32_t end_count() const {
        if (!joins_) return faces();
        return curves_.periodic ? 0 : static_cast<uint32_t>(first_vertex_.size() - 1);
    }
    /// The face that follows; an end, counted like a face, where none does.
    uint32_t joint_after(int face) const;
    /// The face whose end that is; ends are counted from 0.
    int face_at_end(uint32_t end) const { return joins_ ? first_face_[end + 1] - 1 : static_cast<int>(end); }

    const Curves& curves_;
    const bool joins_;
    std::vector<int> first_vertex_, first_varying_, first_face_;  ///< by curve, and the end
    std::vector<int> curve_of_face_;
};

}  // namespace trapeze
