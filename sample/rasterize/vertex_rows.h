/// A grid's vertices out of their tiles: row by row, so that vector lanes run along rows and on to the next.
#pragma once

#include <cstddef>
#include <vector>

#include "core/grid.h"

namespace trapeze {

/// One grid at a time; memory is reused. One per thread.
class VertexRows {
  public:
    /// Planes can be read this many floats past the last vertex; what is there repeats it.
    static constexpr int kPadding = 32;

    /// Copies the positions of all segments of a grid, and finds its micropolygons.
    void load(const Grid& grid);

    /// Vertex (i, j) is at j * row_length() + i; so is the micropolygon whose 00 it is.
    int row_length() const { return row_length_; }
    int vertex_count() const { return count_; }
    /// One past the last micropolygon. Between are ends of rows, which are none.
    int quad_end() const { return count_ - row_length_ - 1; }
    int padded_count() const { return count_ + kPadding; }

    /// Components as those of Grid::plane().
    const float* plane(int segment, int component) const {
        return vertices_.data() +
               (static_cast<size_t>(segment) * components_ + component) * static_cast<size_t>(padded_count());
    }
    /// v << 4 | u of each micropolygon, -1 where there is none. Padded as planes are.
    const int32_t* quad_ids() const { return quad_ids_.data(); }

  private:
    int row_length_ = 0, count_ = 0;
    size_t components_ = 3;
    GridShape shape_{0, 0};  ///< that quad_ids_ is for
    std::vector<float> vertices_;
    std::vector<int32_t> quad_ids_;
};

}  // namespace trapeze
