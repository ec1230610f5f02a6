#include "tessellate/topology/face_grid.h"

#include <algorithm>

namespace trapeze {

/// Without tears nothing is stored: a line for each face and, unless the last is the first, one more.
int FaceLines::count(int faces, bool wraps) const {
    if (!owner_.empty()) return static_cast<int>(owner_.size());
    return wraps ? faces : faces + 1;
}

int FaceLines::high(int face, int faces, bool wraps) const {
    if (!high_.empty()) return high_[face];
    return wraps && face + 1 == faces ? 0 : face + 1;
}

/// The face that begins at the line, so that shared edges are evaluated at u = 0 or v = 0; only the last line
/// has to be the end of a face.
std::pair<int, int> FaceLines::face_at(int line, int faces) const {
    if (!owner_.empty()) return owner_[line];
    const int face = std::min(line, faces - 1);
    return {face, line - face};
}

/// Called once, while the surface is made.
void FaceLines::tear(const std::vector<bool>& torn, bool wraps) {
    if (std::ranges::find(torn, true) == torn.end()) return;
    const int faces = static_cast<int>(torn.size());
    // A torn line becomes two: one that ends the face before, one that begins the next face.
    owner_ = {{0, 0}};
    for (int face = 0; face < faces; ++face) {
        low_.push_back(static_cast<int>(owner_.size()) - 1);
        const bool is_last = face + 1 == faces;
        if (is_last && wraps && !torn[face]) {
            high_.push_back(0);
            continue;
        }
        high_.push_back(static_cast<int>(owner_.size()));
        owner_.emplace_back(face, 1);
        if (!is_last && torn[face]) owner_.emplace_back(face + 1, 0);
    }
}

/// In the order of SideName; no side runs against its edge, as all edges run along growing u or v.
std::array<SurfaceSide, 4> FaceGrid::sides(int face) const {
    const int i = column_of(face), j = row_of(face);
    return {SurfaceSide{edge_along_u(i, v_lines.low(j))},
            SurfaceSide{edge_along_v(u_lines.high(i, columns, u_wraps), j)},
            SurfaceSide{edge_along_u(i, v_lines.high(j, rows, v_wraps))},
            SurfaceSide{edge_along_v(u_lines.low(i), j)}};
}

/// Other vertices of a pole's line have numbers that nothing names.
uint32_t FaceGrid::vertex_at(int u_line, int v_line) const {
    if ((bottom_is_point && v_line == 0) || (top_is_point && v_line == vertex_rows() - 1)) u_line = 0;
    if ((left_is_point && u_line == 0) || (right_is_point && u_line == vertex_columns() - 1)) v_line = 0;
    return static_cast<uint32_t>(v_line * vertex_columns() + u_line);
}

/// At a pole both ends of an edge are the same vertex, though its parameters differ.
EdgeLine FaceGrid::edge(uint32_t edge) const {
    const int number = static_cast<int>(edge), along_u = columns * vertex_rows();
    EdgeLine line;
    uint32_t from, to;
    if (number < along_u) {
        const int i = number % columns, at = number / columns;
        const auto [row, side] = v_lines.face_at(at, rows);
        const float v = static_cast<float>(side);
        line.face = row * columns + i;
        line.from = {0, v}, line.to = {1, v};
        from = vertex_at(u_lines.low(i), at), to = vertex_at(u_lines.high(i, columns, u_wraps), at);
    } else {
        const int at = (number - along_u) / rows, j = (number - along_u) % rows;
        const auto [column, side] = u_lines.face_at(at, columns);
        const float u = static_cast<float>(side);
        line.face = j * columns + column;
        line.from = {u, 0}, line.to = {u, 1};
        from = vertex_at(at, v_lines.low(j)), to = vertex_at(at, v_lines.high(j, rows, v_wraps));
    }
    line.start = {false, from, 0}, line.finish = {false, to, 0};
    return line;
}

SurfacePoint FaceGrid::vertex(uint32_t vertex) const {
    const int u_line = static_cast<int>(vertex) % vertex_columns(),
              v_line = static_cast<int>(vertex) / vertex_columns();
    const auto [column, u] = u_lines.face_at(u_line, columns);
    const auto [row, v] = v_lines.face_at(v_line, rows);
    return {row * columns + column, {static_cast<float>(u), static_cast<float>(v)}};
}

}  // namespace trapeze
