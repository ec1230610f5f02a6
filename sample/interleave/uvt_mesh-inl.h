/// A grid as a tuple sees it: where its vertices are at the tuple's time, and boxes of its micropolygons on
/// the raster. Lanes are vertices, then micropolygons. Compiled once a target; see Highway's
/// foreach_target.h.
#if defined(TRAPEZE_SAMPLE_UVT_MESH_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef TRAPEZE_SAMPLE_UVT_MESH_INL_H_
#undef TRAPEZE_SAMPLE_UVT_MESH_INL_H_
#else
#define TRAPEZE_SAMPLE_UVT_MESH_INL_H_
#endif

#include <hwy/highway.h>

#include <cmath>

#include "core/hit_micropolygon-inl.h"
#include "sample/interleave/uvt_raster.h"
#include "sample/interleave/uvt_tuples-inl.h"

HWY_BEFORE_NAMESPACE();
namespace trapeze {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

/// What a tuple's samples share: place in the pixel, lens point (camera space) and its part of slopes, time
/// in the grid's segments, and how far vertices may be off on the raster. The slack is that of the grid at
/// its nearest depth, turned into pixels; boxes of micropolygons that may be nearer take their own
/// (make_boxes<true>).
struct PlacedTuple {
    size_t index;
    float x, y;  ///< from a pixel's corner
    float lens_x, lens_y, slope_x, slope_y;
    MotionSegment at;
    float slack_x, slack_y;  ///< pixels
};

/// One grid, loaded once and then placed for each tuple that may see it.
template <bool kPerspective>
class UvtMesh {
  public:
    using D = UvtLanes;
    using DI = hn::RebindToSigned<D>;
    using V = hn::Vec<D>;

    UvtMesh(const Camera& camera, const GridBound& bound, UvtScratch& scratch)
        : camera_(camera),
          bound_(bound),
          safe_(safe_depth(bound)),
          scale_(camera, scratch.tile),
          scratch_(scratch),
          tile_(scratch.tile),
          rows_(scratch.rows) {}

    /// Takes the grid's vertices out of tiles, once for a grid. What does not move is divided by its depths
    /// here.
    void load(const Grid& grid, bool moves) {
        scratch_.rows.load(grid);
        for (auto* plane : {&scratch_.inverse_z, &scratch_.x, &scratch_.y, &scratch_.z, &scratch_.raster_x,
                            &scratch_.raster_y})
            plane->resize(static_cast<size_t>(rows_.padded_count()));
        if (moves || !kPerspective) return;
        const D d;
        for (int i = 0; i < rows_.vertex_count(); i += static_cast<int>(hn::Lanes(d)))
            hn::StoreU(inverse_of(hn::LoadU(d, rows_.plane(0, 2) + i)), d, &scratch_.inverse_z[i]);
    }

    /// Makes tuple `index` ready for the grid; `slack` is of the image plane.
    PlacedTuple tuple(const UvtRaster& raster, size_t index, int key_count, float slack) const {
        const SampleTuple& sample = raster.pattern.tuple(static_cast<int>(index));
        const UvtTuples& all = raster.tuples;
        return {index,
                sample.x,
                sample.y,
                all.lens_x[index],
                all.lens_y[index],
                all.slope_x[index],
                all.slope_y[index],
                segment_at(sample.time, key_count),
                slack * std::abs(scale_.scale_x),
                slack * std::abs(scale_.scale_y)};
    }

    /// Vertices at a tuple's time, bit for bit as all methods have them, and about where they are seen. At
    /// one time and through one point of the lens a micropolygon is a still quad under a pinhole camera: its
    /// box on the raster follows from its four corners alone, without bounds on blur. That is what the method
    /// gains.
    template <bool kMotion>
    void place(const PlacedTuple& at) {
        const D d;
        const int segment = kMotion ? at.at.index : 0;
        const V local = hn::Set(d, at.at.local);
        x_ = kMotion ? scratch_.x.data() : rows_.plane(0, 0);
        y_ = kMotion ? scratch_.y.data() : rows_.plane(0, 1);
        z_ = kMotion ? scratch_.z.data() : rows_.plane(0, 2);
        const V lens_x = hn::Set(d, at.lens_x), lens_y = hn::Set(d, at.lens_y);
        const V slope_x = hn::Set(d, at.slope_x), slope_y = hn::Set(d, at.slope_y);
        const V scale_x = hn::Set(d, scale_.scale_x), scale_y = hn::Set(d, scale_.scale_y);
        const V offset_x = hn::Set(d, scale_.offset_x), offset_y = hn::Set(d, scale_.offset_y);
        for (int i = 0; i < rows_.vertex_count(); i += static_cast<int>(hn::Lanes(d))) {
            const auto vertex = [&](int component, std::vector<float>& placed) HWY_ATTR {
                V p = hn::LoadU(d, rows_.plane(segment, component) + i);
                if constexpr (kMotion) {
                    p = position_at(p, hn::LoadU(d, rows_.plane(segment, 3 + component) + i), local);
                    hn::StoreU(p, d, &placed[i]);
                }
                return p;
            };
            V x = hn::Sub(vertex(0, scratch_.x), lens_x), y = hn::Sub(vertex(1, scratch_.y), lens_y);
            const V z = vertex(2, scratch_.z);
            if constexpr (kPerspective) {
                V w = hn::Zero(d);
                if constexpr (kMotion)
                    w = inverse_of(z);
                else
                    w = hn::LoadU(d, &scratch_.inverse_z[i]);
                x = hn::Add(hn::Mul(x, w), slope_x), y = hn::Add(hn::Mul(y, w), slope_y);
            } else {
                x = hn::Add(x, hn::Mul(z, slope_x)), y = hn::Add(y, hn::Mul(z, slope_y));
            }
            hn::StoreU(hn::Add(hn::Mul(x, scale_x), offset_x), d, &scratch_.raster_x[i]);
            hn::StoreU(hn::Add(hn::Mul(y, scale_y), offset_y), d, &scratch_.raster_y[i]);
        }
    }

    /// Coordinates of vertices, as placed.
    const float* plane(int component) const { return component == 0 ? x_ : component == 1 ? y_ : z_; }

    /// Boxes of micropolygons in pixels from the tile's corner, within it; x0 > x1 where there is none. Calls
    /// take(index of the first lane's vertex 00, x0, x1, y0, y1, least depth) for all; least depths only when
    /// asked for. Returns how many there are.
    template <bool kCareful, class Take>
    size_t make_boxes(const PlacedTuple& at, bool depths, const Take& take) const {
        const D d;
        const DI di;
        const V zero = hn::Zero(d), width = hn::Set(d, static_cast<float>(tile_.width())),
                height = hn::Set(d, static_cast<float>(tile_.height()));
        depths = depths || kCareful;
        size_t made = 0;
        for (int i = 0; i < rows_.quad_end(); i += static_cast<int>(hn::Lanes(d))) {
            V x0 = least(scratch_.raster_x.data(), i), x1 = greatest(scratch_.raster_x.data(), i);
            V y0 = least(scratch_.raster_y.data(), i), y1 = greatest(scratch_.raster_y.data(), i);
            const V z0 = depths ? least(z_, i) : zero;
            V slack_x = hn::Set(d, at.slack_x), slack_y = hn::Set(d, at.slack_y);
            if constexpr (kCareful && kPerspective) {
                const V slack = hn::Add(hn::Set(d, bound_.slack.far),
                                        hn::Mul(hn::Set(d, bound_.slack.near), inverse_of(z0)));
                slack_x = hn::Mul(slack, hn::Set(d, std::abs(scale_.scale_x)));
                slack_y = hn::Mul(slack, hn::Set(d, std::abs(scale_.scale_y)));
            }
            x0 = hn::Max(hn::Sub(x0, slack_x), zero), x1 = hn::Min(hn::Add(x1, slack_x), width);
            y0 = hn::Max(hn::Sub(y0, slack_y), zero), y1 = hn::Min(hn::Add(y1, slack_y), height);
            auto wanted = hn::RebindMask(d, hn::Gt(hn::LoadU(di, rows_.quad_ids() + i), hn::Set(di, -1)));
            if constexpr (kCareful) {
                // Too near to be divided: such a micropolygon may be anywhere in the tile.
                const auto unsafe = hn::Le(z0, hn::Set(d, safe_));
                x0 = hn::IfThenElse(unsafe, zero, x0), x1 = hn::IfThenElse(unsafe, width, x1);
                y0 = hn::IfThenElse(unsafe, zero, y0), y1 = hn::IfThenElse(unsafe, height, y1);
                const V z1 = greatest(z_, i);
                wanted = hn::And(wanted, hn::And(hn::Ge(z1, hn::Set(d, camera_.near_clip)),
                                                 hn::Le(z0, hn::Set(d, camera_.far_clip))));
            }
            wanted = hn::And(wanted, hn::And(hn::Le(x0, x1), hn::Le(y0, y1)));
            made += hn::CountTrue(d, wanted);
            take(i, hn::IfThenElse(wanted, x0, width), hn::IfThenElse(wanted, x1, hn::Neg(width)), y0, y1,
                 z0);
        }
        return made;
    }

  private:
    /// One over depths, of which none is taken nearer than the grid's safe one.
    V inverse_of(V z) const {
        const D d;
        return hn::Div(hn::Set(d, 1.0f), hn::Max(z, hn::Set(d, safe_)));
    }

    /// Combines the four corners of micropolygons: lanes are their vertices 00, which follow each other in
    /// rows.
    template <class Combine>
    V of_corners(const float* plane, int i, const Combine& combine) const {
        const D d;
        const float *bottom = plane + i, *top = bottom + rows_.row_length();
        return combine(combine(hn::LoadU(d, bottom), hn::LoadU(d, bottom + 1)),
                       combine(hn::LoadU(d, top), hn::LoadU(d, top + 1)));
    }
    V least(const float* plane, int i) const {
        return of_corners(plane, i, [](V a, V b) HWY_ATTR { return hn::Min(a, b); });
    }
    V greatest(const float* plane, int i) const {
        return of_corners(plane, i, [](V a, V b) HWY_ATTR { return hn::Max(a, b); });
    }

    const Camera& camera_;
    const GridBound& bound_;
    const float safe_;
    const TileScale scale_;
    UvtScratch& scratch_;
    const UvtTile& tile_;
    const VertexRows& rows_;
    const float *x_ = nullptr, *y_ = nullptr, *z_ = nullptr;  ///< vertices as placed
};

}  // namespace HWY_NAMESPACE
}  // namespace trapeze
HWY_AFTER_NAMESPACE();

#endif  // per-target include guard
