#include "composite/film/hit_layers.h"

#include <algorithm>
#include <cstring>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "composite/film/hit_layers.cpp"
#include <hwy/foreach_target.h>  // compiles this file once a target
#include <hwy/highway.h>

#ifndef TRAPEZE_COMPOSITE_HIT_LAYERS_ONCE
#define TRAPEZE_COMPOSITE_HIT_LAYERS_ONCE
namespace trapeze {

/// What is needed of some hits on smooth grids, from all over memory to lanes.
struct GatheredHits {
    static constexpr size_t kCount = 16;

    template <class T>
    using Lanes = T[kCount];
    /// One number of each hit's four corners, two of which lie next to each other in memory.
    template <class T>
    using Corners = T[kCount][4];

    alignas(64) Lanes<float> ox, oy, oz, ux, uy, local_time;
    /// Coordinates at the segment's first key, and on to its next.
    alignas(64) Corners<float> start[3], delta[3];
    alignas(64) Corners<uint16_t> color[3], opacity[3];  ///< halves
    /// Where colours are floats.
    alignas(64) Corners<float> full_color[3], full_opacity[3];
    alignas(64) Lanes<uint32_t> opaque;  ///< all bits set where it holds
    bool moves = false, some_see_through = false, float_colors = false;
};

}  // namespace trapeze
#endif

#include "core/hit_micropolygon-inl.h"

HWY_BEFORE_NAMESPACE();
namespace trapeze {
namespace HWY_NAMESPACE {

using F = hn::CappedTag<float, GatheredHits::kCount>;
using FloatLanes = hn::Vec<F>;

/// The four corners' numbers of as many hits as there are lanes.
struct CornerLanes {
    FloatLanes k[4];
};

HWY_INLINE CornerLanes load_corners(const float (*corners)[4]) {
    CornerLanes lanes;
    hn::LoadInterleaved4(F(), corners[0], lanes.k[0], lanes.k[1], lanes.k[2], lanes.k[3]);
    return lanes;
}
HWY_INLINE CornerLanes load_corners(const uint16_t (*corners)[4]) {
    const hn::Rebind<uint16_t, F> bits;
    const hn::Rebind<hwy::float16_t, F> half;
    hn::Vec<decltype(bits)> b[4];
    hn::LoadInterleaved4(bits, corners[0], b[0], b[1], b[2], b[3]);
    CornerLanes lanes;
    for (int k = 0; k < 4; ++k) lanes.k[k] = hn::PromoteTo(F(), hn::BitCast(half, b[k]));
    return lanes;
}

/// A channel from the four corners, halves or floats.
template <class T>
HWY_INLINE FloatLanes blend(const WeightLanes<FloatLanes>& w, const T (*corners)[4]) {
    const CornerLanes at = load_corners(corners);
    FloatLanes sum = hn::Add(hn::Zero(F()), hn::Mul(w.w00, at.k[0]));
    sum = hn::Add(sum, hn::Mul(w.w10, at.k[1]));
    sum = hn::Add(sum, hn::Mul(w.w01, at.k[2]));
    return hn::Add(sum, hn::Mul(w.w11, at.k[3]));
}

/// Of hits whose colours are `color` and `opacities`.
template <class T>
HWY_INLINE void blend_corners(const GatheredHits& hits, const GatheredHits::Corners<T>* color,
                              const GatheredHits::Corners<T>* opacities, float* const* planes) {
    const F d;
    const auto mask_at = [d](const uint32_t* lanes) HWY_ATTR {
        return hn::MaskFromVec(hn::BitCast(d, hn::Load(hn::RebindToUnsigned<F>(), lanes)));
    };
    for (size_t i = 0; i < GatheredHits::kCount; i += hn::Lanes(d)) {
        const FloatLanes local = hn::Load(d, hits.local_time + i), one = hn::Set(d, 1.0f);
        CornerLanes position[3];
        for (int c = 0; c < 3; ++c) {
            position[c] = load_corners(hits.start[c] + i);
            if (!hits.moves) continue;
            const CornerLanes delta = load_corners(hits.delta[c] + i);
            for (int k = 0; k < 4; ++k) position[c].k[k] = position_at(position[c].k[k], delta.k[k], local);
        }
        const auto vertex = [&](int component, int corner) HWY_ATTR { return position[component].k[corner]; };
        const WeightLanes<FloatLanes> w = hit_weights(
            d, quad_lanes(hn::Load(d, hits.ox + i), hn::Load(d, hits.oy + i), hn::Load(d, hits.oz + i),
                          hn::Load(d, hits.ux + i), hn::Load(d, hits.uy + i), vertex));
        for (int c = 0; c < 3; ++c) hn::StoreU(blend(w, color[c] + i), d, planes[c] + i);
        for (int c = 0; c < 3; ++c) {
            FloatLanes opacity = one;  // weights sum to 1 only within rounding
            if (hits.some_see_through)
                opacity = hn::IfThenElse(mask_at(hits.opaque + i), one, blend(w, opacities[c] + i));
            hn::StoreU(opacity, d, planes[3 + c] + i);
        }
    }
}

void blend_hits(const GatheredHits& hits, float* const* planes) {
    if (hits.float_colors)
        blend_corners(hits, hits.full_color, hits.full_opacity, planes);
    else
        blend_corners(hits, hits.color, hits.opacity, planes);
}

}  // namespace HWY_NAMESPACE
}  // namespace trapeze
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace trapeze {

HWY_EXPORT(blend_hits);

namespace {

/// Copies a micropolygon's corners from a plane of colours, row by row.
template <class Stored, class Lane>
void copy_corners(const Stored* at, int vertices_u, Lane (&corners)[4]) {
    static_assert(sizeof(Stored) == sizeof(Lane));
    std::memcpy(corners, at, 2 * sizeof(Lane));
    std::memcpy(corners + 2, at + vertices_u, 2 * sizeof(Lane));
}

/// Gathers a hit's colours and opacities at its corners, as lane `lane`.
template <class Stored, class Lane>
void gather_colors(const Grid& grid, const Stored* planes, const MicropolygonId& id, size_t lane,
                   GatheredHits::Corners<Lane>* color, GatheredHits::Corners<Lane>* opacity) {
    const int size = grid.shape.vertex_count(), row = grid.shape.vertices_u();
    const Stored* at = planes + grid.shape.row_index(id.u, id.v);
    for (int c = 0; c < 3; ++c, at += size) copy_corners(at, row, color[c][lane]);
    if (grid.opaque) return;
    for (int c = 0; c < 3; ++c, at += size) copy_corners(at, row, opacity[c][lane]);
}

/// Where a micropolygon's corners are in planes of tiles.
struct TiledCorners {
    int at[4];
    bool in_one_tile;

    TiledCorners(const GridShape& shape, int u, int v) : in_one_tile((u & 3) < 3 && (v & 3) < 3) {
        at[0] = shape.tiled_index(u, v);
        if (in_one_tile) return;
        for (int k = 1; k < 4; ++k) at[k] = shape.tiled_index(u + (k & 1), v + (k >> 1));
    }
    void copy(const float* plane, float (&corners)[4]) const {
        if (in_one_tile) {
            std::memcpy(corners, plane + at[0], 2 * sizeof(float));
            std::memcpy(corners + 2, plane + at[0] + 4, 2 * sizeof(float));
        } else {
            for (int k = 0; k < 4; ++k) corners[k] = plane[at[k]];
        }
    }
};

/// Gathers what interpolation needs of a hit: its ray, corners, colours and opacities, as lane `lane`.
void gather_hit(const AxisRay& ray, const Grid& grid, const MicropolygonId& id, size_t lane,
                GatheredHits& to) {
    to.ox[lane] = ray.ox, to.oy[lane] = ray.oy, to.oz[lane] = ray.oz;
    to.ux[lane] = ray.ux, to.uy[lane] = ray.uy;
    const TiledCorners corners(grid.shape, id.u, id.v);
    const MotionSegment segment = grid.moves() ? segment_at(ray.time, grid.key_count) : MotionSegment{};
    to.local_time[lane] = segment.local;
    const int size = grid.shape.plane_size();
    const float* plane = grid.plane(segment.index, 0);
    for (int c = 0; c < 3; ++c, plane += size) corners.copy(plane, to.start[c][lane]);
    if (grid.moves()) {
        to.moves = true;
        for (int c = 0; c < 3; ++c, plane += size) corners.copy(plane, to.delta[c][lane]);
    } else {
        for (auto& delta : to.delta) std::fill_n(delta[lane], 4, 0.0f);
    }
    if (to.float_colors)
        gather_colors(grid, grid.full_colors(), id, lane, to.full_color, to.full_opacity);
    else
        gather_colors(grid, grid.half_colors(), id, lane, to.color, to.opacity);
    to.opaque[lane] = grid.opaque ? ~0u : 0u;
    to.some_see_through |= !grid.opaque;
}

}  // namespace

Layer layer_at(const AxisRay& ray, const Grid& grid, const MicropolygonId& id) {
    if (!grid.smooth) return {grid.color(id.u, id.v), grid.opacity(id.u, id.v)};
    const QuadWeights weights = hit_weights(ray, grid.quad(id.u, id.v, ray.time));
    Layer layer{V3f(0), V3f(0)};
    for (int corner = 0; corner < 4; ++corner) {
        const int i = id.u + (corner & 1), j = id.v + (corner >> 1);
        layer.color += weights.w[corner] * grid.color(i, j);
        if (!grid.opaque) layer.opacity += weights.w[corner] * grid.opacity(i, j);
    }
    if (grid.opaque) layer.opacity = V3f(1);  // weights sum to 1 only within rounding
    return layer;
}

void HitLayers::interpolate(const SampleTile& samples, const HitBuffer& hits, size_t begin, size_t end,
                            const Grids& grids) {
    first_ = hits.first[begin];
    const size_t count = hits.first[end] - first_;
    for (std::vector<float>& plane : planes_)
        plane.resize(std::max(plane.size(), count + GatheredHits::kCount));
    GatheredHits gathered{};
    gathered.float_colors = !grids.grids.empty() && grids.grids.front().float_colors;
    const size_t grid_count = grids.grids.size();
    size_t at = 0, lane = 0, places[GatheredHits::kCount];
    const auto blend = [&] {
        alignas(64) GatheredHits::Lanes<float> blended[6];
        float* planes[6];
        const bool in_a_row = lane == GatheredHits::kCount && places[lane - 1] == places[0] + lane - 1;
        for (size_t k = 0; k < 6; ++k) planes[k] = in_a_row ? planes_[k].data() + places[0] : blended[k];
        HWY_DYNAMIC_DISPATCH(blend_hits)(gathered, planes);
        for (size_t k = 0; k < 6 && !in_a_row; ++k)
            for (size_t i = 0; i < lane; ++i) planes_[k][places[i]] = blended[k][i];
        lane = 0;
        gathered.moves = gathered.some_see_through = false;
    };
    for (size_t sample = begin; sample < end; ++sample)
        for (const Hit& hit : hits.of(sample)) {
            const size_t place = at++;
            const MicropolygonId id = MicropolygonId::unpack(hit.id);
            if (id.grid >= grid_count) continue;
            const Grid& grid = grids.grids[id.grid];
            if (!grid.smooth) {
                put(place, {grid.color(id.u, id.v), grid.opacity(id.u, id.v)});
                continue;
            }
            gather_hit(samples.rays[sample], grid, id, lane, gathered);
            places[lane] = place;
            if (++lane == GatheredHits::kCount) blend();
        }
    if (lane > 0) blend();
}

}  // namespace trapeze
#endif  // HWY_ONCE
