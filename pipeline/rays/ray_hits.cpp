#include "pipeline/rays/ray_hits.h"

#include <algorithm>
#include <array>

#include "core/hit_micropolygon.h"
#include "core/scene/shading_grid.h"

namespace trapeze {
namespace {

/// In camera space: 00, 10, 01, 11.
std::array<V3f, 4> corners(const PlacedRay& placed, const RayGridHit& found, float time) {
    const MicropolygonId id = MicropolygonId::unpack(found.hit.id);
    std::array<V3f, 4> all;
    for (int k = 0; k < 4; ++k)
        all[static_cast<size_t>(k)] =
            placed.to_camera(found.grid->vertex(id.u + (k & 1), id.v + (k >> 1), time), time);
    return all;
}
std::array<V3f, 4> corners(const PlacedRay& placed, const RayGridHit& found) {
    return corners(placed, found, placed.space.time);
}

/// Grids of shared objects have one instance's colours; only shapes that bring their own have other ones than
/// the attributes.
bool brings_colors(const Primitive& primitive) {
    return std::ranges::any_of(primitive.shape().variables.values,
                               [](const Parameter& value) { return value.name == "Cs"; });
}

}  // namespace

RayHits::RayHits(const RayDicer& dicer, uint8_t level) : dicer_(dicer), level_(level) {
    for (const Primitive& primitive : dicer.context().scene->primitives)
        seen_.push_back(seen_numbers(*primitive.attributes));
    if (std::ranges::all_of(seen_, &SeenNumbers::are_all)) seen_.clear();
}

/// In the scene itself.
uint32_t RayHits::primitive(const PlacedRay& placed, const Grid& grid) const {
    return placed.place ? dicer_.shared().primitive_at(*placed.place, grid.primitive) : grid.primitive;
}

/// Whether a ray of a direction, camera space, comes to a micropolygon from the outside of its surface.
bool RayHits::from_outside(const PlacedRay& placed, const V3f& direction, const RayGridHit& found) const {
    const Attributes& attributes = dicer_.attributes(primitive(placed, *found.grid));
    const auto [p00, p10, p01, p11] = corners(placed, found);
    const V3f normal = (p11 - p00).cross(p01 - p10) * (attributes.reverse_orientation ? -1.0f : 1.0f);
    return normal.dot(direction) <= 0;
}

/// One-sided surfaces have no inside, but for those that turn to the eye, which have no back; and a ray may
/// want groups or sides of its own choice.
bool RayHits::shows(const RaySegment& ray, const PlacedRay& placed, const RayGridHit& found) const {
    using Sides = RayFilter::Sides;
    const uint32_t number = primitive(placed, *found.grid);
    if (!seen_.empty() && !seen_[number].contain(ray.number)) return false;
    if (ray.only && ray.only->primitive.value_or(number) != number) return false;
    const Primitive& own = dicer_.context().scene->primitives[number];
    if (own.solid >= 0) return true;  // the whole solid has sides
    const Attributes& attributes = dicer_.attributes(number);
    if (ray.only && !ray.only->admits(attributes.rays.groups)) return false;
    if (ray.only && ray.only->with_inside && !attributes.interior) return false;
    Sides sides = ray.only ? ray.only->sides : Sides::OfAttributes;
    if (sides == Sides::OfAttributes)
        sides = attributes.sides == 1 && !faces_the_eye(own.shape()) ? Sides::Front : Sides::Both;
    if (sides == Sides::Both) return true;
    const V3f direction = ray.backwards ? -ray.direction : ray.direction;
    return from_outside(placed, direction, found) == (sides == Sides::Front);
}

RayFacet RayHits::facet(const RaySegment& ray, const PlacedRay& placed, const RayGridHit& found) const {
    RayFacet facet;
    facet.reversed = dicer_.attributes(primitive(placed, *found.grid)).reverse_orientation;
    const size_t poses = placed.place ? placed.place->camera_from_shared.size() : 1;
    const bool all = ray.only->facets == RayFilter::Facets::AllTimes;
    const size_t keys = all ? std::max(poses, static_cast<size_t>(found.grid->key_count)) : 1;
    for (size_t key = 0; key < keys; ++key)
        facet.keys.push_back(
            corners(placed, found,
                    keys == 1 ? placed.space.time : static_cast<float>(key) / static_cast<float>(keys - 1)));
    facet.set_inner(ray.origin + ray.direction * (found.hit.depth / placed.scale), placed.space.time);
    return facet;
}

bool RayHits::is_displaced(const PlacedRay& placed, const RayGridHit& found) const {
    const Attributes& attributes = dicer_.attributes(primitive(placed, *found.grid));
    return attributes.displacement || attributes.displacement_bound > 0;
}

/// Whether a hit may be the surface that the ray leaves.
bool RayHits::is_left(const RaySegment& ray, const PlacedRay& placed, const RayGridHit& found) const {
    const LeftSurface& left = ray.left;
    if (!(found.hit.depth < left.sure() * placed.scale)) return false;
    const std::array<V3f, 4> of_it = corners(placed, found);
    if (left.loose.most > 0 && primitive(placed, *found.grid) == left.own) return true;
    if (left.loose.most > 0) return left.loose.lies_in(of_it, ray.origin, is_displaced(placed, found));
    return std::ranges::none_of(
        of_it, [&](const V3f& corner) { return left.is_left(corner - ray.origin, ray.direction); });
}

/// Whether a hit may be what the ray's end lies on.
bool RayHits::is_reached(const RaySegment& ray, const PlacedRay& placed, const RayGridHit& found) const {
    if (!(found.hit.depth > ray.reached.sure() * placed.scale)) return false;
    const Primitive& own = dicer_.context().scene->primitives[primitive(placed, *found.grid)];
    if (own.solid >= 0) return false;  // which are counted
    return ray.reached.end.lies_in(corners(placed, found), ray.origin + ray.direction * ray.reached.distance,
                                   is_displaced(placed, found));
}

bool RayHits::counts(const RaySegment& ray, const PlacedRay& placed, const RayGridHit& found) const {
    if (is_left(ray, placed, found) || is_reached(ray, placed, found)) return false;
    if (ray.passed.has(primitive(placed, *found.grid), found.hit.depth / placed.scale)) return false;
    return shows(ray, placed, found);
}

RaySurfaceHit RayHits::hit_of(const RaySegment& ray, const PlacedRay& placed, const RayGridHit& found) const {
    const MicropolygonId id = MicropolygonId::unpack(found.hit.id);
    const Grid& grid = *found.grid;
    const TurnedRay turned = axis_ray(placed.space);
    const QuadWeights weights = hit_weights(
        turned.ray, grid.quad(id.u, id.v, placed.space.time, turned.x_plane, turned.y_plane, turned.z_plane));
    RaySurfaceHit hit;
    hit.distance = found.hit.depth / placed.scale;
    hit.primitive = primitive(placed, grid);
    hit.attributes = &dicer_.attributes(hit.primitive).rays;
    hit.from_outside = from_outside(placed, ray.direction, found);
    hit.level = level_;
    hit.of_solid = dicer_.context().scene->primitives[hit.primitive].solid >= 0;
    hit.keeps_opacity = dicer_.keeps_opacity(hit.primitive);
    hit.color = hit.opacity = V3f(0, 0, 0);
    for (int corner = 0; corner < 4; ++corner) {
        const int i = id.u + (corner & 1), j = id.v + (corner >> 1);
        hit.color += weights.w[corner] * grid.color(i, j);
        hit.opacity += weights.w[corner] * grid.opacity(i, j);
    }
    const Primitive& own = dicer_.context().scene->primitives[hit.primitive];
    if (placed.place && !brings_colors(own)) hit.color = own.attributes->color;
    hit.place.instance = placed.place, hit.place.depth = found.hit.depth, hit.place.id = found.hit.id;
    hit.at = {weights.w[k10] + weights.w[k11], weights.w[k01] + weights.w[k11]};
    if (ray.only && ray.only->facets != RayFilter::Facets::NotTold) hit.facet = facet(ray, placed, found);
    return hit;
}

}  // namespace trapeze
