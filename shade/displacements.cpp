#include "shade/displacements.h"

#include <algorithm>
#include <cmath>

#include "shade/kernels.h"

namespace trapeze {
namespace {

class NullDisplacement : public DisplacementShader {
  public:
    bool displace(ShaderInput& input, Plane3 P, Plane3 N) const override {
        for (int k = 0; k < 3; ++k) {
            std::copy(input.P()[k].begin(), input.P()[k].end(), P[k].begin());
            std::copy(input.N()[k].begin(), input.N()[k].end(), N[k].begin());
        }
        return true;
    }
};

/// What the two wave-like ones share.
class AlongNormal : public DisplacementShader {
  public:
    explicit AlongNormal(const ParameterBinder& parameters)
        : amplitude_(parameters.number("amplitude", 0.1f)), frequency_(parameters.number("frequency", 1)) {
        const M44f& camera_from_shader = parameters.instance().camera_from_shader;
        shader_from_camera_ = camera_from_shader.inverse();
        V3f x;
        camera_from_shader.multDirMatrix(V3f(1, 0, 0), x);
        camera_length_ = x.length();
    }

    bool displace(ShaderInput& input, Plane3 P, Plane3) const override {
        PlanePool& pool = input.pool();
        const Plane3 at = pool.take3();
        kernels::transform_points(input.P(), shader_from_camera_, at);
        kernels::scale(input.value(frequency_), at, at);
        const Plane amount = pool.take(), length = pool.take();
        height(at, pool, amount);
        const ConstPlane amplitude = input.value(amplitude_);
        for (size_t i = 0; i < length.size(); ++i) length[i] = amplitude[i] * camera_length_;
        kernels::move_along(input.P(), input.N(), amount, length, P);
        return false;
    }

  private:
    /// In units of the amplitude, at points of shader space times frequency.
    virtual void height(Plane3 at, PlanePool& pool, Plane out) const = 0;

    FloatParameter amplitude_, frequency_;
    M44f shader_from_camera_;
    float camera_length_ = 1;
};

class SineWaves : public AlongNormal {
  public:
    using AlongNormal::AlongNormal;

  private:
    void height(Plane3 at, PlanePool&, Plane out) const override { kernels::sine_waves(at, out); }
};

class Dented : public AlongNormal {
  public:
    explicit Dented(const ParameterBinder& parameters)
        : AlongNormal(parameters), octaves_(octave_count(parameters.number("octaves", 3).value)) {}

  private:
    void height(Plane3 at, PlanePool& pool, Plane out) const override {
        const Plane twice = pool.take(), octave = pool.take();
        fill(2, twice), fill(0, out);
        float weight = 1;
        for (int k = 0; k < octaves_; ++k, weight /= 2) {
            kernels::noise(at, octave);
            for (size_t i = 0; i < out.size(); ++i) out[i] -= weight * std::fabs(octave[i]);
            kernels::scale(twice, at, at);
        }
    }

    static int octave_count(float asked) { return asked >= 1 ? static_cast<int>(std::min(asked, 8.0f)) : 1; }

    int octaves_;
};

}  // namespace

std::unique_ptr<DisplacementShader> make_standard_displacement(const ParameterBinder& parameters) {
    const std::string& name = parameters.instance().name;
    if (name == "dented") return std::make_unique<Dented>(parameters);
    if (name == "sinewaves") return std::make_unique<SineWaves>(parameters);
    if (name == "null") return std::make_unique<NullDisplacement>();
    return nullptr;
}

}  // namespace trapeze
