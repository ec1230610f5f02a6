#include "composite/layers/interpolate_hits.h"

#include <algorithm>
#include <cstring>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "composite/layers/interpolate_hits.cpp"
#include <hwy/foreach_target.h>  // compiles this file once a target
#include <hwy/highway.h>

#include "core/hit_micropolygon-inl.h"

HWY_BEFORE_NAMESPACE();
namespace trapeze {
namespace HWY_NAMESPACE {

constexpr size_t kLanes = CornerCache::kMostInBatch;
using F = hn::CappedTag<float, kLanes>;
using FloatLanes = hn::Vec<F>;

/// The four corners' numbers of as many hits as there are lanes.
struct CornerLanes {
    FloatLanes k[4];
};

#if HWY_TARGET == HWY_SCALAR
template <class QuadOf>
HWY_INLINE CornerLanes load_corners(const MicropolygonCorners* const* of_hits, const QuadOf& quad_of) {
    CornerLanes lanes;
    for (int k = 0; k < 4; ++k) lanes.k[k] = hn::Set(F(), quad_of(*of_hits[0])[k]);
    return lanes;
}
#else
/// Numbers of hit `first` and of each fourth one after it, as many as d has blocks of four lanes.
template <class D, class QuadOf>
HWY_INLINE hn::Vec<D> load_blocks(D d, const MicropolygonCorners* const* of_hits, size_t first,
                                  const QuadOf& quad_of) {
    if constexpr (hn::MaxLanes(D()) == 4) {
        return hn::Load(d, quad_of(*of_hits[first]));
    } else {
        const hn::Half<D> half;
        return hn::Combine(d, load_blocks(half, of_hits, first + hn::MaxLanes(half), quad_of),
                           load_blocks(half, of_hits, first, quad_of));
    }
}
/// quad_of(corners): the four numbers to load.
template <class QuadOf>
HWY_INLINE CornerLanes load_corners(const MicropolygonCorners* const* of_hits, const QuadOf& quad_of) {
    const F d;
    const FloatLanes a = load_blocks(d, of_hits, 0, quad_of), b = load_blocks(d, of_hits, 1, quad_of),
                     c = load_blocks(d, of_hits, 2, quad_of), e = load_blocks(d, of_hits, 3, quad_of);
    const FloatLanes ac = hn::InterleaveLower(d, a, c), be = hn::InterleaveLower(d, b, e),
                     ac2 = hn::InterleaveUpper(d, a, c), be2 = hn::InterleaveUpper(d, b, e);
    return {{hn::InterleaveLower(d, ac, be), hn::InterleaveUpper(d, ac, be), hn::InterleaveLower(d, ac2, be2),
             hn::InterleaveUpper(d, ac2, be2)}};
}
#endif

/// A channel from the four corners: blend_corners() in lanes.
HWY_INLINE FloatLanes blend(const WeightLanes<FloatLanes>& w, const CornerLanes& at) {
    const FloatLanes first = at.k[0];
    FloatLanes sum = hn::Add(first, hn::Mul(w.w10, hn::Sub(at.k[1], first)));
    sum = hn::Add(sum, hn::Mul(w.w01, hn::Sub(at.k[2], first)));
    return hn::Add(sum, hn::Mul(w.w11, hn::Sub(at.k[3], first)));
}

/// Copies four numbers of a plane of tiles: where corners are is a sum of what u and v say.
struct TiledCorners {
    int at, right, below;

    TiledCorners(const GridShape& shape, const MicropolygonId& id)
        : at(shape.tiled_index(id.u, id.v)),
          right((id.u & 3) == 3 ? 13 : 1),
          below((id.v & 3) == 3 ? 16 * shape.tiles_u() - 12 : 4) {}
    HWY_INLINE void copy(const float* plane, float (&corners)[4]) const {
        const float* const first = plane + at;
        corners[0] = first[0], corners[1] = first[right];
        corners[2] = first[below], corners[3] = first[below + right];
    }
};

HWY_INLINE void copy_colors(const Grid& grid, const MicropolygonId& id, int first_plane, float (*to)[4]) {
    const size_t row = static_cast<size_t>(grid.shape.vertices_u()),
                 plane = static_cast<size_t>(grid.shape.vertex_count());
    const size_t at =
        static_cast<size_t>(first_plane) * plane + static_cast<size_t>(grid.shape.row_index(id.u, id.v));
    for (size_t c = 0; c < 3; ++c) {
        if (const float* from = grid.full_colors() + at + c * plane; grid.float_colors) {
            std::memcpy(to[c], from, 2 * sizeof(float));
            std::memcpy(to[c] + 2, from + row, 2 * sizeof(float));
            continue;
        }
        const hn::CappedTag<float, 4> d;
        const hn::Rebind<uint16_t, decltype(d)> bits;
        const Imath::half* from = grid.half_colors() + at + c * plane;
        alignas(8) uint16_t halves[4];
        std::memcpy(halves, from, 2 * sizeof(uint16_t));
        std::memcpy(halves + 2, from + row, 2 * sizeof(uint16_t));
        for (size_t i = 0; i < 4; i += hn::Lanes(d))
            hn::Store(hn::PromoteTo(d, hn::BitCast(hn::Rebind<hwy::float16_t, decltype(d)>(),
                                                   hn::Load(bits, halves + i))),
                      d, to[c] + i);
    }
}

HWY_INLINE void fill_corners(const Grid& grid, const MicropolygonId& id, int segment,
                             MicropolygonCorners& to) {
    const TiledCorners corners(grid.shape, id);
    for (int c = 0; c < 3; ++c) corners.copy(grid.plane(segment, c), to.start[c]);
    if (grid.moves())
        for (int c = 0; c < 3; ++c) corners.copy(grid.plane(segment, 3 + c), to.delta[c]);
    else
        std::memset(to.delta, 0, sizeof to.delta);
    copy_colors(grid, id, 0, to.color);
    if (!grid.opaque) copy_colors(grid, id, 3, to.opacity);
}

/// Hits on smooth grids, in lanes until these are full.
class HitLanes {
  public:
    HitLanes(CornerCache& cache, float* const* planes) : cache_(cache), planes_(planes) {
        cache_.begin_batch();
    }

    /// `place`: of the hit's numbers in planes.
    HWY_INLINE void add(const MicropolygonCorners* corners, const Grid& grid, const AxisRay& ray,
                        float local_time, size_t place) {
        corners_[count_] = corners, places_[count_] = place;
        ox_[count_] = ray.ox, oy_[count_] = ray.oy, oz_[count_] = ray.oz;
        ux_[count_] = ray.ux, uy_[count_] = ray.uy, local_time_[count_] = local_time;
        opaque_[count_] = grid.opaque ? ~0u : 0u;
        moves_ |= grid.moves(), some_see_through_ |= !grid.opaque;
        ++count_;
    }
    bool is_full() const { return count_ == kLanes; }

    void interpolate() {
        if (count_ == 0) return;
        std::fill(corners_ + count_, corners_ + kLanes, corners_[0]);
        const bool in_a_row = count_ == kLanes && places_[count_ - 1] == places_[0] + count_ - 1;
        alignas(64) float numbers[kLayerPlanes][kLanes];
        float* to[kLayerPlanes];
        for (size_t k = 0; k < kLayerPlanes; ++k) to[k] = in_a_row ? planes_[k] + places_[0] : numbers[k];
        for (size_t i = 0; i < kLanes; i += hn::Lanes(F())) interpolate_lanes(i, to);
        for (size_t k = 0; k < kLayerPlanes && !in_a_row; ++k)
            for (size_t i = 0; i < count_; ++i) planes_[k][places_[i]] = numbers[k][i];
        count_ = 0;
        moves_ = some_see_through_ = false;
        cache_.begin_batch();
    }

  private:
    HWY_INLINE void interpolate_lanes(size_t i, float* const* to) const {
        const F d;
        const FloatLanes local = hn::Load(d, local_time_ + i), one = hn::Set(d, 1.0f);
        const MicropolygonCorners* const* const corners = corners_ + i;
        CornerLanes position[3];
        for (int c = 0; c < 3; ++c) {
            position[c] = load_corners(corners, [c](const MicropolygonCorners& m) { return m.start[c]; });
            if (!moves_) continue;
            const CornerLanes delta =
                load_corners(corners, [c](const MicropolygonCorners& m) { return m.delta[c]; });
            for (int k = 0; k < 4; ++k) position[c].k[k] = position_at(position[c].k[k], delta.k[k], local);
        }
        const auto vertex = [&](int component, int corner) HWY_ATTR { return position[component].k[corner]; };
        const WeightLanes<FloatLanes> w =
            hit_weights(d, quad_lanes(hn::Load(d, ox_ + i), hn::Load(d, oy_ + i), hn::Load(d, oz_ + i),
                                      hn::Load(d, ux_ + i), hn::Load(d, uy_ + i), vertex));
        for (int c = 0; c < 3; ++c) {
            const auto colors =
                load_corners(corners, [c](const MicropolygonCorners& m) { return m.color[c]; });
            hn::StoreU(blend(w, colors), d, to[c] + i);
        }
        for (int c = 0; c < 3; ++c) {
            FloatLanes opacity = one;  // weights sum to 1 only within rounding
            if (some_see_through_) {
                const auto opaque =
                    hn::MaskFromVec(hn::BitCast(d, hn::Load(hn::RebindToUnsigned<F>(), opaque_ + i)));
                const auto of_corners =
                    load_corners(corners, [c](const MicropolygonCorners& m) { return m.opacity[c]; });
                opacity = hn::IfThenElse(opaque, one, blend(w, of_corners));
            }
            hn::StoreU(opacity, d, to[3 + c] + i);
        }
    }

    CornerCache& cache_;
    float* const* planes_;
    const MicropolygonCorners* corners_[kLanes];
    size_t places_[kLanes];
    alignas(64) float ox_[kLanes] = {}, oy_[kLanes] = {}, oz_[kLanes] = {}, ux_[kLanes] = {},
                      uy_[kLanes] = {}, local_time_[kLanes] = {};
    alignas(64) uint32_t opaque_[kLanes] = {};  ///< all bits set where it holds
    size_t count_ = 0;
    bool moves_ = false, some_see_through_ = false;
};

/// Hits in a row of one micropolygon: places `begin` to `end`. A sample mostly sees what the one before it
/// sees.
struct HitRow {
    size_t begin, end;
    MicropolygonId id;
};

HitRow row_from(std::span<const Hit> hits, size_t begin) {
    size_t end = begin + 1;
    while (end < hits.size() && hits[end].id == hits[begin].id) ++end;
    return {begin, end, MicropolygonId::unpack(hits[begin].id)};
}

void put_constant(const HitRow& row, const Grid& grid, float* const* planes) {
    const V3f color = grid.color(row.id.u, row.id.v), opacity = grid.opacity(row.id.u, row.id.v);
    for (int c = 0; c < 3; ++c) {
        std::fill(planes[c] + row.begin, planes[c] + row.end, color[c]);
        std::fill(planes[3 + c] + row.begin, planes[3 + c] + row.end, opacity[c]);
    }
}

HWY_INLINE void add_smooth(const HitRow& row, const Grid& grid, const HitsToInterpolate& task,
                           CornerCache& cache, HitLanes& lanes) {
    const MicropolygonCorners* corners = nullptr;  // of a segment
    int of_segment = -1;
    for (size_t place = row.begin; place < row.end; ++place) {
        const AxisRay& ray = task.rays[task.ray_of[place]];
        const MotionSegment segment = segment_at(ray.time, grid.key_count);
        if (!corners || segment.index != of_segment) {
            of_segment = segment.index;
            corners = cache.find(row.id.packed() | static_cast<uint64_t>(segment.index) << 40,
                                 [&](MicropolygonCorners& to)
                                     HWY_ATTR { fill_corners(grid, row.id, segment.index, to); });
        }
        lanes.add(corners, grid, ray, segment.local, place);
        if (!lanes.is_full()) continue;
        lanes.interpolate();
        corners = nullptr;  // the next batch has to ask again
    }
}

HitKinds interpolate_hits_in_lanes(const HitsToInterpolate& task, CornerCache& cache) {
    HitLanes lanes(cache, task.planes);
    HitKinds kinds;
    for (size_t place = 0; place < task.hits.size();) {
        const HitRow row = row_from(task.hits, place);
        place = row.end;
        if (row.id.grid >= task.grids.grids.size()) {
            kinds = {false, false};
            continue;
        }
        const Grid& grid = task.grids.grids[row.id.grid];
        kinds.all_cover &= grid.opaque && !grid.matte;
        kinds.all_plain &= !grid.matte;
        if (grid.smooth)
            add_smooth(row, grid, task, cache, lanes);
        else
            put_constant(row, grid, task.planes);
    }
    lanes.interpolate();
    return kinds;
}

}  // namespace HWY_NAMESPACE
}  // namespace trapeze
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace trapeze {

HWY_EXPORT(interpolate_hits_in_lanes);

HitKinds interpolate_hits(const HitsToInterpolate& task, CornerCache& cache) {
    return HWY_DYNAMIC_DISPATCH(interpolate_hits_in_lanes)(task, cache);
}

}  // namespace trapeze
#endif  // HWY_ONCE
