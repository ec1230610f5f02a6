#include "core/scene/shading_grid.h"

#include <algorithm>
#include <cmath>

#include "core/axes_around.h"
#include "core/half.h"
#include "core/motion_keys.h"
#include "core/scene/depth_filter.h"
#include "core/scene/level_of_detail.h"
#include "core/scene/motion_turn.h"
#include "core/scene/poses.h"
#include "core/scene/scene.h"

namespace trapeze {
namespace {

/// The value, or the fallback, counted, where it is not finite.
float finite_or(float value, float fallback, int64_t* not_finite) {
    if (std::isfinite(value)) return value;
    ++*not_finite;
    return fallback;
}

/// As finite_or(); coordinates beyond kLargestCoordinate count as not finite, too, since the predicate needs
/// them to be smaller.
float coordinate_or(float value, float fallback, int64_t* not_finite) {
    return finite_or(std::abs(value) <= kLargestCoordinate ? value : HUGE_VALF, fallback, not_finite);
}

/// One plane in tiles, lanes past the end repeating the last row and column. Where a value is not finite, or
/// farther out than the predicate allows, the last good one holds: a bad vertex collapses onto a neighbour.
void pack_plane(const GridShape& shape, const float* rows, float* tiles, int64_t* not_finite) {
    float last = 0;
    for (int tv = 0; tv < shape.tiles_v(); ++tv)
        for (int tu = 0; tu < shape.tiles_u(); ++tu)
            for (int lane = 0; lane < 16; ++lane, ++tiles) {
                const int i = std::min<int>(tu * 4 + (lane & 3), shape.nu);
                const int j = std::min<int>(tv * 4 + (lane >> 2), shape.nv);
                last = *tiles = coordinate_or(rows[shape.row_index(i, j)], last, not_finite);
            }
}

/// Packs three planes from `first_plane` on; floats are clamped to +-largest.
void pack_colors(const Triples& colors, const Grid& grid, int first_plane, float largest,
                 int64_t* not_finite) {
    const size_t count = grid.shape.vertex_count();
    size_t out = first_plane * count;
    for (const std::vector<float>& plane : colors.c)
        for (size_t i = 0; i < count; ++i, ++out) {
            const float value = finite_or(plane[i], 0, not_finite);
            if (grid.float_colors)
                grid.full_colors()[out] = std::clamp(value, -largest, largest);
            else
                grid.half_colors()[out] = to_half(value);
        }
}

void pack_aovs(const std::vector<std::vector<float>>& planes, const Grid& grid, int64_t* not_finite) {
    const size_t count = grid.shape.vertex_count();
    for (int channel = 0; channel < grid.aov_channels; ++channel) {
        float* out = grid.aov_plane(channel);
        for (size_t i = 0; i < count; ++i)
            out[i] = std::clamp(finite_or(planes[channel][i], 0, not_finite), -kInfinity, kInfinity);
    }
}

bool all_opaque(const Triples& opacity, size_t count) {
    for (const std::vector<float>& plane : opacity.c)
        if (!std::all_of(plane.begin(), plane.begin() + count, [](float o) { return o >= 1; })) return false;
    return true;
}

/// The rays about one that has met something after `way`, told from it and the two beside it.
class RaysBeside {
  public:
    RaysBeside(const RayFootprint& there, const V3f& way) : axes_(unit_or_zero(way)) {
        if (!there.is_known()) return;
        const V2f a = axes_.across_of(there.origin[0]), b = axes_.across_of(there.origin[1]);
        const float area = a.x * b.y - a.y * b.x;
        // Where they come together none can be told from another.
        if (!(std::abs(area) > kLeastSine * a.length() * b.length())) return;
        a_ = V2f(b.y, -b.x) / area, b_ = V2f(-a.y, a.x) / area;
        const float length = way.length();
        for (size_t k = 0; k < 2; ++k) begin_[k] = there.origin[k] - there.direction[k] * length;
    }
    /// From the ray's beginning to that of the one which comes by at `aside` of where it is now.
    V3f origin_of(const V3f& aside) const {
        const V2f at = axes_.across_of(aside);
        const V3f origin = begin_[0] * at.dot(a_) + begin_[1] * at.dot(b_);
        return origin.length2() < kInfinity ? origin : V3f(0, 0, 0);
    }

  private:
    static constexpr float kLeastSine = 1e-3f;

    AxesAround<float> axes_;
    V2f a_{0, 0}, b_{0, 0};  ///< how many steps to either ray beside a unit across it is
    std::array<V3f, 2> begin_{V3f(0, 0, 0), V3f(0, 0, 0)};
};

}  // namespace

V3f place_at(const ShadingGrid& grid, size_t vertex, float time01) {
    if (grid.P.size() == 1) return grid.P.front().at(vertex);
    const MotionSegment at = segment_at(time01, static_cast<int>(grid.P.size()));
    const auto key = static_cast<size_t>(at.index);
    const V3f from = grid.P[key].at(vertex);
    return from + (grid.P[key + 1].at(vertex) - from) * at.local;
}

void move_hit_to(const V3f& place, ShadingGrid& grid) {
    const auto hit = static_cast<size_t>(grid.hit_vertex);
    const V3f way = place - place_at(grid, hit, grid.hit_time);
    for (Triples& P : grid.P)
        for (size_t i = 0; i < P.size(); ++i) P.set(i, P.at(i) + way);
    if (grid.P.size() == 1) grid.P.front().set(hit, place);
}

void see_hit(ShadingGrid& grid) {
    const float time = grid.hit_time;
    const MotionTurn turn = time > 0 ? turn_of(grid, {}) : MotionTurn();
    const auto hit = static_cast<size_t>(grid.hit_vertex);
    const V3f place = place_at(grid, hit, time);
    const RaysBeside beside(grid.hit_ray, place - grid.hit_from);
    grid.I.resize(grid.vertex_count());
    for (size_t i = 0; i < grid.vertex_count(); ++i) {
        V3f way = place_at(grid, i, time) - grid.hit_from;
        if (i != hit) way -= beside.origin_of(way - (place - grid.hit_from));
        grid.I.set(i, turn.back(way, time));
    }
    for (size_t k = 0; k < 2; ++k) grid.hit_across[k] = turn.back(grid.hit_ray.origin[k], time);
}

int motion_keys_of(const ShadingGrid& grid, std::span<const M44f> held) {
    const auto keys = static_cast<int>(grid.P.size());
    return keys == 1 && !held.empty() && grid.hit_vertex < 0 ? kHeldKeys : keys;
}

MotionTurn turn_of(const ShadingGrid& grid, std::span<const M44f> held) {
    return MotionTurn(*grid.primitive, motion_keys_of(grid, held),
                      grid.hit_vertex < 0 ? held : std::span<const M44f>());
}

Facing facing_for_sides(int sides, bool reverse_orientation) {
    if (sides != 1) return Facing::Both;
    return reverse_orientation ? Facing::PositiveOnly : Facing::NegativeOnly;
}

bool faces_the_eye(const Shape& shape) {
    if (std::holds_alternative<Points>(shape.topology)) return true;
    return std::holds_alternative<Curves>(shape.topology) && !shape.variables.find("N");
}

PackOptions pack_options(const Scene& scene, const Primitive& primitive) {
    // Which parts bound a solid depends on all of its surfaces; a plane cuts each hit by itself.
    return {may_be_cut(scene, primitive) || !seen_numbers(*primitive.attributes).are_all() ||
                depth_filter(scene.options) == DepthFilter::Midpoint,
            primitive.solid >= 0 || faces_the_eye(primitive.shape())};
}

Grid pack_grid(const ShadingGrid& shading, GridArena& arena, int64_t* not_finite,
               const PackOptions& options) {
    const Attributes& attributes = *shading.primitive->attributes;
    const size_t count = shading.vertex_count();
    Grid grid;
    grid.shape = shading.shape;
    grid.key_count = static_cast<uint8_t>(shading.key_count);
    grid.facing =
        options.both_sides ? Facing::Both : facing_for_sides(attributes.sides, shading.reverse_orientation);
    grid.opaque = !options.keep_hits_behind && all_opaque(shading.Oi, count);
    grid.float_colors = options.float_colors;
    grid.smooth = attributes.smooth_shading;
    grid.matte = static_cast<uint8_t>(attributes.matte);
    grid.primitive = shading.primitive_index;
    grid.ordinal = shading.ordinal;
    grid.aov_channels = static_cast<uint8_t>(shading.aovs.size());
    arena.allocate(grid);

    const size_t plane_size = grid.shape.plane_size();
    for (int segment = 0; segment < segment_count(grid.key_count); ++segment)
        for (int k = 0; k < 3; ++k) {
            float* start = grid.plane(segment, k);
            pack_plane(grid.shape, shading.P[segment].c[k].data(), start, not_finite);
            if (!grid.moves()) continue;
            float* delta = grid.plane(segment, 3 + k);
            pack_plane(grid.shape, shading.P[segment + 1].c[k].data(), delta, not_finite);
            for (size_t i = 0; i < plane_size; ++i) delta[i] -= start[i];
        }
    pack_colors(shading.Ci, grid, 0, kInfinity, not_finite);
    if (!grid.opaque) pack_colors(shading.Oi, grid, 3, kLargestHalf, not_finite);
    pack_aovs(shading.aovs, grid, not_finite);
    return grid;
}

}  // namespace trapeze
