/// Objects whose instances share what rays meet: diced once, in a space of their own, and met by each ray as
/// it passes through an instance's space [decision 0042].
#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include "core/scene/camera.h"
#include "core/scene/scene.h"
#include "pipeline/rays/placed_ray.h"

namespace trapeze {

/// An object as it is diced once for several instances: its models are copies of one instance's primitives,
/// each where a pixel is nowhere larger than at any of the instances.
struct SharedObject {
    uint32_t first_model = 0;  ///< index in SharedObjects::models; the object's others follow it
    uint32_t stands_for = 0;   ///< the scene's primitive that the first model is a copy of
    uint32_t count = 0;        ///< of models, and of primitives of each instance
};

/// Primitives are known by numbers: those below is_shared.size() are the scene's own, those from there on are
/// models, in their order.
struct SharedObjects {
    std::vector<SharedObject> objects;
    std::vector<ObjectPlace> places;  ///< object by object, in the order of the scene
    std::vector<Primitive> models;
    std::vector<uint32_t> object_of_model;  ///< indices in `objects`
    std::vector<bool> is_shared;            ///< whether models stand for it, by the scene's primitive

    /// The object of a model, an index in `objects`; -1: the number is no model's.
    int object_of(uint32_t number) const {
        return number < is_shared.size() ? -1 : static_cast<int>(object_of_model[number - is_shared.size()]);
    }
    /// The scene's primitive that a model is a copy of: one instance's. Attributes of others are those of
    /// primitive_at(). Another number is its own.
    uint32_t own(uint32_t number) const {
        const int object = object_of(number);
        if (object < 0) return number;
        const SharedObject& of = objects[static_cast<size_t>(object)];
        return of.stands_for + (number - static_cast<uint32_t>(is_shared.size()) - of.first_model);
    }
    /// The scene's primitive at a place, by the number of the model or of what it is a copy of.
    uint32_t primitive_at(const ObjectPlace& place, uint32_t number) const {
        return place.first_primitive + (own(number) - objects[place.object].stands_for);
    }
};

/// What a model of a primitive depends on, besides the scene.
struct WhatRaysMeet {
    std::function<bool(uint32_t)> keeps_opacity;  ///< Shading's
    std::function<bool(uint32_t)> is_displaced;   ///< though it has no displacement shader
};

/// Finds the objects that pay: those with several instances that are seen in much the same size, that do not
/// bend, are not displaced for rays, and differ in nothing that grids for rays hold but in their colour.
/// `moves`: whether rays meet things as they move. Depends on the scene and its camera alone.
SharedObjects share_objects(const Scene& scene, const Camera& camera, bool moves, const WhatRaysMeet& what);

}  // namespace trapeze
