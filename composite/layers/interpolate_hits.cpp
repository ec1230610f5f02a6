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

/// The same where all hits are on one micropolygon.
template <class QuadOf>
HWY_INLINE CornerLanes load_corners(const MicropolygonCorners& of_all, const QuadOf& quad_of) {
    const F d;
    const float* const quad = quad_of(of_all);
    return {{hn::Set(d, quad[0]), hn::Set(d, quad[1]), hn::Set(d, quad[2]), hn::Set(d, quad[3])}};
}

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

/// Numbers of the rays of as many hits as there are lanes.
struct RayLanes {
    const std::array<const float*, RayPlanes::kPlanes>& planes;
    const uint32_t* numbers;
    bool follow;  ///< each other, as mostly those of samples in a row do

    HWY_INLINE FloatLanes of(RayPlanes::Plane plane) const {
        const F d;
        if (follow) return hn::LoadU(d, planes[plane] + numbers[0]);
        const auto lanes = hn::Load(hn::RebindToSigned<F>(), reinterpret_cast<const int32_t*>(numbers));
        return hn::GatherIndex(d, planes[plane], lanes);
    }
};

/// Hits on smooth grids, in lanes until these are full.
class HitLanes {
  public:
    HitLanes(CornerCache& cache, const HitsToInterpolate& task) : cache_(cache), task_(task) {
        cache_.begin_batch();
    }

    /// Hits in a row of one micropolygon and segment, as many as there is room for, of places `begin` to
    /// `end` in the planes; returns the place behind them. Of a grid that does not move local times are 0.
    HWY_INLINE size_t add(const MicropolygonCorners* corners, const Grid& grid, size_t begin, size_t end) {
        const size_t count = std::min(end - begin, kLanes - count_);
        if (count_ == 0) begin_ = begin;
        follow_ &= begin == begin_ + count_;
        differ_ |= count_ > 0 && corners != corners_[0];
        moves_ |= grid.moves(), some_see_through_ |= !grid.opaque;
        for (size_t i = count_, place = begin; i < count_ + count; ++i, ++place) {
            corners_[i] = corners, places_[i] = place, rays_[i] = task_.ray_of[place];
            opaque_[i] = grid.opaque ? ~0u : 0u;
            rays_follow_ &= rays_[i] == rays_[0] + i;
            local_time_[i] = segment_at(task_.rays[task_.ray_of[place]].time, grid.key_count).local;
        }
        count_ += count;
        return begin + count;
    }
    bool is_full() const { return count_ == kLanes; }

    void interpolate() {
        if (count_ == 0) return;
        std::fill(corners_ + count_, corners_ + kLanes, corners_[0]);
        std::fill(rays_ + count_, rays_ + kLanes, rays_[0]);
        const bool in_a_row = count_ == kLanes && follow_;
        alignas(64) float numbers[kLayerPlanes][kLanes];
        float* to[kLayerPlanes];
        for (size_t k = 0; k < kLayerPlanes; ++k) to[k] = in_a_row ? task_.planes[k] + begin_ : numbers[k];
        for (size_t i = 0; i < kLanes; i += hn::Lanes(F()))
            if (differ_)
                interpolate_lanes(i, corners_ + i, to);
            else
                interpolate_lanes(i, *corners_[0], to);
        for (size_t k = 0; k < kLayerPlanes && !in_a_row; ++k)
            for (size_t i = 0; i < count_; ++i) task_.planes[k][places_[i]] = numbers[k][i];
        count_ = 0;
        follow_ = rays_follow_ = true;
        differ_ = moves_ = some_see_through_ = false;
        cache_.begin_batch();
    }

  private:
    /// `corners`: of each lane, or those of all.
    template <class Corners>
    HWY_INLINE void interpolate_lanes(size_t i, const Corners& corners, float* const* to) const {
        const F d;
        const FloatLanes local = hn::Load(d, local_time_ + i), one = hn::Set(d, 1.0f);
        const RayLanes ray{task_.rays.planes(), rays_ + i, rays_follow_ && count_ == kLanes};
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
            hit_weights(d, quad_lanes(ray.of(RayPlanes::kOx), ray.of(RayPlanes::kOy), ray.of(RayPlanes::kOz),
                                      ray.of(RayPlanes::kUx), ray.of(RayPlanes::kUy), vertex));
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
    const HitsToInterpolate& task_;
    const MicropolygonCorners* corners_[kLanes];
    size_t places_[kLanes];
    alignas(64) uint32_t rays_[kLanes] = {};
    alignas(64) float local_time_[kLanes] = {};
    alignas(64) uint32_t opaque_[kLanes] = {};  ///< all bits set where it holds
    size_t count_ = 0, begin_ = 0;
    bool follow_ = true, rays_follow_ = true;  ///< each other: places, from begin_ on; rays
    bool differ_ = false;                      ///< corners
    bool moves_ = false, some_see_through_ = false;
};

/// Hits in a row of one micropolygon: places `begin` to `end`. A sample mostly sees what the one before it
/// sees, layer by layer.
struct HitRow {
    size_t begin, end;
    MicropolygonId id;
};

HitRow row_from(const HitsToInterpolate& task, size_t begin) {
    const uint64_t id = task.id(begin);
    size_t end = begin + 1;
    while (end < task.count && task.id(end) == id) ++end;
    return {begin, end, MicropolygonId::unpack(id)};
}

void put_constant(const HitRow& row, const Grid& grid, float* const* planes) {
    const V3f color = grid.color(row.id.u, row.id.v), opacity = grid.opacity(row.id.u, row.id.v);
    for (int c = 0; c < 3; ++c) {
        std::fill(planes[c] + row.begin, planes[c] + row.end, color[c]);
        std::fill(planes[3 + c] + row.begin, planes[3 + c] + row.end, opacity[c]);
    }
}

/// The end of the hits from `begin` on, within a row, whose rays meet the grid in one segment of its motion.
HWY_INLINE size_t end_of_segment(const HitsToInterpolate& task, const Grid& grid, size_t begin,
                                 size_t row_end, int segment) {
    if (grid.key_count <= 2) return row_end;
    size_t end = begin + 1;
    while (end < row_end && segment_at(task.rays[task.ray_of[end]].time, grid.key_count).index == segment)
        ++end;
    return end;
}

HWY_INLINE void add_smooth(const HitRow& row, const Grid& grid, const HitsToInterpolate& task,
                           CornerCache& cache, HitLanes& lanes) {
    for (size_t place = row.begin; place < row.end;) {
        const int segment = segment_at(task.rays[task.ray_of[place]].time, grid.key_count).index;
        const size_t end = end_of_segment(task, grid, place, row.end, segment);
        while (place < end) {
            const MicropolygonCorners* const corners = cache.find(
                row.id.packed() | static_cast<uint64_t>(segment) << 40,
                [&](MicropolygonCorners& to) HWY_ATTR { fill_corners(grid, row.id, segment, to); });
            place = lanes.add(corners, grid, place, end);
            if (lanes.is_full()) lanes.interpolate();
        }
    }
}

HitKinds interpolate_hits_in_lanes(const HitsToInterpolate& task, CornerCache& cache) {
    HitLanes lanes(cache, task);
    HitKinds kinds;
    for (size_t place = 0; place < task.count;) {
        const HitRow row = row_from(task, place);
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
