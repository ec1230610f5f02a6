/// The vertices of a grid at one time, each in a vector of four floats, and the boxes of its micropolygons:
/// all builders over micropolygons begin with them.
#pragma once

#include <cstring>
#include <limits>

#include "accel/builders/box_sum.h"
#include "core/grid.h"

namespace trapeze {

/// Vertices of one grid at a time. Made once for many grids, since it is large.
class GridPose {
  public:
    using Lanes = BoxLanes::Lanes;

    /// Takes the vertices of a grid at one of its own keys, in camera space. Returns their largest
    /// coordinate; infinity where one is too large to be bounded, or no number.
    float read(const Grid& grid, int key);

    /// Sets the vertices one by one instead: position(i, j) of each.
    template <class Position>
    void set(const GridShape& shape, const Position& position) {
        shape_ = shape;
        for (int j = 0; j <= shape.nv; ++j)
            for (int i = 0; i <= shape.nu; ++i) {
                const V3f p = position(i, j);
                vertices_[j * kRow + i] = Lanes{p.x, p.y, p.z, 0};
            }
    }

    /// Calls use(i, box) for each micropolygon in the order of rows (u fastest), with the box of its corners:
    /// that of Box3f::extendBy(), which passes over what is no number.
    template <class Use>
    void for_each_box(const Use& use) const {
        for (int v = 0, i = 0; v < shape_.nv; ++v) {
            const Lanes *below = vertices_ + v * kRow, *above = below + kRow;
            LaneBox last(below[0], above[0]);
            for (int u = 1; u <= shape_.nu; ++u, ++i) {
                const LaneBox next(below[u], above[u]);
                use(i, last.joined(next));
                last = next;
            }
        }
    }

    /// Vertex (i, j): x y z, and what nobody reads.
    const Lanes& vertex(int i, int j) const { return vertices_[j * kRow + i]; }

  private:
    static Lanes least(const Lanes& a, const Lanes& b) { return a < b ? a : b; }
    static Lanes most(const Lanes& a, const Lanes& b) { return a > b ? a : b; }

    /// The box of two vertices, one above the other.
    struct LaneBox {
        Lanes low, high;

        LaneBox(const Lanes& a, const Lanes& b) {
            constexpr float kMost = std::numeric_limits<float>::max();
            const Lanes none{kMost, kMost, kMost, kMost};
            low = least(b, least(a, none)), high = most(b, most(a, -none));
        }
        Box3f joined(const LaneBox& o) const {
            static_assert(sizeof(Box3f) == 6 * sizeof(float), "minima before maxima, nothing between");
            const Lanes all_low = least(low, o.low), all_high = most(high, o.high);
            const Lanes first = __builtin_shufflevector(all_low, all_high, 0, 1, 2, 4);
            const Lanes rest = __builtin_shufflevector(all_high, all_high, 1, 2, 1, 2);
            Box3f box;
            std::memcpy(&box.min.x, &first, sizeof first);
            std::memcpy(&box.max.y, &rest, 2 * sizeof(float));
            return box;
        }
    };

    static constexpr int kRow = (kMaxGridSide + 4) / 4 * 4;  ///< whole tiles are read

    GridShape shape_;
    Lanes vertices_[(kMaxGridSide + 1) * kRow];
};

}  // namespace trapeze
