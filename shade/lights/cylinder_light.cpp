// Cylinders along x, without their ends, and what matrices make of them, shine outwards. Points are even over
// the arc that a point sees of the circle, in the light's own space, and over the length.
#include <algorithm>

#include "shade/lights/light_area.h"
#include "shade/lights/light_sampler.h"
#include "shade/lights/sphere_space.h"

namespace trapeze {
namespace {

constexpr double kRadius = 0.5;

class CylinderLight final : public LightSampler {
  public:
    explicit CylinderLight(const M44f& camera_from_light)
        : space_(camera_from_light),
          middle_(wide(camera_from_light.translation())),
          light_from_camera_(space_.is_regular() ? space_.matrix().inverse() : M44d()) {
        area_ = area_of(LightShape::Kind::Cylinder, camera_from_light);
    }

    bool is_there() const { return space_.is_regular() && is_finite(middle_) && std::isfinite(area_); }
    float area() const override { return static_cast<float>(area_); }

    LightSample sample(const V3f& P, const V3f&, const V2f& square) const override {
        const V3d from = (wide(P) - middle_) * light_from_camera_;
        const double away = std::sqrt(from.y * from.y + from.z * from.z);
        if (!(away > kRadius * (1 + 1e-9))) return {};  // nothing of its outside is seen
        const double sine = std::sqrt(1 - kRadius * kRadius / (away * away));
        const double half = portable::atan2(sine, kRadius / away);
        const double angle = portable::atan2(from.z, from.y) + half * (2 * static_cast<double>(square.y) - 1);
        const V3d on_light(static_cast<double>(square.x) - 0.5, kRadius * portable::cos(angle),
                           kRadius * portable::sin(angle));
        const V3d place = space_.to_camera(on_light) + middle_, area_normal = this->area_normal(angle);
        const V3d way = wide(P) - place;
        LightSample made;
        made.P = narrow(place);
        made.N = narrow(area_normal.normalized());
        const double distance2 = way.length2(), facing = way.dot(area_normal);
        if (facing > 0)
            made.solid_angle =
                static_cast<float>(2 * half * kRadius * facing / (distance2 * std::sqrt(distance2)));
        return made;
    }

  private:
    /// Camera space: along the normal, as long as areas there are larger than in the light's own space.
    V3d area_normal(double angle) const {
        const V3d normal(0, portable::cos(angle), portable::sin(angle));
        return normal * light_from_camera_.transposed() * space_.determinant();
    }

    LinearSpace space_;
    V3d middle_;
    M44d light_from_camera_;
    double area_ = 0;
};

}  // namespace

std::unique_ptr<LightSampler> make_cylinder_sampler(const M44f& camera_from_light) {
    auto light = std::make_unique<CylinderLight>(camera_from_light);
    if (!light->is_there()) return {};
    return light;
}

}  // namespace trapeze
