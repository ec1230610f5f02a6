#include "shade/lights.h"

#include <cmath>

#include "shade/kernels.h"

namespace trapeze {
namespace {

/// intensity * lightcolor.
V3f strength(const ParameterBinder& parameters) {
    return parameters.color("lightcolor", V3f(1)).value * parameters.number("intensity", 1).value;
}

V3f unit(const V3f& v) {
    const float length = v.length();
    return length > 0 ? v / length : V3f(0);
}

void fill3(const V3f& value, Plane3 out) {
    for (int k = 0; k < 3; ++k) fill(value[k], out[k]);
}

class AmbientLight : public LightShader {
  public:
    explicit AmbientLight(const ParameterBinder& parameters) : color_(strength(parameters)) {}

    bool is_ambient() const override { return true; }
    void illuminate(ConstPlane3, const Light& light) const override { fill3(color_, light.Cl); }

  private:
    V3f color_;
};

/// solar(to - from, 0): parallel light along to - from.
class DistantLight : public LightShader {
  public:
    explicit DistantLight(const ParameterBinder& parameters)
        : color_(strength(parameters)),
          toward_(parameters.point("from", V3f(0)) - parameters.point("to", V3f(0, 0, 1))) {}

    void illuminate(ConstPlane3, const Light& light) const override {
        fill3(toward_, light.L);
        fill3(unit(toward_), light.direction);
        fill3(color_, light.Cl);
    }

  private:
    V3f color_, toward_;
};

/// Cl = intensity * lightcolor / (L.L).
class PointLight : public LightShader {
  public:
    explicit PointLight(const ParameterBinder& parameters)
        : color_(strength(parameters)), from_(parameters.point("from", V3f(0))) {}

    void illuminate(ConstPlane3 Ps, const Light& light) const override {
        kernels::point_light(Ps, from_, color_, light.L, light.direction, light.Cl);
    }

  private:
    V3f color_, from_;
};

/// A point light with a cone: full inside coneangle - conedeltaangle, none outside coneangle.
class SpotLight : public LightShader {
  public:
    explicit SpotLight(const ParameterBinder& parameters)
        : color_(strength(parameters)), from_(parameters.point("from", V3f(0))) {
        const float angle = parameters.number("coneangle", 30 * kRadians).value;
        const float delta = parameters.number("conedeltaangle", 5 * kRadians).value;
        cone_.axis = unit(parameters.point("to", V3f(0, 0, 1)) - from_);
        cone_.cos_outside = std::cos(angle);
        cone_.cos_inside = std::cos(angle - delta);
        cone_.beam = parameters.number("beamdistribution", 2).value;
    }

    void illuminate(ConstPlane3 Ps, const Light& light) const override {
        kernels::point_light(Ps, from_, color_, light.L, light.direction, light.Cl);
        kernels::spot_falloff(light.direction, cone_, light.Cl);
    }

  private:
    static constexpr float kRadians = 0.017453292f;

    V3f color_, from_;
    kernels::SpotCone cone_;
};

}  // namespace

std::unique_ptr<LightShader> make_standard_light(const ParameterBinder& parameters) {
    const std::string& name = parameters.instance().name;
    if (name == "ambientlight") return std::make_unique<AmbientLight>(parameters);
    if (name == "distantlight") return std::make_unique<DistantLight>(parameters);
    if (name == "pointlight") return std::make_unique<PointLight>(parameters);
    if (name == "spotlight") return std::make_unique<SpotLight>(parameters);
    return nullptr;
}

}  // namespace trapeze
