/// Directions as seen from a point, and solid angles in spaces that are not the camera's.
#pragma once

#include <cmath>
#include <numbers>

#include "core/axes_around.h"
#include "core/math.h"

namespace trapeze {

inline constexpr double kPi64 = std::numbers::pi;

inline V3d wide(const V3f& v) {
    return {static_cast<double>(v.x), static_cast<double>(v.y), static_cast<double>(v.z)};
}
inline V3f narrow(const V3d& v) {
    return {static_cast<float>(v.x), static_cast<float>(v.y), static_cast<float>(v.z)};
}

inline bool is_finite(const V3d& v) {
    return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z);
}

/// 1 - cos of an angle whose cosine may be close to 1, from its squared sine.
inline double one_minus_cosine(double sine2) {
    return sine2 / (1 + std::sqrt(1 - sine2));
}

/// A direction of a cone about the first of the axes, all solid angles alike; `rim` is one_minus_cosine() of
/// the angle between the axis and the rim.
inline V3d in_cone(const AxesAround<double>& axes, double rim, const V2f& square) {
    const double below = static_cast<double>(square.x) * rim, sine2 = below * (2 - below);
    return axes.around(std::sqrt(sine2), 1 - below, static_cast<double>(square.y));
}

/// The linear part of a space's matrix.
class LinearSpace {
  public:
    explicit LinearSpace(const M44f& camera_from_space) : matrix_(camera_from_space) {
        for (int k = 0; k < 3; ++k) matrix_[3][k] = matrix_[k][3] = 0;
        matrix_[3][3] = 1;
        determinant_ = std::abs(matrix_.determinant());
    }
    V3d to_camera(const V3d& direction) const { return direction * matrix_; }
    const M44d& matrix() const { return matrix_; }
    double determinant() const { return determinant_; }
    bool is_regular() const { return determinant_ > 0 && std::isfinite(determinant_); }
    /// How much larger a small solid angle about a direction of unit length is in camera space.
    double stretch(const V3d& direction) const {
        const double length = to_camera(direction).length();
        return determinant_ / (length * length * length);
    }

  private:
    M44d matrix_;
    double determinant_ = 0;
};

}  // namespace trapeze
