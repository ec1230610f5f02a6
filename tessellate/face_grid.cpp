#include "tessellate/face_grid.h"

#include <algorithm>

namespace trapeze {

std::array<SurfaceSide, 4> FaceGrid::sides(int face) const {
    const int i = column_of(face), j = row_of(face);
    return {SurfaceSide{edge_along_u(i, j)}, SurfaceSide{edge_along_v(i + 1, j)},
            SurfaceSide{edge_along_u(i, j + 1)}, SurfaceSide{edge_along_v(i, j)}};
}

uint32_t FaceGrid::vertex_at(int i, int j) const {
    i %= vertex_columns(), j %= vertex_rows();
    if ((bottom_is_point && j == 0) || (top_is_point && j == rows)) i = 0;
    if ((left_is_point && i == 0) || (right_is_point && i == columns)) j = 0;
    return static_cast<uint32_t>(j * vertex_columns() + i);
}

EdgeLine FaceGrid::edge(uint32_t edge) const {
    const int number = static_cast<int>(edge), along_u = columns * vertex_rows();
    EdgeLine line;
    if (number < along_u) {
        const int i = number % columns, j = number / columns;
        const int row = std::min(j, rows - 1);
        const float v = static_cast<float>(j - row);
        line.face = row * columns + i;
        line.from = {0, v}, line.to = {1, v};
        line.start = {false, vertex_at(i, j), 0}, line.finish = {false, vertex_at(i + 1, j), 0};
    } else {
        const int i = (number - along_u) / rows, j = (number - along_u) % rows;
        const int column = std::min(i, columns - 1);
        const float u = static_cast<float>(i - column);
        line.face = j * columns + column;
        line.from = {u, 0}, line.to = {u, 1};
        line.start = {false, vertex_at(i, j), 0}, line.finish = {false, vertex_at(i, j + 1), 0};
    }
    return line;
}

SurfacePoint FaceGrid::vertex(uint32_t vertex) const {
    const int i = static_cast<int>(vertex) % vertex_columns(),
              j = static_cast<int>(vertex) / vertex_columns();
    const int column = std::min(i, columns - 1), row = std::min(j, rows - 1);
    return {row * columns + column, {static_cast<float>(i - column), static_cast<float>(j - row)}};
}

}  // namespace trapeze
