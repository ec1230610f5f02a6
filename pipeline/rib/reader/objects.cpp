/// Retained geometry: ObjectBegin, ObjectEnd, ObjectInstance.
#include <algorithm>

#include "pipeline/rib/reader/scene_builder.h"
#include "pipeline/rib/state/attribute_values.h"
#include "pipeline/rib/state/deforming_shape.h"
#include "pipeline/rib/state/motion_paths.h"
#include "pipeline/rib/state/scene_size.h"

namespace trapeze::rib {
namespace {

/// The most primitives of an object: instances in objects can double them with every line of a file.
constexpr size_t kMostInObject = size_t{1} << 20;

/// Shaders are shared between states and never changed; placing one makes a copy.
using ShaderPointer = std::shared_ptr<const ShaderInstance>;

/// A shader of the definition, with its layers, where an instance stands.
ShaderPointer placed_in(const M44f& camera_from_object, const ShaderPointer& shader) {
    if (!shader) return shader;
    auto copy = std::make_shared<ShaderInstance>(*shader);
    copy->camera_from_shader = copy->camera_from_shader * camera_from_object;
    for (ShaderPointer& layer : copy->earlier_layers) layer = placed_in(camera_from_object, layer);
    return copy;
}

/// What a definition has set as a whole: members of Attributes.
void take_own(const Attributes& of_object, const OwnAttributes& own, Attributes& result) {
    const auto take = [&](Own what, auto... members) {
        if (own.has(what)) ((result.*members = of_object.*members), ...);
    };
    take(Own::Color, &Attributes::color);
    take(Own::Opacity, &Attributes::opacity);
    take(Own::TextureCoordinates, &Attributes::texture_coordinates);
    take(Own::ShadingRate, &Attributes::shading_rate);
    take(Own::ShadingInterpolation, &Attributes::smooth_shading);
    take(Own::Matte, &Attributes::matte);
    take(Own::Sides, &Attributes::sides);
    take(Own::MotionFactor, &Attributes::motion_factor);
    take(Own::FocusFactor, &Attributes::focus_factor);
    take(Own::Rays, &Attributes::rays);
    take(Own::Name, &Attributes::name);
}

/// Shaders of a definition are placed with the object, but not those that a state from outside has brought.
void take_own_shaders(const AttributeState& of_object, const M44f& camera_from_object, Attributes& result) {
    const OwnAttributes& own = of_object.own;
    const auto take = [&](Own what, ShaderPointer Attributes::*member) {
        if (!own.has(what)) return;
        result.*member = placed_in(camera_from_object, of_object.attributes.*member);
    };
    take(Own::Surface, &Attributes::surface);
    take(Own::Displacement, &Attributes::displacement);
    take(Own::Atmosphere, &Attributes::atmosphere);
    take(Own::Interior, &Attributes::interior);
    take(Own::Exterior, &Attributes::exterior);
}

void take_own_orientation(const AttributeState& of_object, const AttributeState& instance,
                          AttributeState& result) {
    if (of_object.orientation != Orientation::OfInstance) {
        result.orientation = of_object.orientation;
        result.orientation_reversed = of_object.orientation_reversed;
    } else if (of_object.orientation_reversed) {
        result.orientation_reversed = !instance.orientation_reversed;
    }
}

/// The attributes of an object's primitive in an instance: those of the instance, but for what the definition
/// has set between ObjectBegin and the primitive. The emitter is the caller's to place.
std::shared_ptr<AttributeState> instance_attributes(const AttributeState& instance,
                                                    const AttributeState& of_object,
                                                    const M44f& camera_from_object) {
    const OwnAttributes& own = of_object.own;
    auto result = std::make_shared<AttributeState>(own.restored() ? of_object : instance);
    result->own = instance.own;
    if (instance.own.definition() != 0) result->own.add(own);  // of the object that this one is put in
    Attributes& a = result->attributes;
    if (a.asset.empty()) a.asset = of_object.attributes.asset;
    for (const auto& [order, value] : own.values()) set_attribute_value(value.category, value.value, *result);
    for (const auto& [light, on] : own.switches()) switch_light(light, on, a);
    take_own(of_object.attributes, own, a);
    take_own_shaders(of_object, camera_from_object, a);
    if (own.has(Own::DisplacementBound)) result->displacement_bound = of_object.displacement_bound;
    if (own.has(Own::DetailRange)) {
        const float size = result->detail.size;
        result->detail = of_object.detail;
        result->detail.size = size;
    }
    take_own_orientation(of_object, instance, *result);
    return result;
}

/// What is emitted meanwhile has an instance's number.
class NumberedInstance {
  public:
    NumberedInstance(int number, int& now) : now_(now) { now_ = number; }
    ~NumberedInstance() { now_ = -1; }
    NumberedInstance(const NumberedInstance&) = delete;
    NumberedInstance& operator=(const NumberedInstance&) = delete;

  private:
    int& now_;
};

}  // namespace

/// The definition has a space of its own, in which nothing has happened yet, and a record of what it sets.
void SceneBuilder::begin_object(const std::string& handle) {
    if (object_) throw RequestError{"object definitions do not nest", {}};
    state_.open(BlockKind::Object, report_.at());
    AttributeState& attributes = state_.change_attributes();
    attributes.orientation = Orientation::OfInstance, attributes.orientation_reversed = false;
    attributes.own = OwnAttributes(state_.blocks().back().id);
    object_ = std::make_shared<RetainedObject>();
    object_->attributes = state_.current().attributes;
    state_.scope().objects[handle] = object_;
    state_.current().transform = MovingTransform();
    state_.current().scoped_spaces = nullptr;
}

void SceneBuilder::end_object() {
    if (object_) object_->named_spaces = state_.object_spaces();
    object_ = nullptr;
}

/// Objects in objects are made flat: an instance within a definition copies its primitives. Consecutive
/// primitives mostly share their attributes, and then also the merged ones.
void SceneBuilder::instance(const std::string& handle) {
    if (motion_.is_open()) throw RequestError{"inside a motion block", {}};
    if (!takes_geometry()) return;
    const auto found = state_.scope().objects.find(handle);
    if (found == state_.scope().objects.end()) throw RequestError{"no object " + in_quotes(handle), {}};
    if (found->second == object_) throw RequestError{"an object in its own definition", {}};
    RetainedObject& object = *found->second;
    const PlacedEmitters emitters = place_lights(object);
    instanced_primitives_ += object.primitives.size();
    if (instanced_primitives_ > read_options_.most_instanced_primitives) {
        report_.error_of_limit("instances make more than " +
                                   std::to_string(read_options_.most_instanced_primitives) +
                                   " primitives, which is the limit; this and further ones are left out",
                               "instance-limit");
        return;
    }
    if (object_ && object_->primitives.size() + object.primitives.size() > kMostInObject)
        throw RequestError{"the object has more than " + std::to_string(kMostInObject) + " primitives", {}};
    // The attributes and spaces that were merged last, and with what result.
    const AttributeState* merged_from = nullptr;
    std::shared_ptr<const AttributeState> merged;
    const NamedSpaces* placed_from = nullptr;
    SpacesPointer spaces = placed_spaces(object, nullptr);
    const int first_solid = place_solids(object.solids);
    // Surfaces of an object that has no solids of its own bound the solid around the instance.
    const bool some_bare = std::any_of(object.primitives.begin(), object.primitives.end(),
                                       [](const ObjectPrimitive& p) { return p.solid < 0; });
    const int around = some_bare ? solid_of_surface(solids_here()) : -1;
    const NumberedInstance numbered(object_ ? -1 : instances_++, instance_);
    for (ObjectPrimitive& primitive : object.primitives) {
        const int solid = primitive.solid >= 0 ? first_solid + primitive.solid : around;
        const bool own = primitive.attributes != object.attributes;
        if (own && merged_from != primitive.attributes.get()) {
            merged_from = primitive.attributes.get();
            const auto made =
                instance_attributes(state_.attributes(), *primitive.attributes, state_.camera_from_current());
            if (const auto& emitter = primitive.attributes->emitter;
                primitive.attributes->own.has(Own::Emitter)) {
                const auto placed = emitters.find(emitter ? emitter->light.get() : nullptr);
                made->emitter = placed != emitters.end() ? placed->second : nullptr;
            }
            merged = made;
        }
        if (placed_from != primitive.spaces.get()) {
            placed_from = primitive.spaces.get();
            spaces = placed_spaces(object, primitive.spaces);
        }
        place_instance(primitive,
                       {state_.current().transform, own ? merged : state_.current().attributes, spaces},
                       solid);
    }
}

/// A primitive of an object, in a state whose transformation is the instance's: into the scene, or into the
/// object that is being defined. Poses at the keys of the shutter are made by the first instance and shared
/// by all, as long as the shutter stays the same and none wants more keys.
void SceneBuilder::place_instance(ObjectPrimitive& primitive, GraphicsState state, int solid) {
    state.transform.concat(primitive.object_from_shape);
    if (object_) {
        if (keeps_geometry() && !has_room(sizeof(ObjectPrimitive))) return;
        ObjectPrimitive& copy = object_->primitives.emplace_back(primitive);
        copy.object_from_shape = std::move(state.transform);
        copy.attributes = std::move(state.attributes);
        copy.spaces = std::move(state.scoped_spaces);
        copy.at = report_.at();
        copy.solid = solid;
        return;
    }
    const float open = state_.options().shutter_open, close = state_.options().shutter_close;
    const bool stays = primitive.keys_open == open && primitive.keys_close == close;
    const int wanted = primitive.shapes.size() < 2
                           ? 1
                           : keys_for_poses(primitive.shapes, primitive.times, state.transform, open, close,
                                            make_camera(state_.options()));
    if (!stays || primitive.keys.size() < static_cast<size_t>(wanted)) {
        primitive.keys = shapes_at_keys(primitive.shapes, primitive.times, open, close, wanted);
        primitive.keys_open = open, primitive.keys_close = close;
        if (primitive.keys.size() > 1 && !has_room(primitive.keys.size() * bytes_of(*primitive.keys.front())))
            return;
    }
    place_emitter(*state.attributes, *primitive.keys.front(), M44f(state.transform.at(open)));
    emit(primitive.request, primitive.keys, state, report_.at(), solid);
}

}  // namespace trapeze::rib
