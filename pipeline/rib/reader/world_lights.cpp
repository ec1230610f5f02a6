/// Lights that shine from shapes, and the path tracer's (RIS), which shine on all of a world, wherever they
/// stand in it.
#include <algorithm>
#include <map>
#include <utility>

#include "pipeline/rib/reader/scene_builder.h"
#include "pipeline/rib/ris/ris_light_surfaces.h"
#include "pipeline/rib/ris/ris_lights.h"
#include "pipeline/rib/state/attribute_values.h"
#include "pipeline/rib/state/scene_size.h"

namespace trapeze::rib {
namespace {

/// Limits the lights that shine on the whole world: every surface looks at each of them.
constexpr size_t kMostWorldLights = 64;

/// The space moved so that its origin is at a point of the shape's space.
M44f with_origin(M44f camera_from_space, const V3f& point, const M44f& camera_from_shape) {
    const V3f origin = point * camera_from_shape;
    for (int axis = 0; axis < 3; ++axis) camera_from_space[3][axis] = origin[axis];
    return camera_from_space;
}

/// LightInstance::moving_space of a light that stands in an object's space, where the object is placed.
std::vector<M44f> placed_poses(const LightInstance& light, const M44f& camera_from_object,
                               const std::vector<M44f>& moving_object) {
    std::vector<M44f> keys;
    for (size_t key = 0; key < std::max(light.moving_space.size(), moving_object.size()); ++key)
        keys.push_back(
            (light.moving_space.empty() ? light.shader.camera_from_shader : light.moving_space[key]) *
            (moving_object.empty() ? camera_from_object : moving_object[key]));
    return keys;
}

/// Path tracers' surfaces are in the way of light unless Attribute "visibility" says otherwise.
bool is_in_the_way(const Attributes& attributes) {
    return !attributes.user.has_category("render") && !attributes.user.find("visibility", "transmission");
}

/// Paths have a time each, unless Attribute "trace" says otherwise.
bool sees_motion(const Attributes& attributes) {
    return !attributes.user.find("trace", "samplemotion");
}

/// Others keep their numbers, and with them what is random of them, wherever a light is added.
void put_light_surfaces_last(std::vector<Primitive>& primitives) {
    const auto is_of_scene = [](const Primitive& primitive) {
        const auto& surface = primitive.attributes->surface;
        return !surface || surface->name != kLightSurfaceShader;
    };
    const auto first = std::stable_partition(primitives.begin(), primitives.end(), is_of_scene);
    // Away from the rest of an object's instance, they are no part of it.
    std::for_each(first, primitives.end(), [](Primitive& primitive) { primitive.instance = -1; });
}

}  // namespace

/// A light's handle lives until the frame or world ends, its shining until the block does.
void SceneBuilder::add_light(std::shared_ptr<const LightInstance> light) {
    if (object_) throw RequestError{"inside an object definition", {}};
    ++report_.summary().lights;
    state_.scope().lights[light->handle] = light;
    state_.change_attributes().attributes.lights.push_back(std::move(light));
}

/// Handles of a frame or world that ended are unknown again (Scope).
std::shared_ptr<const LightInstance> SceneBuilder::light(const std::string& handle) const {
    const auto found = state_.scope().lights.find(handle);
    return found == state_.scope().lights.end() ? nullptr : found->second;
}

/// Lights of an object have no handle outside of it, and are counted where they are placed.
bool SceneBuilder::add_world_light(std::shared_ptr<const LightInstance> light) {
    auto& lights = object_ ? object_->lights : state_.scope().ris.lights;
    if (lights.size() >= kMostWorldLights) {
        report_.warn_once(
            "more than " + std::to_string(kMostWorldLights) + " lights; this and further ones are dark",
            "ris-lights");
        return false;
    }
    if (!object_) {
        ++report_.summary().lights;
        state_.scope().lights[light->handle] = light;
    }
    lights.push_back(std::move(light));
    return true;
}

/// Shapes of lights are primitives like others, of one side, but that no ray of a shader meets them: it finds
/// the light of them by samples. None in a motion block, in which a light is made once.
void SceneBuilder::add_light_surface(const LightInstance& light) {
    std::optional<LightSurface> surface = surface_of(light);
    if (!surface || motion_.is_open() || !(state_.in_world() || object_)) return;
    state_.open(BlockKind::Attribute, report_.at());
    state_.current().transform.concat(M44d(surface->light_from_shape));
    for (const Own what : {Own::Color, Own::Opacity, Own::Sides, Own::Surface, Own::Displacement,
                           Own::Interior, Own::Exterior, Own::Emitter, Own::DisplacementBound, Own::Rays})
        state_.change_attributes(what);
    AttributeState& state = state_.change_attributes();
    state.orientation = Orientation::Outside;
    state.orientation_reversed = false;
    state.emitter = nullptr;
    state.displacement_bound = {};
    Attributes& a = state.attributes;
    a.color = a.opacity = V3f(1, 1, 1);
    a.sides = light.shape->two_sided ? 2 : 1;
    a.surface = std::make_shared<const ShaderInstance>(std::move(surface->shader));
    a.displacement = a.interior = a.exterior = nullptr;
    a.rays.diffuse = a.rays.specular = a.rays.transmission = false;
    add_shape("Light", std::move(surface->shape), 1);
    state_.close();
}

/// Lights of an object shine from where it is placed, once for each instance. Those that shine from the
/// object's shapes get an emitter in each.
SceneBuilder::PlacedEmitters SceneBuilder::place_lights(const RetainedObject& object) {
    PlacedEmitters emitters;
    for (const auto& light : object.lights) {
        if (!object_ && state_.scope().ris.lights.size() >= kMostWorldLights) {
            add_world_light(light);  // says so
            break;
        }
        auto placed = std::make_shared<LightInstance>(*light);
        placed->moving_space = placed_poses(*light, state_.camera_from_current(), state_.moving_current());
        placed->shader.camera_from_shader = placed->shader.camera_from_shader * state_.camera_from_current();
        if (placed->shape && placed->shape->kind == LightShape::Kind::Mesh)
            emitters[light.get()] = std::make_shared<Emitter>(Emitter{placed, true, true});
        add_world_light(std::move(placed));
    }
    return emitters;
}

/// The first shape after a light that shines from shapes says on which sides it does. The middle is for
/// shaders of RSL that do not ask for points of shapes, unless they say where they are. A light from before
/// an object's definition shines from its instances.
void SceneBuilder::place_emitter(const AttributeState& state, const Shape& shape,
                                 const M44f& camera_from_shape) {
    Emitter* const emitter = state.emitter.get();
    if (object_ && state.emitter == object_->attributes->emitter) return;
    if (!emitter || std::exchange(emitter->is_placed, true)) return;
    const ShaderInstance& shader = emitter->light->shader;
    if (emitter->is_of_ris) return place_mesh_light(*emitter->light, shape);
    emitter->light->shape->two_sided = state.attributes.sides == 2;
    if (!shader.parameters.find("from"))
        emitter->light->shape->camera_from_middle =
            with_origin(shader.camera_from_shader, middle_of(shape), camera_from_shape);
}

/// The light becomes another in its place: it has been handed on already.
void SceneBuilder::place_far_emitter(FarShape shape, float angle) {
    Emitter* const emitter = state_.attributes().emitter.get();
    if (!emitter || !emitter->is_of_ris || std::exchange(emitter->is_placed, true)) return;
    *emitter->light =
        *far_light(*emitter->light, shape, state_.camera_from_current(), state_.moving_current(), angle);
}

/// Area lights whose block ended, and that no Illuminate ever named, would shine on themselves alone: they
/// are of files for renderers in which what shines is seen by all.
void SceneBuilder::add_strays(std::vector<std::shared_ptr<const LightInstance>>& lights) {
    const auto& current = state_.attributes().attributes.lights;
    for (const auto& emitter : state_.scope().emitters) {
        const std::shared_ptr<const LightInstance> light = emitter->light;
        if (!emitter->is_placed || std::find(current.begin(), current.end(), light) != current.end())
            continue;
        report_.warn_once("light " + in_quotes(light->handle) +
                              " is of a block that ended, and no Illuminate names it; "
                              "it shines on all",
                          "stray-area-light");
        lights.push_back(light);
    }
}

/// Adds the world's lights to all primitives. Bxdfs cast shadows of area lights, as in path tracers. Those
/// that nothing lights have a light at the eye, so that there is something to see, and all are shaded once a
/// pixel at least: path tracers do not look at ShadingRate. Their rays meet what moves at times of their own.
void SceneBuilder::light_world() {
    put_light_surfaces_last(scene_.primitives);
    auto lights = state_.scope().ris.lights;
    add_strays(lights);
    const std::shared_ptr<const LightInstance> at_eye = headlight();
    const bool has_area_lights =
        std::ranges::any_of(lights, [](const auto& light) { return light->shape.has_value(); });
    const bool has_shutter = scene_.options.shutter_close > scene_.options.shutter_open;
    std::map<std::shared_ptr<const Attributes>, std::shared_ptr<const Attributes>> lit;
    for (Primitive& primitive : scene_.primitives) {
        const Attributes& unlit = *primitive.attributes;
        const bool is_ris = unlit.surface && unlit.surface->name == "rissurface";
        const bool is_dark = is_ris && unlit.lights.empty() && lights.empty();
        const bool is_coarse = is_ris && unlit.shading_rate > 1 && !read_options_.shading_rate;
        const bool is_moving = is_ris && has_shutter && sees_motion(unlit);
        const bool is_occluder = is_ris && has_area_lights && is_in_the_way(unlit);
        if (lights.empty() && !is_dark && !is_coarse && !is_moving) continue;
        std::shared_ptr<const Attributes>& known = lit[primitive.attributes];
        if (!known) {
            auto made = std::make_shared<Attributes>(unlit);
            for (const auto& light : lights)
                if (std::find(made->lights.begin(), made->lights.end(), light) == made->lights.end() &&
                    !is_switched_off(*light, unlit))
                    made->lights.push_back(light);
            if (is_dark) made->lights.push_back(at_eye);
            if (is_coarse) made->shading_rate = 1;
            if (is_moving) made->rays.sample_motion = true;
            if (is_occluder) made->rays.transmission = true;
            // No shader has to be asked for an opacity that it does not change.
            if (is_occluder && !unlit.surface->parameters.find("opacity"))
                made->rays.transmission_hits = RayAttributes::HitMode::Primitive;
            if (!has_room(bytes_of(*made))) return;
            known = std::move(made);
        }
        primitive.attributes = known;
    }
}

}  // namespace trapeze::rib
