#include "accel/moving/kd_cells.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <span>

#include "accel/builders/grid_summary.h"
#include "accel/moving/micropolygon_parts.h"
#include "core/hyper_trapezoid.h"

namespace trapeze {
namespace {

/// The axes that may separate a quad from a box, but for those of space, which boxes have looked at. The
/// normal of the plane comes first, then the products of two sides with each axis of space. What is no
/// parallelogram has two further sides: leaving them out makes spans longer, never wrong.
std::array<V3f, 7> separating_axes(const QuadPose& pose) {
    const V3f along_u = pose[1] - pose[0], along_v = pose[2] - pose[0];
    return {along_u.cross(along_v),        V3f(0, along_u.z, -along_u.y), V3f(-along_u.z, 0, along_u.x),
            V3f(along_u.y, -along_u.x, 0), V3f(0, along_v.z, -along_v.y), V3f(-along_v.z, 0, along_v.x),
            V3f(along_v.y, -along_v.x, 0)};
}

/// A quad's corners, coordinate by coordinate: the four are worked on at once.
struct Corners {
    float of_axis[3][4];
};

/// The least and largest of a box along an axis.
struct AxisRange {
    float low = 0, high = 0;
};

AxisRange range_of_box(const Box3f& box, const V3f& axis) {
    AxisRange range;
    for (int k = 0; k < 3; ++k) {
        range.low += axis[k] * (axis[k] > 0 ? box.min[k] : box.max[k]);
        range.high += axis[k] * (axis[k] > 0 ? box.max[k] : box.min[k]);
    }
    return range;
}

}  // namespace

SeparatingAxes::SeparatingAxes(const Grid& grid, const MicropolygonId& id, float pose_time)
    : keys_(grid.key_count) {
    std::array<Corners, kMaxKeyCount> poses;
    for (size_t key = 0; key < keys_; ++key)
        for (size_t c = 0; c < 4; ++c) {
            const V3f p = vertex_of_key(grid, static_cast<int>(key), id.u + static_cast<int>(c & 1),
                                        id.v + static_cast<int>(c >> 1));
            for (int k = 0; k < 3; ++k) {
                poses[key].of_axis[k][c] = p[k];
                largest_ = std::max(largest_, std::abs(p[k]));
            }
        }
    for (const V3f& direction : separating_axes(pose_of(grid, id, pose_time))) {
        // Lengths do not matter, but a product that overflows or vanishes tells nothing.
        const float length = std::abs(direction.x) + std::abs(direction.y) + std::abs(direction.z);
        if (!(length > 1e-15f && length < 1e15f)) continue;
        Axis& axis = axes_[count_++];
        axis.unit = direction / length;
        for (size_t key = 0; key < keys_; ++key) {
            const auto& [x, y, z] = poses[key].of_axis;
            float at[4];
            for (size_t c = 0; c < 4; ++c)
                at[c] = axis.unit.x * x[c] + axis.unit.y * y[c] + axis.unit.z * z[c];
            axis.low[key] = std::min({at[0], at[1], at[2], at[3]});
            axis.high[key] = std::max({at[0], at[1], at[2], at[3]});
        }
    }
}

ShutterSpan SeparatingAxes::when_in_cell(const Box3f& cell, ShutterSpan within) const {
    // Three products and two sums on both sides, of vertices that moved, and then one more sum: half-ulps of
    // the largest.
    const float rounding = 4 * kBoundRounding * std::max(largest_, largest_coordinate(cell));
    for (const Axis& axis : std::span(axes_).first(count_)) {
        const AxisRange of_cell = range_of_box(cell, axis.unit);
        within = when_at_or_below(std::span(axis.low).first(keys_), of_cell.high + rounding, within);
        within = when_at_or_above(std::span(axis.high).first(keys_), of_cell.low - rounding, within);
        if (within.is_empty()) break;
    }
    return within;
}

}  // namespace trapeze
