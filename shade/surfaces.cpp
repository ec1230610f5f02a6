#include "shade/surfaces.h"

#include <algorithm>

#include "shade/differences.h"
#include "shade/kernels.h"
#include "shade/shadeops.h"

namespace trapeze {
namespace {

void copy(ConstPlane3 from, Plane3 to) {
    for (int k = 0; k < 3; ++k) std::copy(from[k].begin(), from[k].end(), to[k].begin());
}

class Null : public SurfaceShader {
  public:
    void shade(ShaderInput&, Illumination&, Plane3 Ci, Plane3 Oi) const override {
        for (int k = 0; k < 3; ++k) fill(0, Ci[k]), fill(0, Oi[k]);
    }
};

class Constant : public SurfaceShader {
  public:
    void shade(ShaderInput& input, Illumination&, Plane3 Ci, Plane3 Oi) const override {
        copy(input.Os(), Oi);
        kernels::multiply(input.Os(), input.Cs(), Ci);
    }
};

class DefaultSurface : public SurfaceShader {
  public:
    explicit DefaultSurface(const ParameterBinder& parameters)
        : Ka_(parameters.number("Ka", 0.2f)), Kd_(parameters.number("Kd", 0.8f)) {}

    void shade(ShaderInput& input, Illumination&, Plane3 Ci, Plane3 Oi) const override {
        copy(input.Os(), Oi);
        kernels::default_surface(input.Os(), input.Cs(), input.N(), input.I(), input.value(Ka_),
                                 input.value(Kd_), Ci);
    }

  private:
    FloatParameter Ka_, Kd_;
};

class Matte : public SurfaceShader {
  public:
    explicit Matte(const ParameterBinder& parameters)
        : Ka_(parameters.number("Ka", 1)), Kd_(parameters.number("Kd", 1)) {}

    void shade(ShaderInput& input, Illumination& lights, Plane3 Ci, Plane3 Oi) const override {
        const Plane3 N = shadeops::facing_normal(input);
        copy(input.Os(), Oi);
        kernels::lit(input.Os(), input.Cs(), input.value(Ka_), shadeops::ambient(lights), input.value(Kd_),
                     shadeops::diffuse(lights, N), Ci);
    }

  private:
    FloatParameter Ka_, Kd_;
};

/// metal, and shinymetal as it is without an environment map.
class Metal : public SurfaceShader {
  public:
    explicit Metal(const ParameterBinder& parameters)
        : Ka_(parameters.number("Ka", 1)),
          Ks_(parameters.number("Ks", 1)),
          roughness_(parameters.number("roughness", 0.1f)) {}

    void shade(ShaderInput& input, Illumination& lights, Plane3 Ci, Plane3 Oi) const override {
        const Plane3 N = shadeops::facing_normal(input);
        const Plane3 V = shadeops::toward_viewer(input);
        copy(input.Os(), Oi);
        kernels::lit(input.Os(), input.Cs(), input.value(Ka_), shadeops::ambient(lights), input.value(Ks_),
                     shadeops::specular(lights, N, V, input.value(roughness_)), Ci);
    }

  private:
    FloatParameter Ka_, Ks_, roughness_;
};

class Plastic : public SurfaceShader {
  public:
    explicit Plastic(const ParameterBinder& parameters)
        : Ka_(parameters.number("Ka", 1)),
          Kd_(parameters.number("Kd", 0.5f)),
          Ks_(parameters.number("Ks", 0.5f)),
          roughness_(parameters.number("roughness", 0.1f)),
          specularcolor_(parameters.color("specularcolor", V3f(1))) {}

    void shade(ShaderInput& input, Illumination& lights, Plane3 Ci, Plane3 Oi) const override {
        const Plane3 N = shadeops::facing_normal(input);
        const Plane3 V = shadeops::toward_viewer(input);
        copy(input.Os(), Oi);
        kernels::lit(input.Os(), base_color(input), input.value(Ka_), shadeops::ambient(lights),
                     input.value(Kd_), shadeops::diffuse(lights, N), Ci);
        kernels::add_highlight(input.Os(), input.value(specularcolor_), input.value(Ks_),
                               shadeops::specular(lights, N, V, input.value(roughness_)), Ci);
    }

  protected:
    virtual ConstPlane3 base_color(ShaderInput& input) const { return input.Cs(); }

  private:
    FloatParameter Ka_, Kd_, Ks_, roughness_;
    ColorParameter specularcolor_;
};

/// Plastic whose colour is Cs * texture(texturename).
class PaintedPlastic : public Plastic {
  public:
    PaintedPlastic(const ParameterBinder& parameters, Textures& textures)
        : Plastic(parameters),
          texturename_(parameters.string("texturename", "")),
          location_(parameters.instance().location),
          textures_(textures),
          picture_(textures.find(texturename_.value, location_)) {}

  protected:
    ConstPlane3 base_color(ShaderInput& input) const override {
        const std::string_view name = input.value(texturename_);
        const Textures::Picture* picture =
            name == texturename_.value ? picture_ : textures_.find(name, location_);
        if (!picture) return input.Cs();
        const Plane3 color = input.pool().take3();
        textures_.lookup(*picture, texture_lookup(input), input.vertices(), color);
        kernels::multiply(input.Cs(), color, color);
        return color;
    }

  private:
    /// Over s and t, filtered over the distance to the next vertices.
    static Textures::Lookup texture_lookup(ShaderInput& input) {
        PlanePool& pool = input.pool();
        const GridShape& shape = input.grid().shape;
        const Plane s = pool.take(), t = pool.take();
        load(input.grid().s, input.vertices(), s);
        load(input.grid().t, input.vertices(), t);
        const Plane dsdu = pool.take(), dtdu = pool.take(), dsdv = pool.take(), dtdv = pool.take();
        difference(shape, GridAxis::U, s, dsdu);
        difference(shape, GridAxis::U, t, dtdu);
        difference(shape, GridAxis::V, s, dsdv);
        difference(shape, GridAxis::V, t, dtdv);
        return {s, t, dsdu, dtdu, dsdv, dtdv};
    }

    StringParameter texturename_;
    SourceLocation location_;
    Textures& textures_;
    const Textures::Picture* picture_;
};

}  // namespace

std::unique_ptr<SurfaceShader> make_default_surface(const ParameterBinder& parameters) {
    return std::make_unique<DefaultSurface>(parameters);
}

std::unique_ptr<SurfaceShader> make_standard_surface(const ParameterBinder& parameters, Textures& textures) {
    const std::string& name = parameters.instance().name;
    if (name == "constant") return std::make_unique<Constant>();
    if (name == "matte") return std::make_unique<Matte>(parameters);
    if (name == "plastic") return std::make_unique<Plastic>(parameters);
    if (name == "metal" || name == "shinymetal") return std::make_unique<Metal>(parameters);
    if (name == "paintedplastic") return std::make_unique<PaintedPlastic>(parameters, textures);
    if (name == "defaultsurface" || name == "default") return make_default_surface(parameters);
    if (name == "null") return std::make_unique<Null>();
    return nullptr;
}

}  // namespace trapeze
