#include "composite/film/hit_layers.h"

#include <algorithm>

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

    alignas(64) Lanes<float> ox, oy, oz, ux, uy, local_time;
    /// Coordinate c of corner k is row 4 * c + k: at the segment's first key, and on to its next.
    alignas(64) Lanes<float> start[12], delta[12];
    /// Channel c of corner k is row 4 * c + k of these, or, where colours are floats, of those after them.
    alignas(64) Lanes<uint16_t> color[12], opacity[12];  ///< halves
    alignas(64) Lanes<float> full_color[12], full_opacity[12];
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

HWY_INLINE FloatLanes load_lanes(const float* row) {
    return hn::Load(F(), row);
}
HWY_INLINE FloatLanes load_lanes(const uint16_t* row) {
    const hn::Rebind<hwy::float16_t, F> half;
    return hn::PromoteTo(F(), hn::Load(half, reinterpret_cast<const hwy::float16_t*>(row)));
}

/// A channel from the four corners, halves or floats.
template <class T>
HWY_INLINE FloatLanes blend(const WeightLanes<FloatLanes>& w, const GatheredHits::Lanes<T>* corners,
                            size_t i) {
    FloatLanes sum = hn::Add(hn::Zero(F()), hn::Mul(w.w00, load_lanes(corners[0] + i)));
    sum = hn::Add(sum, hn::Mul(w.w10, load_lanes(corners[1] + i)));
    sum = hn::Add(sum, hn::Mul(w.w01, load_lanes(corners[2] + i)));
    return hn::Add(sum, hn::Mul(w.w11, load_lanes(corners[3] + i)));
}

/// Of hits whose colours are the rows `color` and `opacity`.
template <class T>
HWY_INLINE void blend_rows(const GatheredHits& hits, const GatheredHits::Lanes<T>* color,
                           const GatheredHits::Lanes<T>* opacities, float* const* planes) {
    const F d;
    const auto mask_at = [d](const uint32_t* lanes) HWY_ATTR {
        return hn::MaskFromVec(hn::BitCast(d, hn::Load(hn::RebindToUnsigned<F>(), lanes)));
    };
    for (size_t i = 0; i < GatheredHits::kCount; i += hn::Lanes(d)) {
        const FloatLanes local = hn::Load(d, hits.local_time + i), one = hn::Set(d, 1.0f);
        const auto vertex = [&](int component, int corner) HWY_ATTR {
            const int row = 4 * component + corner;
            const FloatLanes start = hn::Load(d, hits.start[row] + i);
            if (!hits.moves) return start;
            return position_at(start, hn::Load(d, hits.delta[row] + i), local);
        };
        const WeightLanes<FloatLanes> w = hit_weights(
            d, quad_lanes(hn::Load(d, hits.ox + i), hn::Load(d, hits.oy + i), hn::Load(d, hits.oz + i),
                          hn::Load(d, hits.ux + i), hn::Load(d, hits.uy + i), vertex));
        for (int c = 0; c < 3; ++c) hn::StoreU(blend(w, color + 4 * c, i), d, planes[c] + i);
        for (int c = 0; c < 3; ++c) {
            FloatLanes opacity = one;  // weights sum to 1 only within rounding
            if (hits.some_see_through)
                opacity = hn::IfThenElse(mask_at(hits.opaque + i), one, blend(w, opacities + 4 * c, i));
            hn::StoreU(opacity, d, planes[3 + c] + i);
        }
    }
}

void blend_hits(const GatheredHits& hits, float* const* planes) {
    if (hits.float_colors)
        blend_rows(hits, hits.full_color, hits.full_opacity, planes);
    else
        blend_rows(hits, hits.color, hits.opacity, planes);
}

}  // namespace HWY_NAMESPACE
}  // namespace trapeze
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace trapeze {

HWY_EXPORT(blend_hits);

namespace {

uint16_t lane_value(Imath::half value) {
    return value.bits();
}
float lane_value(float value) {
    return value;
}

/// Gathers three planes of `size` values at a hit's four corners, as lane `lane` of twelve rows.
template <class Stored, class Lane>
void gather_planes(const Stored* planes, size_t size, const int* at, size_t lane,
                   GatheredHits::Lanes<Lane>* rows) {
    for (size_t c = 0; c < 3; ++c)
        for (int k = 0; k < 4; ++k) rows[4 * c + k][lane] = lane_value(planes[c * size + at[k]]);
}

/// Gathers a hit's colours and opacities at its four corners, places `at` in planes of rows.
void gather_colors(const Grid& grid, const int* at, size_t lane, GatheredHits& to) {
    const auto size = static_cast<size_t>(grid.shape.vertex_count());
    if (to.float_colors) {
        gather_planes(grid.full_colors(), size, at, lane, to.full_color);
        if (!grid.opaque) gather_planes(grid.full_colors() + 3 * size, size, at, lane, to.full_opacity);
    } else {
        gather_planes(grid.half_colors(), size, at, lane, to.color);
        if (!grid.opaque) gather_planes(grid.half_colors() + 3 * size, size, at, lane, to.opacity);
    }
}

/// Gathers what interpolation needs of a hit: its ray, corners, colours and opacities, as lane `lane`.
void gather_hit(const AxisRay& ray, const Grid& grid, const MicropolygonId& id, size_t lane,
                GatheredHits& to) {
    to.ox[lane] = ray.ox, to.oy[lane] = ray.oy, to.oz[lane] = ray.oz;
    to.ux[lane] = ray.ux, to.uy[lane] = ray.uy;
    int tiled[4], in_rows[4];
    for (int k = 0; k < 4; ++k) {
        const int i = id.u + (k & 1), j = id.v + (k >> 1);
        tiled[k] = grid.shape.tiled_index(i, j), in_rows[k] = grid.shape.row_index(i, j);
    }
    const MotionSegment segment = grid.moves() ? segment_at(ray.time, grid.key_count) : MotionSegment{};
    to.local_time[lane] = segment.local;
    for (int c = 0; c < 3; ++c) {
        const float* start = grid.plane(segment.index, c);
        for (int k = 0; k < 4; ++k) to.start[4 * c + k][lane] = start[tiled[k]];
    }
    if (grid.moves()) {
        to.moves = true;
        for (int c = 0; c < 3; ++c) {
            const float* delta = grid.plane(segment.index, 3 + c);
            for (int k = 0; k < 4; ++k) to.delta[4 * c + k][lane] = delta[tiled[k]];
        }
    } else {
        for (auto& row : to.delta) row[lane] = 0;
    }
    gather_colors(grid, in_rows, lane, to);
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
