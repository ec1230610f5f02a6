/// Retained geometry: ObjectBegin, ObjectEnd, ObjectInstance.
#include <algorithm>

#include "pipeline/rib/reader/scene_builder.h"
#include "pipeline/rib/state/scene_size.h"

namespace trapeze::rib {
namespace {

/// The most primitives of an object: instances in objects can double them with every line of a file.
constexpr size_t kMostInObject = size_t{1} << 20;

/// Exact, in the order as well: a list that was set again in another order counts as changed, which does no
/// harm.
bool same(const ParameterList& a, const ParameterList& b) {
    if (a.values.size() != b.values.size()) return false;
    for (size_t i = 0; i < a.values.size(); ++i) {
        const Parameter &x = a.values[i], &y = b.values[i];
        if (x.name != y.name || x.floats != y.floats || x.strings != y.strings) return false;
    }
    return true;
}

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

/// The instance's attributes, but for those that the definition changed between ObjectBegin and its
/// primitive. Shaders of the definition are placed with the object. States are compared, since nothing
/// remembers the requests: an attribute that the definition set to the value it had counts as not set.
std::shared_ptr<AttributeState> instance_attributes(const AttributeState& instance,
                                                    const AttributeState& at_begin,
                                                    const AttributeState& at_primitive,
                                                    const M44f& camera_from_object) {
    auto result = std::make_shared<AttributeState>(instance);
    const Attributes &old = at_begin.attributes, &now = at_primitive.attributes;
    const auto take = [&](auto... members) {
        ((now.*members == old.*members ? void() : void(result->attributes.*members = now.*members)), ...);
    };
    take(&Attributes::color, &Attributes::opacity, &Attributes::texture_coordinates,
         &Attributes::shading_rate, &Attributes::smooth_shading, &Attributes::matte, &Attributes::sides,
         &Attributes::lights, &Attributes::name, &Attributes::visible_to_camera, &Attributes::cull_hidden,
         &Attributes::dice, &Attributes::motion_factor, &Attributes::focus_factor, &Attributes::rays);
    if (result->attributes.asset.empty()) result->attributes.asset = now.asset;
    const auto take_shader = [&](auto... members) {
        const auto placed = [&](const std::shared_ptr<const ShaderInstance>& shader) {
            return placed_in(camera_from_object, shader);
        };
        ((now.*members == old.*members ? void() : void(result->attributes.*members = placed(now.*members))),
         ...);
    };
    take_shader(&Attributes::surface, &Attributes::displacement, &Attributes::atmosphere,
                &Attributes::interior, &Attributes::exterior);
    for (const auto& [category, values] : now.user)
        if (const auto before = old.user.find(category);
            before == old.user.end() || !same(before->second, values))
            for (const Parameter& value : values.values) result->attributes.user.change(category).set(value);
    if (at_primitive.displacement_bound != at_begin.displacement_bound)
        result->displacement_bound = at_primitive.displacement_bound;
    if (at_primitive.orientation != Orientation::OfInstance) {
        result->orientation = at_primitive.orientation;
        result->orientation_reversed = at_primitive.orientation_reversed;
    } else if (at_primitive.orientation_reversed) {
        result->orientation_reversed = !instance.orientation_reversed;
    }
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

/// The definition has a space of its own, in which nothing has happened yet, and keeps the attributes to tell
/// later which ones it changed.
void SceneBuilder::begin_object(const std::string& handle) {
    if (object_) throw RequestError{"object definitions do not nest", {}};
    state_.open(BlockKind::Object, report_.at());
    AttributeState& attributes = state_.change_attributes();
    attributes.orientation = Orientation::OfInstance, attributes.orientation_reversed = false;
    object_ = std::make_shared<RetainedObject>();
    object_->attributes = state_.current().attributes;
    state_.scope().objects[handle] = object_;
    state_.current().transform = MovingTransform();
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
    // The attributes that were merged last, and with what result.
    const AttributeState* merged_from = nullptr;
    std::shared_ptr<const AttributeState> merged;
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
            const auto made = instance_attributes(state_.attributes(), *object.attributes,
                                                  *primitive.attributes, state_.camera_from_current());
            if (const auto& emitter = primitive.attributes->emitter; emitter != object.attributes->emitter) {
                const auto placed = emitters.find(emitter ? emitter->light.get() : nullptr);
                made->emitter = placed != emitters.end() ? placed->second : nullptr;
            }
            merged = made;
        }
        place_instance(primitive, own ? merged : state_.current().attributes, solid);
    }
}

/// A primitive of an object with the current transformation: into the scene, or into the object that is being
/// defined. Poses at the keys of the shutter are made by the first instance and shared by all, as long as the
/// shutter stays the same.
void SceneBuilder::place_instance(ObjectPrimitive& primitive,
                                  const std::shared_ptr<const AttributeState>& attributes, int solid) {
    MovingTransform transform = state_.current().transform;
    transform.concat(primitive.object_from_shape);
    if (object_) {
        if (keeps_geometry() && !has_room(sizeof(ObjectPrimitive))) return;
        ObjectPrimitive& copy = object_->primitives.emplace_back(primitive);
        copy.object_from_shape = std::move(transform);
        copy.attributes = attributes;
        copy.at = report_.at();
        copy.solid = solid;
        return;
    }
    const float open = state_.options().shutter_open, close = state_.options().shutter_close;
    if (primitive.keys.empty() || primitive.keys_open != open || primitive.keys_close != close) {
        primitive.keys = shapes_at_keys(primitive.shapes, primitive.times, open, close);
        primitive.keys_open = open, primitive.keys_close = close;
        if (primitive.keys.size() > 1 && !has_room(primitive.keys.size() * bytes_of(*primitive.keys.front())))
            return;
    }
    place_emitter(*attributes, *primitive.keys.front(), M44f(transform.at(open)));
    emit(primitive.request, primitive.keys, transform, attributes, report_.at(), solid);
}

}  // namespace trapeze::rib
