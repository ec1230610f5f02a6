#include "accel/moving/micropolygon_parts.h"

#include <algorithm>
#include <cmath>

#include "accel/moving/lane_pose.h"
#include "core/hyper_trapezoid.h"

namespace trapeze {
namespace {

/// A point of a micropolygon as a sum of its corners, whose weights sum to 1. In doubles: what clipping
/// rounds is then nothing beside part_slack().
using CornerWeights = std::array<double, 4>;

/// A convex polygon while it is clipped: a triangle, and a vertex more for each of six planes.
struct PartPolygon {
    std::array<CornerWeights, 9> vertex;
    size_t count = 0;

    void add(const CornerWeights& weights) { vertex[count++] = weights; }
};

double coordinate_of(const CornerWeights& weights, const QuadPose& pose, int axis) {
    double sum = 0;
    for (size_t c = 0; c < 4; ++c) sum += weights[c] * static_cast<double>(pose[c][axis]);
    return sum;
}

/// Keeps what is on one side of a plane: of coordinates times `sign` that are `at` times `sign` or more.
PartPolygon clipped(const PartPolygon& from, const QuadPose& pose, int axis, double at, double sign) {
    PartPolygon to;
    for (size_t i = 0; i < from.count; ++i) {
        const CornerWeights &a = from.vertex[i], &b = from.vertex[(i + 1) % from.count];
        const double inside_a = sign * (coordinate_of(a, pose, axis) - at);
        const double inside_b = sign * (coordinate_of(b, pose, axis) - at);
        if (inside_a >= 0) to.add(a);
        if ((inside_a >= 0) == (inside_b >= 0)) continue;
        const double way = inside_a / (inside_a - inside_b);
        CornerWeights crossing;
        for (size_t c = 0; c < 4; ++c) crossing[c] = a[c] + way * (b[c] - a[c]);
        to.add(crossing);
    }
    return to;
}

}  // namespace

QuadPose pose_of(const Grid& grid, const MicropolygonId& id, float time01) {
    QuadPose pose;
    for (int c = 0; c < 4; ++c)
        pose[static_cast<size_t>(c)] = grid.vertex(id.u + (c & 1), id.v + (c >> 1), time01);
    return pose;
}

Box3f box_of(const QuadPose& pose) {
    Box3f box;
    for (const V3f& corner : pose) box.extendBy(corner);
    return box;
}

Chopped chop(const QuadPose& pose, const Box3f& box, int axis, float at) {
    const LaneChopped parts = chop(LanePose(pose), LaneBox(box), axis, at);
    return {parts.low.box(), parts.high.box()};
}

float part_slack(const QuadPose& pose) {
    float largest = 0;
    for (const V3f& corner : pose)
        for (int k = 0; k < 3; ++k) largest = std::max(largest, std::abs(corner[k]));
    // A crossing is a difference, a quotient, a product and a sum: a few half-ulps of the largest coordinate.
    return kBoundRounding * largest + 0x1p-80f;
}

MicropolygonPart::MicropolygonPart(const QuadPose& pose, const Box3f& box) {
    const auto slack = static_cast<double>(part_slack(pose));
    for (const auto& triangle : {std::array<size_t, 3>{0, 1, 3}, std::array<size_t, 3>{0, 3, 2}}) {
        PartPolygon polygon;
        for (const size_t corner : triangle) {
            CornerWeights weights{};
            weights[corner] = 1;
            polygon.add(weights);
        }
        for (int axis = 0; axis < 3; ++axis) {
            const auto [least, most] =
                std::minmax({pose[triangle[0]][axis], pose[triangle[1]][axis], pose[triangle[2]][axis]});
            const double low = static_cast<double>(box.min[axis]) - slack,
                         high = static_cast<double>(box.max[axis]) + slack;
            // Most planes of a box have the triangle on one side.
            if (static_cast<double>(least) < low) polygon = clipped(polygon, pose, axis, low, 1);
            if (static_cast<double>(most) > high) polygon = clipped(polygon, pose, axis, high, -1);
        }
        for (size_t i = 0; i < polygon.count; ++i) weights_[count_++] = polygon.vertex[i];
    }
}

Box3f MicropolygonPart::box_when(const QuadPose& pose) const {
    Box3f box;
    for (size_t i = 0; i < count_; ++i) {
        V3f at;
        for (int k = 0; k < 3; ++k) at[k] = static_cast<float>(coordinate_of(weights_[i], pose, k));
        box.extendBy(at);
    }
    return box;
}

}  // namespace trapeze
