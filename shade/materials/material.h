/// The shaders that a scene names, compiled and bound once, and which of them each primitive has.
#pragma once

#include <atomic>
#include <deque>
#include <map>
#include <memory>
#include <set>
#include <unordered_map>
#include <vector>

#include "core/scene/render_context.h"
#include "shade/materials/layers.h"
#include "shade/materials/light_rig.h"
#include "shade/materials/scene_spaces.h"
#include "shade/materials/shader_library.h"

namespace trapeze {

/// What one set of attributes, with the variables of a primitive, makes of a grid. The shaders belong to
/// Materials.
struct Material {
    const Attributes* attributes = nullptr;
    const LayeredShader* surface = nullptr;
    const LayeredShader* displacement = nullptr;  ///< may be null
    const LayeredShader* atmosphere = nullptr;    ///< may be null
    /// A shader asks for object space, and so grids of different primitives cannot share a run.
    bool asks_object_space = false;
    /// The surface shader sets P, and the displacement bound allows it: the surface is displaced by it, too.
    bool surface_moves = false;
    /// It sets P, there is no bound, and no displacement shader of which reach is told: the surface stays.
    bool surface_only_sets_P = false;
    bool shades_vertices_apart = false;  ///< as grid_parts.h says
    std::vector<const Lamp*> lights;
    /// The farthest that the displacement shader, or a surface shader that sets P, has moved a vertex or
    /// would have, in camera space.
    mutable std::atomic<float> displacement_reach{0};
};

class Materials {
  public:
    Materials(const RenderContext& context, const Access& access);

    /// Of a primitive of the scene, by its index.
    const Material& of(uint32_t primitive) const { return materials_[of_primitive_[primitive]]; }
    const std::deque<Material>& all() const { return materials_; }
    /// Every shader that a primitive has, layers and lights among them.
    std::vector<const BoundShader*> shaders() const;
    /// Shaders that have turned out to have loops without an end.
    size_t endless_count() const { return library_.endless_count(); }

  private:
    using Names = std::set<std::string>;
    void add(const Attributes& attributes, const Names& varying);
    const LayeredShader* layered(const ShaderInstance& instance, rsl::ShaderKind kind, const Names& varying);
    const BoundShader* bound(const ShaderInstance& instance, rsl::ShaderKind kind, Names varying,
                             std::span<const std::string> connected);
    const LayeredShader* surface(const ShaderInstance* instance, const Names& varying);
    const Lamp* lamp(const LightInstance& instance);
    void report_missing(std::string_view request, const ShaderInstance& instance, std::string_view instead);

    const RenderContext& context_;
    Diagnostics* diagnostics_;
    ShaderLibrary library_;
    ShaderInstance default_instance_;
    using Key = std::pair<const ShaderInstance*, Names>;
    std::map<Key, LayeredShader> shaders_;  ///< without layers: there is no such shader
    std::deque<BoundShader> layers_;
    std::deque<ShaderInstance> stand_ins_;  ///< of lights whose shaders are not found
    std::unordered_map<const LightInstance*, std::unique_ptr<Lamp>> lamps_;
    std::deque<Material> materials_;
    std::vector<uint32_t> of_primitive_;
};

}  // namespace trapeze
