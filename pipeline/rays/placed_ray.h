/// Rays in the spaces of objects that several instances share.
#pragma once

#include <cstdint>
#include <vector>

#include "core/math.h"
#include "core/scene/ray_scene.h"
#include "pipeline/rays/ray_grids.h"

namespace trapeze {

/// An instance of a shared object.
struct ObjectPlace {
    uint32_t object = 0;           ///< index in SharedObjects::objects
    uint32_t first_primitive = 0;  ///< of the scene; the object's others follow it in their order
    /// From the space in which the object is diced, at evenly spaced keys of the shutter. In doubles: a ray
    /// may leave a surface by no more than roundings.
    std::vector<M44d> camera_from_shared;
    M44d shared_from_camera = {};  ///< the inverse of the first; the only one where it stands still

    V3f to_camera(const V3f& P, float time) const;
    /// No numbers where a pose has no inverse: rays then meet nothing.
    static M44d inverse(const M44d& pose);
};

/// A ray in the space of the grids that it asks: camera space, or that of a shared object.
struct PlacedRay {
    SpaceRay space;   ///< its direction is of unit length in camera space alone
    float scale = 1;  ///< depth along the largest axis there, for a distance of 1 along the ray
    const ObjectPlace* place = nullptr;  ///< null: camera space

    explicit PlacedRay(const RaySegment& ray);
    PlacedRay(const RaySegment& ray, const ObjectPlace& at);

    /// The part of it that counts, in the form in which grids are asked: depths instead of the segment's
    /// distances.
    RangedRay ranged(const RaySegment& ray) const;
    V3f to_camera(const V3f& P, float time) const { return place ? place->to_camera(P, time) : P; }
};

}  // namespace trapeze
