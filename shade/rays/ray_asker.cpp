#include "shade/rays/ray_asker.h"

#include <algorithm>
#include <cmath>

#include "core/random.h"
#include "shade/rays/lane_motion.h"

namespace trapeze {
namespace {

/// How far from a point its rays begin at most, in micropolygons' sides. A ray that leaves a micropolygon's
/// vertex may be said to hit it as deep as the micropolygon goes, where that is a needle
/// (hit_micropolygon.h): some have sides of nearly two. Two dicings of a displaced surface differ by more.
constexpr float kBiasOfSide = 2, kBiasOfDisplacedSide = 3;

/// Of what lies on an edge of a face: the thickness of a slab out of which it is moved (inwards_at()).
constexpr float kInwardsOfReach = 1.0f / 1024;

/// Points, and curves without normals: what rays meet of them need not be turned alike.
bool turns_to_camera(const Primitive& primitive) {
    const Topology& topology = primitive.shape().topology;
    return std::holds_alternative<Curves>(topology) || std::holds_alternative<Points>(topology);
}

bool are_seen_by(const RayAttributes& rays, RayKind kind) {
    return kind == RayKind::Diffuse    ? rays.diffuse
           : kind == RayKind::Specular ? rays.specular
                                       : rays.transmission;
}

}  // namespace

uint64_t RayLane::of_ray(int sample) const {
    const auto number = static_cast<uint32_t>(sample);
    return uint64_t{hash(seed, number, 3)} << 32 | hash(seed, number, 4);
}

/// Of the micropolygons that rays meet on a level, in pixels.
float RayAsker::side(int level) const {
    return std::max(std::sqrt(std::max(attributes_.shading_rate, 1.0f)), level_side(level));
}

SurfaceBend RayAsker::bend_of(const ShadingGrid& grid) const {
    const bool displaced = attributes_.displacement || attributes_.displacement_bound > 0 || grid.displaced;
    if (displaced || turns_to_camera(*grid.primitive)) return {};
    return trapeze::bend_of(grid, *service_.scene, side(grid.hit_level));
}

float RayAsker::margin_at(const V3f& P, const RayLane& lane, float asked) const {
    if (asked >= 0) return asked;
    if (attributes_.rays.bias > 0) return attributes_.rays.bias;
    const bool displaced = attributes_.displacement || attributes_.displacement_bound > 0;
    return service_.scene->spacing(P) * side(lane.level()) * (displaced ? kBiasOfDisplacedSide : kBiasOfSide);
}

LeftSurface RayAsker::left_at(const V3f& P, const RayLane& lane, const LaneMotion& motion, float time,
                              float asked) const {
    LeftSurface left;
    left.most = margin_at(P, lane, asked);
    if (has_bias(asked)) return left;
    const V3f at_open = normal_at(P - motion.way(time), lane);
    const bool turns = lane.grid && turns_to_camera(*lane.grid->primitive);
    const LooseEnd loose = loose_end_at(P, lane, std::min(lane.bend.most, left.most / 8));
    if (at_open == V3f(0, 0, 0) && !turns) return {.loose = loose};
    const std::optional<V3f> normal = motion.normal(at_open, time);
    const bool has_slab = lane.bend.most < left.most && at_open != V3f(0, 0, 0) && normal;
    if (!has_slab) return {.loose = loose, .own = lane.grid->primitive_index};
    left.normal = *normal;
    left.half = lane.bend.most + rounding_at(*lane.grid, lane.lane - lane.first_of_grid) +
                (P - motion.way(time) - vertex_of(lane)).length();
    return left;
}

/// Of a smooth surface that bends within some sides, micropolygons that rays meet pass within a part of their
/// sides of its points.
LooseEnd RayAsker::loose_end_at(const V3f& P, const RayLane& lane, float roughness) const {
    constexpr float kHalfOfMost = 1.0f / 32;
    const float most = margin_at(P, lane, -1);
    return {std::max(most, roughness / kHalfOfMost), std::max(most * kHalfOfMost, roughness)};
}

ReachedPlace RayAsker::reached_at(const RayAim& aim, const RayLane& lane, float roughness) const {
    return {aim.length, loose_end_at(aim.P + aim.direction * aim.length, lane, roughness)};
}

/// Whether a ray stays in the slab for so long that it meets a surface within it that bends towards the ray.
bool RayAsker::may_come_back(const V3f& direction, const RayLane& lane, const LeftSurface& left) {
    constexpr float kSafe = 2;
    const float bend = lane.bend.towards(direction, left.normal);
    return left.most * std::abs(direction.dot(left.normal)) < kSafe * bend;
}

/// Whether another face may be within the slab: towards which the surface bends, where the slab is not thin,
/// or on which the vertex is, as on its own, and from which the ray is not moved far enough.
bool RayAsker::may_hide_others(const V3f& direction, const RayLane& lane, const LeftSurface& left) {
    constexpr float kThin = 1.0f / 8;
    return lane.bend.towards(direction, left.normal) > kThin * left.most ||
           is_cramped_at(*lane.grid, lane.lane - lane.first_of_grid, left.half, lane.grid->face_sides);
}

std::optional<LeavingPoint> RayAsker::leaving_at(const V3f& P, const V3f& direction, const RayLane& lane,
                                                 float asked, const LeftSurface& left, RayKind kind,
                                                 bool is_exact) const {
    const bool leaves_slab = left.half < kInfinity && !may_come_back(direction, lane, left) &&
                             (is_exact || !may_hide_others(direction, lane, left));
    if (leaves_slab || has_bias(asked) || !lane.grid) return {};
    const Primitive& primitive = *lane.grid->primitive;
    if (!are_seen_by(attributes_.rays, kind) || primitive.solid >= 0 || turns_to_camera(primitive)) return {};
    LeavingPoint point;
    point.normal = normal_at(P, lane);
    if (point.normal == V3f(0, 0, 0)) return {};
    const size_t vertex = lane.lane - lane.first_of_grid;
    point.number = seen_.from, point.primitive = lane.grid->primitive_index, point.level = lane.level();
    point.reach = margin_at(P, lane, asked);
    point.rounding = rounding_at(*lane.grid, vertex);
    // On an edge between two faces it would be on either.
    point.P = P + inwards_at(*lane.grid, vertex, point.reach * kInwardsOfReach, lane.grid->face_sides);
    return point;
}

bool RayAsker::knows_where_to_begin(const V3f& P, const RayLane& lane, const LaneMotion& motion, float asked,
                                    RayKind kind) const {
    const LeftSurface left = left_at(P, lane, motion, 0, asked);
    return left.half < kInfinity || leaving_at(P, left.normal, lane, asked, left, kind).has_value();
}

V3f RayAsker::vertex_of(const RayLane& lane) {
    return lane.grid->P.front().at(lane.lane - lane.first_of_grid);
}

V3f RayAsker::normal_at(const V3f& P, const RayLane& lane) {
    if (!lane.grid) return V3f(0, 0, 0);
    const size_t vertex = lane.lane - lane.first_of_grid;
    // Points that shaders move off it by less than it bends are meant to be on it.
    const float bend = lane.bend.most < kInfinity ? lane.bend.most : 0;
    const bool is_there = (P - vertex_of(lane)).length() <= std::max(bend, rounding_at(*lane.grid, vertex));
    return is_there ? lane.grid->Ng.at(vertex) : V3f(0, 0, 0);
}

V3f RayAsker::left_of_light_behind(const RayLane& lane, bool is_met, const RayFilter* only) const {
    using Sides = RayFilter::Sides;
    const V3f all(1, 1, 1);
    if (!is_met || !attributes_.rays.transmission) return all;
    if (only && !only->admits(attributes_.rays.groups)) return all;
    const Sides sides = only ? only->sides : Sides::OfAttributes;
    const bool has_both = sides == Sides::Both || (sides == Sides::OfAttributes && attributes_.sides != 1);
    return has_both ? all - lane.grid->Os.at(lane.lane - lane.first_of_grid) : all;
}

V3f RayAsker::inwards(const RayLane& lane, const LeftSurface& left) {
    if (!(left.half < kInfinity)) return V3f(0, 0, 0);
    return inwards_at(*lane.grid, lane.lane - lane.first_of_grid, left.half, ShadingGrid::kAllSides);
}

V3f RayAsker::inwards_of_face(const RayLane& lane, const LeftSurface& left) {
    if (!(left.half < kInfinity)) return V3f(0, 0, 0);
    const V3f way = inwards_at(*lane.grid, lane.lane - lane.first_of_grid, left.half, lane.grid->face_sides);
    const float length = way.length(), most = left.most / (4 * kBiasOfSide);
    return length > most ? way * (most / length) : way;
}

float RayAsker::width_at(const V3f& P, const RayLane& lane) const {
    const float side = service_.scene->spacing(P) * std::sqrt(std::max(attributes_.shading_rate, 0.0f));
    return lane.grid && lane.grid->hit_vertex >= 0 ? std::max(side, lane.grid->hit_ray.widest()) : side;
}

RayMedium RayAsker::medium(const RayLane& lane, const V3f& direction) const {
    if (!knows_media(lane)) return {};
    if (within_medium_) return lane.grid->medium;
    const V3f outside = lane.grid->Ng.at(lane.lane - lane.first_of_grid);
    return {lane.grid->primitive_index, direction.dot(outside) < 0};
}

float RayAsker::number(const RayLane& lane, int sample) const {
    const float number = unit_float(hash(lane.seed, static_cast<uint32_t>(sample), 5));
    // Rounding must not lead out of a range.
    return std::min(seen_.from + number * (seen_.to - seen_.from), std::nextafter(seen_.to, 0.0f));
}

/// The bounds of all surfaces on the way hold, each counted from the surface's own depth.
RayDepths RayAsker::depths_behind(RayKind kind) const {
    RayDepths depths = service_.visit.depths;
    const RayAttributes& rays = attributes_.rays;
    const auto bound = [&](RayKind of, int most) {
        int& known = depths.most[static_cast<size_t>(of)];
        known = std::min(known, depths.of(of) + most);
    };
    bound(RayKind::Diffuse, rays.max_diffuse);
    bound(RayKind::Specular, rays.max_specular);
    ++depths.bounces[static_cast<size_t>(kind)];
    return depths;
}

bool RayAsker::is_too_deep(RayKind kind) const {
    const RayDepths depths = depths_behind(kind);
    return depths.of(kind) > depths.most[static_cast<size_t>(kind)] || service_.depth >= service_.max_depth;
}

}  // namespace trapeze
