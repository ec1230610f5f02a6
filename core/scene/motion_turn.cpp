#include "core/scene/motion_turn.h"

#include <cmath>

#include "core/scene/poses.h"

namespace trapeze {
namespace {

/// Whether a matrix does more than move; rounding is no turn.
bool turns(const M44d& matrix) {
    constexpr double kRounding = 1e-5;
    for (int row = 0; row < 3; ++row)
        for (int column = 0; column < 3; ++column)
            if (std::abs(matrix[row][column] - (row == column ? 1 : 0)) > kRounding) return true;
    return false;
}

}  // namespace

MotionTurn::MotionTurn(const Primitive& primitive, int keys, std::span<const M44f> held) {
    const std::vector<M44d> poses(primitive.camera_from_object.begin(), primitive.camera_from_object.end());
    if (keys <= 1 || poses.empty() || (poses.size() == 1 && held.empty())) return;
    bool any = false;
    const M44d first = poses.front().inverse();
    for (int key = 0; key < keys; ++key) {
        const float time = static_cast<float>(key) / static_cast<float>(keys - 1);
        from_first_.push_back(first * pose_at<M44d>(poses, time) *
                              M44d(held_at(held, key, held.empty() ? 1 : keys)));
        any |= turns(from_first_.back());
    }
    if (!any) from_first_.clear();
}

/// Gram and Schmidt's axes: a rotation's own, and those of what lies between two turns about one axis.
MotionTurn::Axes MotionTurn::at(float time01) const {
    const M44d m = pose_at<M44d>(from_first_, time01);
    Axes axes;
    axes.x = V3d(m[0][0], m[0][1], m[0][2]).normalized();
    const V3d y(m[1][0], m[1][1], m[1][2]), z(m[2][0], m[2][1], m[2][2]);
    axes.y = (y - axes.x * axes.x.dot(y)).normalized();
    axes.z = axes.x.cross(axes.y);
    if (axes.z.dot(z) < 0) axes.z = -axes.z;
    return axes;
}

V3f MotionTurn::forward(const V3f& direction, float time01) const {
    if (is_none() || time01 == 0) return direction;
    const Axes axes = at(time01);
    const V3d d(direction);
    return V3f(axes.x * d.x + axes.y * d.y + axes.z * d.z);
}

V3f MotionTurn::back(const V3f& direction, float time01) const {
    if (is_none() || time01 == 0) return direction;
    const Axes axes = at(time01);
    const V3d d(direction);
    return V3f(V3d(axes.x.dot(d), axes.y.dot(d), axes.z.dot(d)));
}

std::optional<V3f> MotionTurn::normal(const V3f& normal, float time01) const {
    if (is_none() || time01 == 0) return normal;
    constexpr double kMostStretch = 0.25;
    const M44d m = pose_at<M44d>(from_first_, time01);
    const V3d x(m[0][0], m[0][1], m[0][2]), y(m[1][0], m[1][1], m[1][2]), z(m[2][0], m[2][1], m[2][2]);
    for (const V3d& row : {x, y, z})
        if (!(std::abs(row.length() - 1) < kMostStretch)) return {};
    for (const double skew : {x.dot(y), y.dot(z), z.dot(x)})
        if (!(std::abs(skew) < kMostStretch)) return {};
    // Planes turn by the inverse transpose, whose columns are these.
    const V3d turned = y.cross(z) * normal.x + z.cross(x) * normal.y + x.cross(y) * normal.z;
    return V3f(turned.normalized());
}

}  // namespace trapeze
