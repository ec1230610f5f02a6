/// The shaders that a scene names, made once, and which of them each primitive has.
#pragma once

#include <atomic>
#include <deque>
#include <map>
#include <memory>
#include <span>
#include <unordered_map>
#include <vector>

#include "core/render_context.h"
#include "shade/shader.h"
#include "shade/textures.h"

namespace trapeze {

/// What one set of attributes makes of a grid. The shaders belong to Materials.
struct Material {
    const Attributes* attributes = nullptr;
    const SurfaceShader* surface = nullptr;
    const DisplacementShader* displacement = nullptr;  ///< may be null
    std::vector<const LightShader*> lights;
    /// The farthest that the displacement shader has moved a vertex, in camera space.
    mutable std::atomic<float> displacement_reach{0};
};

class Materials {
  public:
    explicit Materials(const RenderContext& context);

    /// Of a primitive of the scene, by its index.
    const Material& of(uint32_t primitive) const { return materials_[of_primitive_[primitive]]; }
    const std::deque<Material>& all() const { return materials_; }

  private:
    size_t add(const Attributes& attributes);
    const SurfaceShader* surface(const ShaderInstance* instance);
    const DisplacementShader* displacement(const ShaderInstance& instance);
    const LightShader* light(const LightInstance& instance);
    void warn_unknown(std::string_view kind, const ShaderInstance& instance, std::string_view instead);

    Diagnostics* diagnostics_;
    Textures textures_;
    ShaderInstance default_instance_;
    std::unordered_map<const ShaderInstance*, std::unique_ptr<SurfaceShader>> surfaces_;
    std::unordered_map<const ShaderInstance*, std::unique_ptr<DisplacementShader>> displacements_;
    std::unordered_map<const LightInstance*, std::unique_ptr<LightShader>> lights_;
    std::deque<Material> materials_;
    std::vector<uint32_t> of_primitive_;
};

}  // namespace trapeze
