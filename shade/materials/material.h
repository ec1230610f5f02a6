/// The shaders that a scene names, compiled and bound once, and which of them each primitive has.
#pragma once

#include <atomic>
#include <deque>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <tuple>
#include <unordered_map>
#include <vector>

#include "core/scene/render_context.h"
#include "shade/materials/layers.h"
#include "shade/materials/light_rig.h"
#include "shade/materials/scene_spaces.h"
#include "shade/materials/shader_library.h"

namespace trapeze {

/// How a grid is shaded: the shaders that a set of attributes names, laid out for a primitive with certain
/// varying variables. They belong to Materials.
struct Material {
    const Attributes* attributes = nullptr;
    const LayeredShader* surface = nullptr;
    /// The part of the surface shader that opacity takes, for rays that want no more; null where that is all.
    const LayeredShader* surface_opacity = nullptr;
    const LayeredShader* displacement = nullptr;  ///< may be null
    const LayeredShader* atmosphere = nullptr;    ///< may be null
    /// Of what rays go through that leave the surface for its inside, or its outside; may be null.
    const LayeredShader *interior = nullptr, *exterior = nullptr;
    /// Their parts as of surface_opacity.
    const LayeredShader *interior_opacity = nullptr, *exterior_opacity = nullptr;
    /// Whether a shader asks what grids of different primitives do not share: they can then not share a run.
    bool asks_primitive = false;
    /// Whether the surface shader asks for values of the volume that it is seen through.
    bool surface_asks_volume = false;
    /// Whether the surface shader sets P and there is a displacement bound: the shader then displaces the
    /// surface, too.
    bool surface_moves = false;
    /// Whether the surface shader sets P without effect: there is no displacement bound, and no displacement
    /// shader whose reach would be reported instead. The surface stays, with a warning.
    bool surface_only_sets_P = false;
    /// Whether the surface shader displaces: itself, or as a class that is a displacement shader, too.
    bool surface_displaces() const { return surface_moves || (displacement && !attributes->displacement); }
    bool shades_vertices_apart = false;  ///< as of shades_vertices_apart() in grid_parts.h
    std::vector<const Lamp*> lights;     ///< those that shine on the primitive
    /// Without area lights: for hits of which the opacity alone is wanted, that of shadows of area lights.
    std::vector<const Lamp*> other_lights;
    /// The farthest that the displacement shader, or a surface shader that sets P, has moved a vertex or
    /// would have, in camera space.
    mutable std::atomic<float> displacement_reach{0};
};

/// All materials of a scene: one for each pair of attributes and set of varying variables that a primitive
/// has. Compiles every shader that the scene names; what is missing is reported once, and replaced or left
/// out. Immutable after the constructor, but for Material::displacement_reach.
class Materials {
  public:
    Materials(const RenderContext& context, const Access& access);

    /// The material of a primitive, by its index in the scene.
    const Material& of(uint32_t primitive) const { return materials_[of_primitive_[primitive]]; }
    const std::deque<Material>& all() const { return materials_; }
    /// Every shader that a primitive has, layers and lights among them.
    std::vector<const BoundShader*> shaders() const;
    /// Every light that shines on a primitive.
    const std::vector<Lamp*>& lamps() const { return lamp_order_; }
    /// Names of lights' parameters for which shaders may send values.
    const std::set<std::string>& sent_names() const { return sent_names_; }
    /// How many shaders have turned out to have loops without an end.
    size_t endless_count() const;

  private:
    using Names = std::set<std::string>;
    void add(const Attributes& attributes, const Names& varying);
    const LayeredShader* layered(const ShaderInstance& instance, rsl::ShaderKind kind, const Names& varying);
    const BoundShader* bound(const ShaderInstance& instance, rsl::ShaderKind kind, Names varying,
                             std::span<const std::string> connected);
    const LayeredShader* volume(const char* request, const ShaderInstance* instance, const Names& varying);
    const LayeredShader* surface(const ShaderInstance* instance, const Names& varying);
    const LayeredShader* opacity_of(const LayeredShader& shader);
    const Lamp* lamp(const LightInstance& instance);
    const ShaderInstance* in_the_middle(const LightInstance& instance, const ShaderInstance& shader);
    void prepare_for_values(Lamp& lamp);
    void report_missing(std::string_view request, const ShaderInstance& instance, std::string_view instead);

    const RenderContext& context_;
    Diagnostics* diagnostics_;
    ShaderLibrary library_;
    ShaderInstance default_instance_;
    using Key = std::tuple<const ShaderInstance*, rsl::ShaderKind, Names>;
    std::map<Key, LayeredShader> shaders_;  ///< without layers: there is no such shader
    std::map<const LayeredShader*, std::optional<LayeredShader>> opacities_;  ///< nothing: it takes all
    std::deque<BoundShader> layers_;  ///< a deque, since others point to its elements; as all deques here
    std::deque<ShaderInstance> stand_ins_;  ///< of lights whose shaders are not found, or stand elsewhere
    std::unordered_map<const LightInstance*, std::unique_ptr<Lamp>> lamps_;
    std::vector<Lamp*> lamp_order_;  ///< as the scene asks for them
    std::deque<Material> materials_;
    Names sent_names_;
    std::vector<uint32_t> of_primitive_;  ///< primitive -> index of its material
};

}  // namespace trapeze
