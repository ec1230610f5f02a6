/// The topology of surfaces made of columns x rows of faces (quadrics, patch meshes): which edges and
/// vertices they share, when they close on themselves, where they are torn, and where a side is but one point
/// (poles).
#pragma once

#include <vector>

#include "tessellate/topology/surface.h"

namespace trapeze {

/// The lines at which faces along one axis begin and end. Neighbours share a line where the surface is not
/// torn. It does not keep the number of faces or whether they wrap: FaceGrid does, and passes both.
class FaceLines {
  public:
    /// Lines along an axis of so many faces.
    int count(int faces, bool wraps) const;
    /// The line at which a face begins.
    int low(int face) const { return low_.empty() ? face : low_[face]; }
    /// The line at which a face ends; low(): at which it begins.
    int high(int face, int faces, bool wraps) const;
    /// A face at the line, and on which of its sides that is: 0 or 1.
    std::pair<int, int> face_at(int line, int faces) const;

    /// torn[i]: face i does not meet the next one (after the last: the first, where the surface wraps).
    void tear(const std::vector<bool>& torn, bool wraps);

  private:
    std::vector<int> low_, high_;             ///< by face; empty: not torn
    std::vector<std::pair<int, int>> owner_;  ///< by line
};

/// Columns x rows of faces. Face (i, j) is face j * columns + i. Edges along u come first: columns of them
/// for each line of vertices, then those along v: rows of them for each line of vertices.
struct FaceGrid {
    int columns = 1, rows = 1;
    bool u_wraps = false, v_wraps = false;
    bool bottom_is_point = false, top_is_point = false;  ///< not with v_wraps
    bool left_is_point = false, right_is_point = false;  ///< not with u_wraps
    FaceLines u_lines, v_lines;                          ///< torn when all of the above is set

    int face_count() const { return columns * rows; }
    uint32_t edge_count() const {
        return static_cast<uint32_t>(columns * vertex_rows() + rows * vertex_columns());
    }
    uint32_t vertex_count() const { return static_cast<uint32_t>(vertex_columns() * vertex_rows()); }

    /// What Surface asks for. Every edge runs the way of u or v, so that sides run along theirs.
    std::array<SurfaceSide, 4> sides(int face) const;
    EdgeLine edge(uint32_t edge) const;
    SurfacePoint vertex(uint32_t vertex) const;

    int column_of(int face) const { return face % columns; }
    int row_of(int face) const { return face / columns; }
    /// Whole-surface parameters, 0..1, of a face's point.
    V2f surface_uv(int face, V2f uv) const {
        return {(static_cast<float>(column_of(face)) + uv.x) / static_cast<float>(columns),
                (static_cast<float>(row_of(face)) + uv.y) / static_cast<float>(rows)};
    }

  private:
    /// Lines on which vertices lie: one more than faces, as many where the grid wraps, and one more for each
    /// tear.
    int vertex_columns() const { return u_lines.count(columns, u_wraps); }
    int vertex_rows() const { return v_lines.count(rows, v_wraps); }
    uint32_t edge_along_u(int i, int line) const { return static_cast<uint32_t>(line * columns + i); }
    uint32_t edge_along_v(int line, int j) const {
        return static_cast<uint32_t>(columns * vertex_rows() + line * rows + j);
    }
    /// The vertex where two lines of vertices meet. A pole's line has one vertex, its first.
    uint32_t vertex_at(int u_line, int v_line) const;
};

}  // namespace trapeze
