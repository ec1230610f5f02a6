#include "sample/rasterize/vertex_rows.h"

#include <algorithm>
#include <cstring>

namespace trapeze {

/// Planes come as [segment][component]. Ids of micropolygons depend on the shape alone, which mostly is the
/// one of the grid before.
void VertexRows::load(const Grid& grid) {
    const GridShape& shape = grid.shape;
    row_length_ = shape.vertices_u(), count_ = shape.vertex_count();
    components_ = grid.moves() ? 6 : 3;
    const int segments = segment_count(grid.key_count);
    vertices_.resize(static_cast<size_t>(segments) * components_ * static_cast<size_t>(padded_count()));
    float* to = vertices_.data();
    for (int segment = 0; segment < segments; ++segment)
        for (int component = 0; component < static_cast<int>(components_); ++component) {
            const float* from = grid.plane(segment, component);
            // Whole quarters of tiles: what runs over a row's end is written over by the next row.
            for (int j = 0; j <= shape.nv; ++j)
                for (int tile = 0; tile < shape.tiles_u(); ++tile)
                    std::memcpy(to + j * row_length_ + tile * 4, from + shape.tiled_index(tile * 4, j),
                                4 * sizeof(float));
            std::fill(to + count_, to + padded_count(), to[count_ - 1]);
            to += padded_count();
        }
    if (shape == shape_) return;
    shape_ = shape;
    quad_ids_.assign(static_cast<size_t>(padded_count()), -1);
    for (int v = 0; v < shape.nv; ++v)
        for (int u = 0; u < shape.nu; ++u) quad_ids_[static_cast<size_t>(v * row_length_ + u)] = v << 4 | u;
}

}  // namespace trapeze
