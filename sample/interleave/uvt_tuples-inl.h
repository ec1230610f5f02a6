/// Which tuples may see a grid in a tile: lanes are tuples, and the grid is its box at each tuple's time,
/// seen from its lens point. Compiled once a target; see Highway's foreach_target.h.
#if defined(TRAPEZE_SAMPLE_UVT_TUPLES_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef TRAPEZE_SAMPLE_UVT_TUPLES_INL_H_
#undef TRAPEZE_SAMPLE_UVT_TUPLES_INL_H_
#else
#define TRAPEZE_SAMPLE_UVT_TUPLES_INL_H_
#endif

#include <hwy/highway.h>

#include <algorithm>
#include <limits>

#include "core/simd/simd-inl.h"
#include "sample/interleave/uvt_raster.h"

HWY_BEFORE_NAMESPACE();
namespace trapeze {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

using UvtLanes = hn::CappedTag<float, UvtQueue::kPadding>;

/// Scale from the image plane to pixels counted from a tile's corner. Floats suffice: what they round is
/// within the slack that boxes are grown by.
struct TileScale {
    float scale_x, offset_x, scale_y, offset_y;

    TileScale(const Camera& camera, const UvtTile& tile)
        : scale_x(1 / camera.plane_scale_x),
          offset_x(-camera.plane_offset_x / camera.plane_scale_x - static_cast<float>(tile.x0())),
          scale_y(1 / camera.plane_scale_y),
          offset_y(-camera.plane_offset_y / camera.plane_scale_y - static_cast<float>(tile.y0())) {}
};

/// No vertex is nearer than this where it is bounded.
HWY_INLINE float safe_depth(const GridBound& bound) {
    return bound.boundable ? bound.z_safe : std::numeric_limits<float>::infinity();
}

/// The range of the image plane in which a range of a coordinate is seen through a lens point at depths of
/// which near_w and far_w are one over the ends, before slopes are added.
template <bool kPerspective, class V>
HWY_INLINE void image_range(V low, V high, V lens, V near_w, V far_w, V* min, V* max) {
    low = hn::Sub(low, lens), high = hn::Sub(high, lens);
    if constexpr (kPerspective) {
        *min = hn::Min(hn::Mul(low, near_w), hn::Mul(low, far_w));
        *max = hn::Max(hn::Mul(high, near_w), hn::Mul(high, far_w));
    } else {
        *min = low, *max = high;
    }
}

/// The cells along an axis that hold coordinates `at`, in pixels from the tile's corner; in [0, cells].
template <class D, class DI, class V>
HWY_INLINE hn::Vec<DI> cell_of(D d, DI di, V at, float cell_side, int cells) {
    const auto index = hn::Floor(hn::Mul(at, hn::Set(d, 1 / cell_side)));
    return hn::ConvertTo(di, hn::Min(hn::Max(index, hn::Zero(d)), hn::Set(d, static_cast<float>(cells))));
}

/// A vector of tuples: the grid's box as each sees it, in pixels of the tile and in depth, and its slack.
struct TupleLanes {
    hn::Vec<UvtLanes> slack, z0, x0, x1, y0, y1;
    hn::Mask<UvtLanes> seen;     ///< the others are left out
    hn::Mask<UvtLanes> unsafe;   ///< too near to be bounded: it may be anywhere
    hn::Mask<UvtLanes> careful;  ///< parts may be too near, or clipped
};

/// Appends the tuples from `first` on that see the grid.
HWY_INLINE void keep_tuples(const UvtRaster& raster, const UvtTile& tile, size_t first,
                            const TupleLanes& lanes, UvtGridTuples& found) {
    const UvtLanes d;
    const hn::RebindToSigned<UvtLanes> di;
    const auto seen_i = hn::RebindMask(di, lanes.seen);
    const auto index = lane_numbers(di, static_cast<int32_t>(first));
    hn::StoreU(hn::Compress(index, seen_i), di, &found.tuple[found.count]);
    hn::StoreU(hn::Compress(lanes.slack, lanes.seen), d, &found.slack[found.count]);
    hn::StoreU(hn::Compress(hn::IfThenElseZero(lanes.careful, hn::Set(d, 1.0f)), lanes.seen), d,
               &found.careful[found.count]);
    if (raster.cull) {
        const float side = static_cast<float>(tile.cell_side());
        const auto store = [&](hn::Vec<UvtLanes> value, int cells, std::vector<int32_t>& to_plane,
                               float unbounded) HWY_ATTR {
            value = hn::IfThenElse(lanes.unsafe, hn::Set(d, unbounded), value);
            hn::StoreU(hn::Compress(cell_of(d, di, value, side, cells), seen_i), di, &to_plane[found.count]);
        };
        store(lanes.x0, tile.cells_x() - 1, found.first_x, 0.0f);
        store(lanes.x1, tile.cells_x() - 1, found.last_x, 1e9f);
        store(lanes.y0, tile.cells_y() - 1, found.first_y, 0.0f);
        store(lanes.y1, tile.cells_y() - 1, found.last_y, 1e9f);
        hn::StoreU(hn::Compress(lanes.z0, lanes.seen), d, &found.z_min[found.count]);
    }
    found.count += hn::CountTrue(d, lanes.seen);
}

/// Lists the tuples that may see a grid in a tile, in their order, with the slack of each and, for culling,
/// cells and least depth. Conservative: boxes are grown by the rounding of the predicate (RoundingSlack).
template <bool kPerspective>
void find_tuples(const UvtRaster& raster, const BoundedGrid& grid, const UvtTile& tile,
                 UvtGridTuples& found) {
    const UvtLanes d;
    const hn::RebindToSigned<UvtLanes> di;
    using V = hn::Vec<UvtLanes>;
    const size_t lanes = hn::Lanes(d);
    const UvtTuples& tuples = raster.tuples;
    const Camera& camera = raster.camera;
    const GridBound& bound = grid.bounds[grid.index];
    const TileScale to(camera, tile);
    found.clear(tuples.count + 2 * UvtTuples::kPadding);
    const int last_segment = segment_count(grid.grid.key_count) - 1;
    const bool moves = grid.grid.moves();
    const GridBounds::SegmentBox* boxes = &grid.bounds.segment_box(grid.index, 0);
    constexpr auto kBoxFloats = static_cast<int>(sizeof(GridBounds::SegmentBox) / sizeof(float));

    const V safe = hn::Set(d, safe_depth(bound)), one = hn::Set(d, 1.0f), zero = hn::Zero(d);
    const V near_clip = hn::Set(d, camera.near_clip), far_clip = hn::Set(d, camera.far_clip);
    const V z_rounding = hn::Set(d, bound.z_rounding);
    const V width = hn::Set(d, static_cast<float>(tile.width())),
            height = hn::Set(d, static_cast<float>(tile.height()));
    for (size_t t = 0; t < tuples.count; t += lanes) {
        const auto at = segments_at(d, hn::LoadU(d, &tuples.time[t]), grid.grid.key_count);
        // Tuples of other times lie in other segments: their boxes are gathered.
        const auto box_at = [&](int end, int axis, bool max) HWY_ATTR {
            const float* value = max ? &boxes->max[end][axis] : &boxes->min[end][axis];
            if (last_segment == 0) return hn::Set(d, *value);
            return hn::GatherIndex(d, value, hn::Mul(at.index, hn::Set(di, kBoxFloats)));
        };
        const auto placed = [&](int axis, bool max) HWY_ATTR {
            const V start = box_at(0, axis, max);
            return moves ? hn::Add(start, hn::Mul(at.local, hn::Sub(box_at(1, axis, max), start))) : start;
        };
        const V z0 = hn::Sub(placed(2, false), z_rounding), z1 = hn::Add(placed(2, true), z_rounding);
        const auto unsafe = hn::Not(hn::Gt(z0, safe));
        V near_w = one, far_w = one, slack = hn::Set(d, bound.slack.far);
        if constexpr (kPerspective) {
            near_w = hn::Div(one, hn::Max(z0, safe)), far_w = hn::Div(one, hn::Max(z1, safe));
            slack = hn::Add(slack, hn::Mul(hn::Set(d, bound.slack.near), near_w));
        }
        const auto on_raster = [&](int axis, const V lens, const V slope, float scale, float offset, V* min,
                                   V* max) HWY_ATTR {
            V low = zero, high = zero, low_slope = slope, high_slope = slope;
            image_range<kPerspective>(placed(axis, false), placed(axis, true), lens, near_w, far_w, &low,
                                      &high);
            if constexpr (!kPerspective) {
                low_slope = hn::Min(hn::Mul(slope, z0), hn::Mul(slope, z1));
                high_slope = hn::Max(hn::Mul(slope, z0), hn::Mul(slope, z1));
            }
            low = hn::Sub(hn::Add(low, low_slope), slack), high = hn::Add(hn::Add(high, high_slope), slack);
            const V a = hn::Add(hn::Mul(low, hn::Set(d, scale)), hn::Set(d, offset));
            const V b = hn::Add(hn::Mul(high, hn::Set(d, scale)), hn::Set(d, offset));
            *min = hn::Min(a, b), *max = hn::Max(a, b);
        };
        V x0 = zero, x1 = zero, y0 = zero, y1 = zero;
        on_raster(0, hn::LoadU(d, &tuples.lens_x[t]), hn::LoadU(d, &tuples.slope_x[t]), to.scale_x,
                  to.offset_x, &x0, &x1);
        on_raster(1, hn::LoadU(d, &tuples.lens_y[t]), hn::LoadU(d, &tuples.slope_y[t]), to.scale_y,
                  to.offset_y, &y0, &y1);
        const auto within = hn::And(hn::And(hn::Ge(x1, zero), hn::Le(x0, width)),
                                    hn::And(hn::Ge(y1, zero), hn::Le(y0, height)));
        const auto in_depth = hn::And(hn::Ge(z1, near_clip), hn::Le(z0, far_clip));
        const auto seen = hn::And(hn::And(in_depth, hn::Or(within, unsafe)), hn::FirstN(d, tuples.count - t));
        if (hn::AllFalse(d, seen)) continue;
        const auto careful = hn::Or(unsafe, hn::Or(hn::Lt(z0, near_clip), hn::Gt(z1, far_clip)));
        keep_tuples(raster, tile, t, {slack, z0, x0, x1, y0, y1, seen, unsafe, careful}, found);
    }
}

}  // namespace HWY_NAMESPACE
}  // namespace trapeze
HWY_AFTER_NAMESPACE();

#endif  // per-target include guard
