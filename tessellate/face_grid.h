/// The topology of surfaces made of columns x rows of faces (quadrics, patch meshes): which edges and
/// vertices they share, when they close on themselves, and where a side is but one point (poles).
#pragma once

#include "tessellate/surface.h"

namespace trapeze {

/// Face (i, j) is face j * columns + i. Edges along u come first: columns of them for each row of vertices,
/// then those along v: rows of them for each column of vertices.
struct FaceGrid {
    int columns = 1, rows = 1;
    bool u_wraps = false, v_wraps = false;
    bool bottom_is_point = false, top_is_point = false;  ///< not with v_wraps
    bool left_is_point = false, right_is_point = false;  ///< not with u_wraps

    int face_count() const { return columns * rows; }
    uint32_t edge_count() const {
        return static_cast<uint32_t>(columns * vertex_rows() + rows * vertex_columns());
    }
    uint32_t vertex_count() const { return static_cast<uint32_t>(vertex_columns() * vertex_rows()); }

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
    int vertex_columns() const { return u_wraps ? columns : columns + 1; }
    int vertex_rows() const { return v_wraps ? rows : rows + 1; }
    uint32_t edge_along_u(int i, int j) const {
        return static_cast<uint32_t>(j % vertex_rows() * columns + i);
    }
    uint32_t edge_along_v(int i, int j) const {
        return static_cast<uint32_t>(columns * vertex_rows() + i % vertex_columns() * rows + j);
    }
    /// A pole's row or column has one vertex, its first.
    uint32_t vertex_at(int i, int j) const;
};

}  // namespace trapeze
