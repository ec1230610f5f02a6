/// The border between the shading machine and shaders, whether they are C++ or compiled from the shading
/// language. A shader is made once from a ShaderInstance, is then immutable, and is evaluated over whole
/// grids by several threads at once. All positions and vectors are in camera space.
#pragma once

#include <array>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/camera.h"
#include "core/shading_grid.h"
#include "shade/planes.h"

namespace trapeze {

/// A shader's parameter as its instance sets it. A primitive variable of the same name and type, of any
/// storage class, replaces it on the grids of that primitive (RISpec 3.2, section 5).
template <class T>
struct ShaderParameter {
    std::string name;
    T value;
};
using FloatParameter = ShaderParameter<float>;
using ColorParameter = ShaderParameter<V3f>;
using StringParameter = ShaderParameter<std::string>;

/// What surface and displacement shaders see of a grid: RISpec's predefined variables (its table 12.1, 12.5),
/// loaded into planes when first asked for, and parameters.
class ShaderInput {
  public:
    ShaderInput(const ShadingGrid& grid, const Camera& camera, PlanePool& pool)
        : grid_(grid), camera_(camera), pool_(pool) {}

    ConstPlane3 P() { return loaded(kP, grid_.P.front()); }
    ConstPlane3 N() { return loaded(kN, grid_.N); }
    ConstPlane3 Ng() { return loaded(kNg, grid_.Ng); }
    ConstPlane3 dPdu() { return loaded(kDPdu, grid_.dPdu); }
    ConstPlane3 dPdv() { return loaded(kDPdv, grid_.dPdv); }
    ConstPlane3 Cs() { return loaded(kCs, grid_.Cs); }
    ConstPlane3 Os() { return loaded(kOs, grid_.Os); }
    /// From the eye to P; along the view, of unit length, when the projection is orthographic.
    ConstPlane3 I();

    /// The parameter on this grid.
    ConstPlane value(const FloatParameter& parameter);
    ConstPlane3 value(const ColorParameter& parameter);
    std::string_view value(const StringParameter& parameter) const;

    /// The rest (u, v, s, t, other primitive variables), and the shape that differences need.
    const ShadingGrid& grid() const { return grid_; }
    size_t vertices() const { return pool_.vertices(); }
    /// For temporaries, which live as long as the grid's evaluation.
    PlanePool& pool() { return pool_; }

  private:
    enum Variable { kP, kN, kNg, kDPdu, kDPdv, kCs, kOs, kI, kVariableCount };
    ConstPlane3 loaded(Variable variable, const Triples& values);
    ConstPlane3 load_triples(const std::array<std::span<const float>, 3>& values);

    const ShadingGrid& grid_;
    const Camera& camera_;
    PlanePool& pool_;
    std::array<std::optional<ConstPlane3>, kVariableCount> planes_;
};

class LightShader {
  public:
    virtual ~LightShader() = default;

    /// Has neither solar nor illuminate: its light has no direction and is what RISpec's ambient() gathers.
    virtual bool is_ambient() const { return false; }

    struct Light {
        Plane3 L;          ///< from the surface to the light
        Plane3 direction;  ///< L, of unit length; zero where there is none
        Plane3 Cl;
    };
    /// The light that falls on points. An ambient light sets Cl alone; its other planes are empty.
    virtual void illuminate(ConstPlane3 Ps, const Light& light) const = 0;
};

/// The lights that shine on a grid, each evaluated once, when first asked for.
class Illumination {
  public:
    Illumination(std::span<const LightShader* const> lights, ConstPlane3 P, PlanePool& pool)
        : lights_(lights), P_(P), pool_(pool) {}

    struct Arriving {
        bool ambient = false;
        ConstPlane3 L, direction, Cl;
    };
    /// In the order of the scene's light list.
    const std::vector<Arriving>& arriving();
    PlanePool& pool() { return pool_; }

  private:
    std::span<const LightShader* const> lights_;
    ConstPlane3 P_;
    PlanePool& pool_;
    bool evaluated_ = false;
    std::vector<Arriving> arriving_;
};

class SurfaceShader {
  public:
    virtual ~SurfaceShader() = default;
    /// Sets all of Ci, which is premultiplied by the opacity, and Oi.
    virtual void shade(ShaderInput& input, Illumination& lights, Plane3 Ci, Plane3 Oi) const = 0;
};

class DisplacementShader {
  public:
    virtual ~DisplacementShader() = default;
    /// Sets all of P. May set all of N and return true; else the normals are found from the moved P.
    ///
    /// Grids meet without cracks when P depends, at each vertex, on nothing but what neighbours share there:
    /// P, N and primitive variables of class vertex.
    virtual bool displace(ShaderInput& input, Plane3 P, Plane3 N) const = 0;
};

}  // namespace trapeze
