/// Coordinate systems that do not hold for all of a world: those of ScopedCoordinateSystem hold within their
/// block, those that an object names in each of its instances, where that stands.
#include <map>
#include <utility>

#include "pipeline/rib/reader/scene_builder.h"
#include "pipeline/rib/state/scene_size.h"

namespace trapeze::rib {
namespace {

using CameraFromSpaces = std::map<std::string, M44f>;
using SpacesAtOpen = std::shared_ptr<const CameraFromSpaces>;
using SharedShader = std::shared_ptr<const ShaderInstance>;
using SharedAttributes = std::shared_ptr<const Attributes>;

/// An estimate: nodes of a map, and the factors of their transformations.
uint64_t bytes_of_spaces(size_t count) {
    constexpr uint64_t kEach = 256;
    return count * kEach;
}

/// Those that are others than the world's; null where none is.
SpacesAtOpen unlike_world(const NamedSpaces& spaces, float open, const CameraFromSpaces& of_world) {
    CameraFromSpaces unlike;
    for (const auto& [name, space] : spaces) {
        const M44f camera_from_space(space.at(open));
        const auto same_name = of_world.find(name);
        if (same_name == of_world.end() || same_name->second != camera_from_space)
            unlike[name] = camera_from_space;
    }
    return unlike.empty() ? nullptr : std::make_shared<const CameraFromSpaces>(std::move(unlike));
}

/// Copies of shaders and attributes that know spaces, each made once.
class InSpaces {
  public:
    /// The shader with its layers. Null of none.
    SharedShader shader(const SharedShader& plain, const SpacesAtOpen& spaces) {
        if (!plain) return nullptr;
        SharedShader& made = shaders_[{plain, spaces}];
        if (made) return made;
        auto copy = std::make_shared<ShaderInstance>(*plain);
        copy->camera_from_scoped = spaces;
        for (SharedShader& layer : copy->earlier_layers) layer = shader(layer, spaces);
        return made = std::move(copy);
    }
    /// Null before attributes() has made them.
    SharedAttributes& known(const SharedAttributes& plain, const SpacesAtOpen& spaces) {
        return attributes_[{plain, spaces}];
    }
    std::shared_ptr<Attributes> attributes(const Attributes& plain, const SpacesAtOpen& spaces) {
        auto copy = std::make_shared<Attributes>(plain);
        for (const auto member : {&Attributes::surface, &Attributes::displacement, &Attributes::atmosphere,
                                  &Attributes::interior, &Attributes::exterior})
            (*copy).*member = shader((*copy).*member, spaces);
        return copy;
    }

  private:
    std::map<std::pair<SharedShader, SpacesAtOpen>, SharedShader> shaders_;
    std::map<std::pair<SharedAttributes, SpacesAtOpen>, SharedAttributes> attributes_;
};

}  // namespace

/// What holds where the instance stands, hidden by names of the object, and these by the primitive's own.
/// Both stand in the object's space.
SceneBuilder::SpacesPointer SceneBuilder::placed_spaces(const RetainedObject& object,
                                                        const SpacesPointer& of_primitive) const {
    const GraphicsState& instance = state_.current();
    if (object.named_spaces.empty() && !of_primitive) return instance.scoped_spaces;
    auto placed = instance.scoped_spaces ? std::make_shared<NamedSpaces>(*instance.scoped_spaces)
                                         : std::make_shared<NamedSpaces>();
    const auto place = [&](const NamedSpaces& spaces) {
        for (const auto& [name, object_from_space] : spaces) {
            MovingTransform& camera_from_space = (*placed)[name] = instance.transform;
            camera_from_space.concat(object_from_space);
        }
    };
    place(object.named_spaces);
    if (of_primitive) place(*of_primitive);
    return placed;
}

/// Of the primitive that comes next. False, and an error, where there is no room for them.
bool SceneBuilder::remember_spaces(const SpacesPointer& spaces) {
    if (!spaces) return true;
    const bool is_new = in_spaces_.empty() || in_spaces_.back().second != spaces;
    if (is_new && !has_room(bytes_of_spaces(spaces->size()))) return false;
    in_spaces_.emplace_back(scene_.primitives.size(), spaces);
    return true;
}

/// Gives shaders the spaces that hold where their primitives stand. What is the world's in the end needs no
/// copies: most names are given once.
void SceneBuilder::bind_spaces() {
    std::map<SpacesPointer, SpacesAtOpen> at_open;
    InSpaces made;
    for (const auto& [index, spaces] : in_spaces_) {
        const auto [at, is_new] = at_open.try_emplace(spaces);
        if (is_new) at->second = unlike_world(*spaces, scene_.options.shutter_open, scene_.camera_from_named);
        if (!at->second) continue;
        Primitive& primitive = scene_.primitives[index];
        SharedAttributes& attributes = made.known(primitive.attributes, at->second);
        if (!attributes) {
            attributes = made.attributes(*primitive.attributes, at->second);
            if (!has_room(bytes_of(*attributes) + sizeof(ShaderInstance) +
                          bytes_of_spaces(at->second->size())))
                break;
        }
        primitive.attributes = attributes;
    }
    in_spaces_.clear();
}

}  // namespace trapeze::rib
