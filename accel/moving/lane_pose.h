/// The corners of a micropolygon in vectors of four floats, and what lies on either side of a plane of it:
/// what choosing planes for spatial splits spends most of its time on.
#pragma once

#include <array>
#include <cstdint>
#include <cstring>
#include <limits>

#include "accel/builders/box_sum.h"

namespace trapeze {

/// A box as minima and maxima along x, y and z; nobody reads the fourth lane.
struct LaneBox {
    using Lanes = BoxLanes::Lanes;
    static constexpr float kMost = std::numeric_limits<float>::max();

    /// Empty, as Box3f() is.
    Lanes low{kMost, kMost, kMost, 0}, high{-kMost, -kMost, -kMost, 0};

    LaneBox() = default;
    explicit LaneBox(const Box3f& box) {
        const BoxLanes lanes(box);
        low = lanes.low, high = __builtin_shufflevector(lanes.high, lanes.high, 1, 2, 3, 3);
    }
    /// As BoxSum::add() wants it.
    BoxLanes lanes() const { return {low, __builtin_shufflevector(high, high, 0, 0, 1, 2)}; }
    Box3f box() const { return {{low[0], low[1], low[2]}, {high[0], high[1], high[2]}}; }
    bool is_empty() const {
        const auto none = high < low;
        return (none[0] | none[1] | none[2]) != 0;
    }
};

/// A cache line.
struct alignas(64) LanePose {
    using Lanes = BoxLanes::Lanes;

    Lanes corner[4];  ///< 00, 10, 01, 11: x y z, and what nobody reads

    LanePose(const Lanes& c00, const Lanes& c10, const Lanes& c01, const Lanes& c11)
        : corner{c00, c10, c01, c11} {}

    explicit LanePose(const std::array<V3f, 4>& corners) {
        for (size_t c = 0; c < 4; ++c) corner[c] = Lanes{corners[c].x, corners[c].y, corners[c].z, 0};
    }
    std::array<V3f, 4> corners() const {
        std::array<V3f, 4> points;
        for (size_t c = 0; c < 4; ++c) points[c] = V3f(corner[c][0], corner[c][1], corner[c][2]);
        return points;
    }
};

/// What lies on either side of a plane; empty where nothing does.
struct LaneChopped {
    LaneBox low, high;
};

/// Divides the part of a micropolygon that is in `box` by the plane where coordinate `axis` is `at`: see
/// chop() of micropolygon_parts.h, whose bits it has. Without branches, as no one could foresee them.
inline LaneChopped chop(const LanePose& pose, const LaneBox& box, int axis, float at) {
    using Lanes = BoxLanes::Lanes;
    using Mask = decltype(Lanes{} < Lanes{});
    const auto all = [](float value) { return Lanes{value, value, value, value}; };
    const auto all_of = [](int32_t value) { return Mask{value, value, value, value}; };
    const Mask lanes{0, 1, 2, 3}, on_axis = lanes == all_of(axis);
    LaneChopped parts;
    const auto extend = [](LaneBox& part, const Lanes& point, const Mask& counts) {
        // The operands as std::min() and std::max() have them.
        const Lanes low = counts ? point : part.low, high = counts ? point : part.high;
        part.low = low < part.low ? low : part.low;
        part.high = part.high < high ? high : part.high;
    };
    const Lanes x{pose.corner[0][axis], pose.corner[1][axis], pose.corner[2][axis], pose.corner[3][axis]};
    const Mask is_low = x <= all(at), is_high = x >= all(at);
    for (int c = 0; c < 4; ++c) {
        extend(parts.low, pose.corner[c], all_of(is_low[c]));
        extend(parts.high, pose.corner[c], all_of(is_high[c]));
    }
    // The four sides, from 00 round, and the diagonal that both triangles have.
    constexpr std::array<std::array<int, 2>, 5> kEdges{{{0, 1}, {1, 3}, {3, 2}, {2, 0}, {0, 3}}};
    const Lanes from = __builtin_shufflevector(x, x, 0, 1, 3, 2),
                to = __builtin_shufflevector(x, x, 1, 3, 2, 0);
    const Lanes way = (all(at) - from) / (to - from);
    // Corners that lie in the plane have been counted.
    const Mask crosses = ((from < all(at)) ^ (to < all(at))) & (from != all(at)) & (to != all(at));
    for (size_t e = 0; e < kEdges.size(); ++e) {
        const auto [i, j] = kEdges[e];
        const bool diagonal = e == 4;
        const float along = diagonal ? (at - x[0]) / (x[3] - x[0]) : way[e & 3];
        const int32_t counts =
            diagonal ? -int32_t{((x[0] < at) != (x[3] < at)) & (x[0] != at) & (x[3] != at)} : crosses[e & 3];
        const Lanes &a = pose.corner[i], &b = pose.corner[j];
        const Lanes there = a + (b - a) * all(along), crossing = on_axis ? all(at) : there;
        extend(parts.low, crossing, all_of(counts));
        extend(parts.high, crossing, all_of(counts));
    }
    // `box` may hold less than the polygon: earlier planes have cut it.
    for (LaneBox* part : {&parts.low, &parts.high}) {
        part->low = part->low < box.low ? box.low : part->low;
        part->high = box.high < part->high ? box.high : part->high;
    }
    return parts;
}

}  // namespace trapeze
