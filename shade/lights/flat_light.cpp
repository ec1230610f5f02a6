// Rectangles and disks. Rectangles are sampled by the solid angle that they take [Urena13], which bounds what
// a point near to them may get; those too small for that, or askew, by their area. A disk that is near is a
// part of the square around it.
#include <algorithm>

#include "shade/lights/light_area.h"
#include "shade/lights/light_sampler.h"
#include "shade/lights/sphere_space.h"

namespace trapeze {
namespace {

/// Solid angles below this lose digits as sums of angles; what they come from is far enough away that all
/// its points count alike.
constexpr double kLeastSolidAngle = 1e-4;
/// A disk is sampled by area beyond so many radii.
constexpr double kNearDisk = 3;
/// Of positions in floats, a few times over: they are where transformations have put them.
constexpr double kRounding = 0x1p-21;

/// A rectangle as a point sees it: the solid angle it takes, and points evenly over that [Urena13 sec. 3].
class SphericalRectangle {
  public:
    /// `corner` is relative to the point; `x` and `y` of unit length and at right angles.
    SphericalRectangle(const V3d& corner, const V3d& x, const V3d& y, double width, double height)
        : x_(x), y_(y), z_(x.cross(y)) {
        x0_ = corner.dot(x), y0_ = corner.dot(y), z0_ = corner.dot(z_);
        if (z0_ > 0) z_ = -z_, z0_ = -z0_;
        x1_ = x0_ + width, y1_ = y0_ + height;
        const V3d corners[] = {{x0_, y0_, z0_}, {x1_, y0_, z0_}, {x1_, y1_, z0_}, {x0_, y1_, z0_}};
        V3d normals[4];
        for (size_t i = 0; i < 4; ++i) normals[i] = corners[i].cross(corners[(i + 1) % 4]).normalized();
        double angles[4];
        for (size_t i = 0; i < 4; ++i) {
            const double cosine = std::clamp(-normals[i].dot(normals[(i + 1) % 4]), -1.0, 1.0);
            angles[i] = portable::atan2(std::sqrt(1 - cosine * cosine), cosine);
        }
        b0_ = normals[0].z, b1_ = normals[2].z;
        k_ = 2 * kPi64 - angles[2] - angles[3];
        solid_angle_ = angles[0] + angles[1] - k_;
    }

    double solid_angle() const { return solid_angle_; }

    /// Relative to the point that sees.
    V3d point(const V2f& square) const {
        const double angle = static_cast<double>(square.x) * solid_angle_ + k_;
        const double f = (portable::cos(angle) * b0_ - b1_) / portable::sin(angle);
        const double c = std::clamp(std::copysign(1 / std::sqrt(f * f + b0_ * b0_), f), -1.0, 1.0);
        const double x = std::clamp(-(c * z0_) / std::max(std::sqrt(1 - c * c), 1e-30), x0_, x1_);
        const double d = std::sqrt(x * x + z0_ * z0_);
        const double h0 = y0_ / std::sqrt(d * d + y0_ * y0_), h1 = y1_ / std::sqrt(d * d + y1_ * y1_);
        const double h = h0 + static_cast<double>(square.y) * (h1 - h0);
        const double y = h * h < 1 - 1e-12 ? std::clamp(h * d / std::sqrt(1 - h * h), y0_, y1_) : y1_;
        return x_ * x + y_ * y + z_ * z0_;
    }

  private:
    V3d x_, y_, z_;
    double x0_, y0_, z0_, x1_, y1_;
    double b0_, b1_, k_, solid_angle_;
};

class FlatLight final : public LightSampler {
  public:
    FlatLight(const LightShape& shape, const M44f& camera_from_light)
        : is_disk_(shape.kind == LightShape::Kind::Disk), two_sided_(shape.two_sided) {
        const auto row = [&](int r) {
            return V3d(wide({camera_from_light[r][0], camera_from_light[r][1], camera_from_light[r][2]}));
        };
        x_ = row(0), y_ = row(1), middle_ = row(3);
        const V3d normal = x_.cross(y_);
        area_ = area_of(shape.kind, camera_from_light);
        normal_ = normal.normalized() * (normal.dot(row(2)) < 0 ? -1.0 : 1.0);
        is_square_ = std::abs(x_.dot(y_)) <= 1e-5 * x_.length() * y_.length();
    }

    bool is_there() const { return is_finite(x_ + y_ + middle_) && area_ > 0 && std::isfinite(area_); }
    float area() const override { return static_cast<float>(area_); }

    LightSample sample(const V3f& P, const V3f&, const V2f& square) const override {
        const V3d from = wide(P), away = middle_ - from;
        const double height = -away.dot(normal_);
        // What lies in the light's plane does not see it, whichever way it rounds.
        const double rounding = kRounding * (from.length() + middle_.length());
        if (std::abs(height) <= rounding || (height < 0 && !two_sided_)) return {};
        const bool is_far =
            is_disk_ && away.length2() > kNearDisk * kNearDisk * 0.25 * std::max(x_.length2(), y_.length2());
        if (is_square_ && !is_far) {
            const SphericalRectangle seen(away - (x_ + y_) * 0.5, x_.normalized(), y_.normalized(),
                                          x_.length(), y_.length());
            if (seen.solid_angle() > kLeastSolidAngle) return by_solid_angle(from, height, seen, square);
        }
        return by_area(from, height, square);
    }

  private:
    LightSample at(const V3d& P, double height) const {
        LightSample sample;
        sample.P = narrow(P);
        sample.N = narrow(height < 0 ? -normal_ : normal_);
        return sample;
    }

    LightSample by_solid_angle(const V3d& from, double height, const SphericalRectangle& seen,
                               const V2f& square) const {
        const V3d way = seen.point(square);
        LightSample made = at(from + way, height);
        const V3d inside = from + way - middle_;
        const double x = inside.dot(x_) / x_.length2(), y = inside.dot(y_) / y_.length2();
        if (!is_disk_ || x * x + y * y <= 0.25) made.solid_angle = static_cast<float>(seen.solid_angle());
        return made;
    }

    LightSample by_area(const V3d& from, double height, const V2f& square) const {
        double x = static_cast<double>(square.x) - 0.5, y = static_cast<double>(square.y) - 0.5;
        if (is_disk_) {
            const double radius = 0.5 * std::sqrt(static_cast<double>(square.x)),
                         turn = 2 * kPi64 * static_cast<double>(square.y);
            x = radius * portable::cos(turn), y = radius * portable::sin(turn);
        }
        const V3d P = middle_ + x_ * x + y_ * y, way = from - P;
        LightSample made = at(P, height);
        const double distance2 = way.length2();
        made.solid_angle = static_cast<float>(area_ * std::abs(height) / (distance2 * std::sqrt(distance2)));
        return made;
    }

    bool is_disk_, two_sided_, is_square_ = false;
    V3d x_, y_, middle_, normal_;
    double area_ = 0;
};

}  // namespace

std::unique_ptr<LightSampler> make_flat_sampler(const LightShape& shape, const M44f& camera_from_light) {
    auto light = std::make_unique<FlatLight>(shape, camera_from_light);
    if (!light->is_there()) return {};
    return light;
}

}  // namespace trapeze
