// Spheres, and what matrices make of them, shine outwards. Directions are even over the cone that the sphere
// takes in the light's own space; solid angles are then those of camera space.
#include <algorithm>

#include "shade/lights/light_area.h"
#include "shade/lights/light_sampler.h"
#include "shade/lights/sphere_space.h"

namespace trapeze {
namespace {

constexpr double kRadius = 0.5;

class SphereLight final : public LightSampler {
  public:
    explicit SphereLight(const M44f& camera_from_light)
        : space_(camera_from_light),
          middle_(wide(camera_from_light.translation())),
          light_from_camera_(space_.is_regular() ? space_.matrix().inverse() : M44d()) {
        area_ = area_of(LightShape::Kind::Sphere, camera_from_light);
    }

    bool is_there() const { return space_.is_regular() && is_finite(middle_) && std::isfinite(area_); }
    float area() const override { return static_cast<float>(area_); }

    LightSample sample(const V3f& P, const V3f&, const V2f& square) const override {
        const V3d from = (wide(P) - middle_) * light_from_camera_;
        const double distance2 = from.length2();
        if (!(distance2 > kRadius * kRadius * (1 + 1e-9))) return {};  // inside it is dark
        const double distance = std::sqrt(distance2), rim = one_minus_cosine(kRadius * kRadius / distance2);
        const V3d way = in_cone(AxesAround(from / -distance), rim, square);
        // The nearer point where the way meets the sphere.
        const double middle = -way.dot(from);
        const double half = std::sqrt(std::max(0.0, middle * middle - (distance2 - kRadius * kRadius)));
        const V3d met = from + way * (middle - half);
        LightSample made;
        made.P = narrow(space_.to_camera(met) + middle_);
        made.N = narrow((met * light_from_camera_.transposed()).normalized());
        made.solid_angle = static_cast<float>(2 * kPi64 * rim * space_.stretch(way));
        return made;
    }

  private:
    LinearSpace space_;
    V3d middle_;
    M44d light_from_camera_;
    double area_ = 0;
};

}  // namespace

std::unique_ptr<LightSampler> make_sphere_sampler(const M44f& camera_from_light) {
    auto light = std::make_unique<SphereLight>(camera_from_light);
    if (!light->is_there()) return {};
    return light;
}

}  // namespace trapeze
