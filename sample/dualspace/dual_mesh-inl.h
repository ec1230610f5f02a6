/// A grid during a part of a motion segment: its vertices at both ends, and the pixels of a tile where each
/// micropolygon may be seen meanwhile. Lanes are vertices, then micropolygons. Compiled once a target; see
/// Highway's foreach_target.h.
#if defined(TRAPEZE_SAMPLE_DUAL_MESH_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef TRAPEZE_SAMPLE_DUAL_MESH_INL_H_
#undef TRAPEZE_SAMPLE_DUAL_MESH_INL_H_
#else
#define TRAPEZE_SAMPLE_DUAL_MESH_INL_H_
#endif

#include <hwy/highway.h>

#include <limits>

#include "core/hit_micropolygon-inl.h"
#include "sample/dualspace/dual_raster.h"

HWY_BEFORE_NAMESPACE();
namespace trapeze {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

/// Both are template arguments because they decide what is computed for each vertex: without motion one end,
/// without a lens no circle of confusion.
template <bool kMotion, bool kLens>
class DualMesh {
  public:
    static constexpr int kEnds = kMotion ? 2 : 1;

    DualMesh(const DualRaster& raster, const GridBound& bound)
        : camera_(raster.camera),
          pixels_(raster.samples.pixels),
          bound_(bound),
          safe_(bound.boundable ? bound.z_safe : std::numeric_limits<float>::infinity()),
          vertices_(raster.own.vertices),
          mesh_(raster.own.mesh) {}

    /// Sets positions and boxes in the scratch for a part of a motion segment; false where no micropolygon
    /// may be seen in the tile.
    bool place(const SegmentPart& part) {
        mesh_.resize(static_cast<size_t>(vertices_.padded_count()));
        for (int i = 0; i < vertices_.vertex_count(); i += static_cast<int>(hn::Lanes(D())))
            place_vertices(part, i);
        return make_boxes();
    }

  private:
    using D = hn::CappedTag<float, DualIntervals::kPadding>;
    using DI = hn::RebindToSigned<D>;
    using V = hn::Vec<D>;
    using VI = hn::Vec<DI>;

    /// Positions at both ends of the part, and each vertex's box in the image plane over both and over the
    /// whole lens. A vertex nearer than the grid's safe depth has no such box: it may be seen anywhere.
    HWY_INLINE void place_vertices(const SegmentPart& part, int i) {
        const D d;
        const V infinite = hn::Set(d, std::numeric_limits<float>::infinity()), one = hn::Set(d, 1.0f);
        const V rim = hn::Set(d, camera_.lens_radius * DualIntervals::kLensRim),
                in_focus = hn::Set(d, 1 / camera_.focal_distance), safe = hn::Set(d, safe_);
        V min[3] = {infinite, infinite, infinite},
          max[3] = {hn::Neg(infinite), hn::Neg(infinite), hn::Neg(infinite)};
        for (int end = 0; end < kEnds; ++end) {
            V p[3];
            for (int axis = 0; axis < 3; ++axis) {
                p[axis] = hn::LoadU(d, vertices_.plane(part.segment, axis) + i);
                if constexpr (kMotion)
                    p[axis] = position_at(p[axis], hn::LoadU(d, vertices_.plane(part.segment, 3 + axis) + i),
                                          hn::Set(d, end == 0 ? part.from : part.to));
                hn::StoreU(p[axis], d, &mesh_.at[end][axis][i]);
            }
            min[2] = hn::Min(min[2], p[2]), max[2] = hn::Max(max[2], p[2]);
            const V lens = hn::Mul(rim, hn::Sub(one, hn::Mul(p[2], in_focus)));
            hn::StoreU(lens, d, &mesh_.lens[end][i]);
            V w = one, grow = hn::Set(d, bound_.slack.far);
            if (camera_.perspective) {
                w = hn::Div(one, hn::Max(p[2], safe));
                grow = hn::Add(grow, hn::Mul(hn::Set(d, bound_.slack.near), w));
            }
            if constexpr (kLens) grow = hn::Add(grow, hn::Mul(hn::Abs(lens), w));
            for (int axis = 0; axis < 2; ++axis) {
                const V seen = hn::Mul(p[axis], w);
                min[axis] = hn::Min(min[axis], hn::Sub(seen, grow)),
                max[axis] = hn::Max(max[axis], hn::Add(seen, grow));
            }
        }
        const auto unsafe = hn::Le(min[2], safe);
        for (int axis = 0; axis < 3; ++axis) {
            const bool depth = axis == 2;
            hn::StoreU(depth ? min[axis] : hn::IfThenElse(unsafe, hn::Neg(infinite), min[axis]), d,
                       &mesh_.min[axis][i]);
            hn::StoreU(depth ? max[axis] : hn::IfThenElse(unsafe, infinite, max[axis]), d,
                       &mesh_.max[axis][i]);
        }
    }

    /// A micropolygon's vertices follow from its vertex 00 in row order, so that lanes of micropolygons are
    /// plain loads of shifted rows.
    template <class Combine>
    V of_corners(const std::vector<float>& plane, int i, const Combine& combine) const {
        const D d;
        const float *bottom = plane.data() + i, *top = bottom + vertices_.row_length();
        return combine(combine(hn::LoadU(d, bottom), hn::LoadU(d, bottom + 1)),
                       combine(hn::LoadU(d, top), hn::LoadU(d, top + 1)));
    }
    V least(int axis, int i) const {
        return of_corners(mesh_.min[axis], i, [](V a, V b) HWY_ATTR { return hn::Min(a, b); });
    }
    V greatest(int axis, int i) const {
        return of_corners(mesh_.max[axis], i, [](V a, V b) HWY_ATTR { return hn::Max(a, b); });
    }

    /// Boxes of micropolygons in pixels of the tile, from those of their vertices. Lanes that are ends of
    /// rows, out of depth or beside the tile get x1 = -1, by which raster_part() skips them.
    bool make_boxes() {
        const D d;
        const DI di;
        bool any = false;
        const V near = hn::Set(d, camera_.near_clip), far = hn::Set(d, camera_.far_clip);
        for (int i = 0; i < vertices_.quad_end(); i += static_cast<int>(hn::Lanes(d))) {
            auto seen = hn::And(hn::Ge(greatest(2, i), near), hn::Le(least(2, i), far));
            seen = hn::And(
                seen, hn::RebindMask(d, hn::Gt(hn::LoadU(di, vertices_.quad_ids() + i), hn::Set(di, -1))));
            seen = hn::And(seen, store_pixels(i, 0, camera_.plane_scale_x, camera_.plane_offset_x, pixels_.x0,
                                              pixels_.width(), mesh_.x0, mesh_.x1));
            seen = hn::And(seen, store_pixels(i, 1, camera_.plane_scale_y, camera_.plane_offset_y, pixels_.y0,
                                              pixels_.height(), mesh_.y0, mesh_.y1));
            const auto none = hn::RebindMask(di, hn::Not(seen));
            hn::StoreU(hn::IfThenElse(none, hn::Set(di, -1), hn::LoadU(di, &mesh_.x1[i])), di, &mesh_.x1[i]);
            any = any || !hn::AllFalse(d, seen);
        }
        return any;
    }

    /// First and last pixel of the tile along an axis; false where none.
    HWY_INLINE hn::Mask<D> store_pixels(int i, int axis, float plane_scale, float plane_offset, int corner,
                                        int size, std::vector<int32_t>& first, std::vector<int32_t>& last) {
        const D d;
        const DI di;
        const V scale = hn::Set(d, 1 / plane_scale), zero = hn::Zero(d),
                offset = hn::Set(d, -plane_offset / plane_scale - static_cast<float>(corner)),
                last_pixel = hn::Set(d, static_cast<float>(size - 1)),
                end = hn::Set(d, static_cast<float>(size));
        const V a = hn::Add(hn::Mul(least(axis, i), scale), offset),
                b = hn::Add(hn::Mul(greatest(axis, i), scale), offset);
        const V low = hn::Min(a, b), high = hn::Max(a, b);
        const auto pixel = [&](V at)
                               HWY_ATTR { return hn::ConvertTo(di, hn::Min(hn::Max(at, zero), last_pixel)); };
        hn::StoreU(pixel(low), di, &first[i]);
        hn::StoreU(pixel(high), di, &last[i]);
        return hn::And(hn::Ge(high, zero), hn::Le(low, end));
    }

    const Camera& camera_;
    const PixelRect& pixels_;
    const GridBound& bound_;
    const float safe_;
    const VertexRows& vertices_;
    DualMeshScratch& mesh_;
};

}  // namespace HWY_NAMESPACE
}  // namespace trapeze
HWY_AFTER_NAMESPACE();

#endif  // per-target include guard
