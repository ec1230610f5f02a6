/// Boxes on the raster of a grid's micropolygons during a slot. Lanes are vertices, then micropolygons.
/// Compiled once a target; see Highway's foreach_target.h.
///
/// A vertex moves linearly in camera space between the ends of a part of a segment, and perspective takes
/// segments to segments: in front of the eye, the places at both ends bound those between. So do the ends'
/// circles of confusion, which are linear in 1 / z.
#if defined(TRAPEZE_SAMPLE_SLOT_BOXES_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef TRAPEZE_SAMPLE_SLOT_BOXES_INL_H_
#undef TRAPEZE_SAMPLE_SLOT_BOXES_INL_H_
#else
#define TRAPEZE_SAMPLE_SLOT_BOXES_INL_H_
#endif

#include <hwy/highway.h>

#include <cstring>
#include <limits>

#include "core/hit_micropolygon-inl.h"
#include "sample/interval/interval_scratch.h"
#include "sample/interval/slot_raster.h"

HWY_BEFORE_NAMESPACE();
namespace trapeze {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

/// Vertices row by row; row_length apart; plane() readable a block past its end.
struct VertexRows {
    int row_length, count, padded, components;
    const float* first;

    const float* plane(size_t part, int component) const {
        return first + (part * static_cast<size_t>(components) + static_cast<size_t>(component)) *
                           static_cast<size_t>(padded);
    }
};

/// Copies a grid's vertices from tiles of 4x4 to rows. Only the segments that the slot covers, planes of
/// start and of way (three components each) one after another.
HWY_INLINE VertexRows vertex_rows(const GridInSlot& in, SlotGridScratch& scratch) {
    const Grid& grid = in.grid;
    const GridShape& shape = grid.shape;
    VertexRows rows;
    rows.row_length = shape.vertices_u(), rows.count = shape.vertex_count();
    rows.components = grid.moves() ? 6 : 3;
    rows.padded = rows.count + 2 * SampleBlock::kLanes;
    scratch.vertices.resize(in.parts.size() * static_cast<size_t>(rows.components * rows.padded));
    rows.first = scratch.vertices.data();
    for (size_t part = 0; part < in.parts.size(); ++part)
        for (int component = 0; component < rows.components; ++component) {
            const float* from = grid.plane(in.parts[part].segment, component);
            float* to = scratch.vertices.data() + (rows.plane(part, component) - rows.first);
            // Whole quarters of tiles: what runs over a row's end is written over by the next row.
            for (int j = 0; j <= shape.nv; ++j)
                for (int tile = 0; tile < shape.tiles_u(); ++tile)
                    std::memcpy(to + j * rows.row_length + tile * 4, from + shape.tiled_index(tile * 4, j),
                                4 * sizeof(float));
            for (int i = rows.count; i < rows.padded; ++i) to[i] = to[rows.count - 1];
        }
    return rows;
}

/// What does not depend on the vertex.
struct BoxConstants {
    bool perspective;
    float in_focus, min_u, max_u, min_v, max_v;  ///< lens in camera space
    RoundingSlack slack;
    float z_safe;
};

/// Where nothing of the grid can be bounded the safe depth is infinite, so that each of its vertices counts
/// as unsafe and its box is everything.
HWY_INLINE BoxConstants box_constants(const Camera& camera, const GridInSlot& in) {
    const float radius = camera.lens_radius;
    return {camera.perspective,
            1 / camera.focal_distance,
            in.lens.min_u * radius,
            in.lens.max_u * radius,
            in.lens.min_v * radius,
            in.lens.max_v * radius,
            in.bound.slack,
            in.bound.boundable ? in.bound.z_safe : std::numeric_limits<float>::infinity()};
}

/// Boxes of vertices in the image plane, in scratch.min_x and so on.
template <bool kLens>
HWY_INLINE void bound_vertices(const BoxConstants& c, const GridInSlot& in, const VertexRows& rows,
                               SlotGridScratch& scratch) {
    const hn::CappedTag<float, SampleBlock::kLanes> d;
    const auto infinite = hn::Set(d, std::numeric_limits<float>::infinity());
    const auto safe = hn::Set(d, c.z_safe), in_focus = hn::Set(d, c.in_focus), one = hn::Set(d, 1.0f);
    const auto min_u = hn::Set(d, c.min_u), max_u = hn::Set(d, c.max_u);
    const auto min_v = hn::Set(d, c.min_v), max_v = hn::Set(d, c.max_v);
    const auto near_slack = hn::Set(d, c.slack.near), far_slack = hn::Set(d, c.slack.far);
    for (auto* plane :
         {&scratch.min_x, &scratch.max_x, &scratch.min_y, &scratch.max_y, &scratch.min_z, &scratch.max_z})
        plane->resize(static_cast<size_t>(rows.padded));
    const int ends = in.grid.moves() ? 2 : 1;
    for (int i = 0; i < rows.count; i += static_cast<int>(hn::Lanes(d))) {
        auto x0 = infinite, y0 = infinite, z0 = infinite;
        auto x1 = hn::Neg(infinite), y1 = x1, z1 = x1;
        for (size_t part = 0; part < in.parts.size(); ++part)
            for (int end = 0; end < ends; ++end) {
                auto x = hn::LoadU(d, rows.plane(part, 0) + i), y = hn::LoadU(d, rows.plane(part, 1) + i),
                     z = hn::LoadU(d, rows.plane(part, 2) + i);
                if (ends == 2) {
                    const auto local = hn::Set(d, end == 0 ? in.parts[part].from : in.parts[part].to);
                    x = position_at(x, hn::LoadU(d, rows.plane(part, 3) + i), local);
                    y = position_at(y, hn::LoadU(d, rows.plane(part, 4) + i), local);
                    z = position_at(z, hn::LoadU(d, rows.plane(part, 5) + i), local);
                }
                z0 = hn::Min(z0, z), z1 = hn::Max(z1, z);
                auto slack = far_slack, shift = in_focus;
                if (c.perspective) {
                    const auto w = hn::Div(one, hn::Max(z, safe));
                    x = hn::Mul(x, w), y = hn::Mul(y, w);
                    slack = hn::Add(slack, hn::Mul(near_slack, w));
                    shift = hn::Sub(in_focus, w);
                } else {
                    shift = hn::Sub(hn::Mul(z, in_focus), one);
                }
                auto low_x = hn::Sub(x, slack), high_x = hn::Add(x, slack);
                auto low_y = hn::Sub(y, slack), high_y = hn::Add(y, slack);
                if constexpr (kLens) {
                    const auto u0 = hn::Mul(shift, min_u), u1 = hn::Mul(shift, max_u);
                    const auto v0 = hn::Mul(shift, min_v), v1 = hn::Mul(shift, max_v);
                    low_x = hn::Add(low_x, hn::Min(u0, u1)), high_x = hn::Add(high_x, hn::Max(u0, u1));
                    low_y = hn::Add(low_y, hn::Min(v0, v1)), high_y = hn::Add(high_y, hn::Max(v0, v1));
                }
                x0 = hn::Min(x0, low_x), x1 = hn::Max(x1, high_x);
                y0 = hn::Min(y0, low_y), y1 = hn::Max(y1, high_y);
            }
        const auto unsafe = hn::Le(z0, safe);
        hn::StoreU(hn::IfThenElse(unsafe, hn::Neg(infinite), x0), d, &scratch.min_x[i]);
        hn::StoreU(hn::IfThenElse(unsafe, infinite, x1), d, &scratch.max_x[i]);
        hn::StoreU(hn::IfThenElse(unsafe, hn::Neg(infinite), y0), d, &scratch.min_y[i]);
        hn::StoreU(hn::IfThenElse(unsafe, infinite, y1), d, &scratch.max_y[i]);
        hn::StoreU(z0, d, &scratch.min_z[i]);
        hn::StoreU(z1, d, &scratch.max_z[i]);
    }
}

/// Scale from the image plane to pixels of the tile, along one axis.
struct PixelScale {
    float scale, offset;
    int size;
};

/// First and last pixel, within the tile, of ranges of the image plane; false where none.
template <class D, class DI, class V, class VI>
HWY_INLINE hn::Mask<D> pixel_range(D d, DI di, const PixelScale& to, V min, V max, VI* first, VI* last) {
    const V scale = hn::Set(d, to.scale), offset = hn::Set(d, to.offset), zero = hn::Zero(d);
    const V a = hn::Add(hn::Mul(min, scale), offset), b = hn::Add(hn::Mul(max, scale), offset);
    const V low = hn::Min(a, b), high = hn::Max(a, b), size = hn::Set(d, static_cast<float>(to.size));
    *first = hn::ConvertTo(di, hn::Min(hn::Max(low, zero), size));
    *last = hn::ConvertTo(di, hn::Min(hn::Max(high, zero), hn::Set(d, static_cast<float>(to.size - 1))));
    return hn::And(hn::Ge(high, zero), hn::Lt(low, size));
}

/// Boxes of micropolygons: pixels and least depths in scratch.x0 and so on, by their vertex 00. Returns
/// whether there is any.
HWY_INLINE bool bound_micropolygons(const SlotRaster& raster, const GridInSlot& in, const VertexRows& rows,
                                    SlotGridScratch& scratch) {
    const hn::CappedTag<float, SampleBlock::kLanes> d;
    const hn::RebindToSigned<decltype(d)> di;
    const Camera& camera = raster.camera;
    const auto scale_of = [](float scale, float offset, int corner, int size) {
        return PixelScale{1 / scale, -offset / scale - static_cast<float>(corner), size};
    };
    const PixelScale to_x =
        scale_of(camera.plane_scale_x, camera.plane_offset_x, raster.tile_x, raster.slots.width());
    const PixelScale to_y =
        scale_of(camera.plane_scale_y, camera.plane_offset_y, raster.tile_y, raster.slots.height());
    const auto near = hn::Set(d, camera.near_clip), far = hn::Set(d, camera.far_clip);
    for (auto* plane : {&scratch.x0, &scratch.x1, &scratch.y0, &scratch.y1})
        plane->resize(static_cast<size_t>(rows.padded));
    scratch.depth.resize(static_cast<size_t>(rows.padded));
    const int last = in.grid.shape.nv * rows.row_length - 1;  // vertices that are a 00, and ends of rows
    const auto corners = [&](const std::vector<float>& plane, int i, auto combine) HWY_ATTR {
        const float* at = plane.data() + i;
        return combine(combine(hn::LoadU(d, at), hn::LoadU(d, at + 1)),
                       combine(hn::LoadU(d, at + rows.row_length), hn::LoadU(d, at + rows.row_length + 1)));
    };
    const auto min = [](auto a, auto b) HWY_ATTR { return hn::Min(a, b); };
    const auto max = [](auto a, auto b) HWY_ATTR { return hn::Max(a, b); };
    bool any = false;
    for (int i = 0; i < last; i += static_cast<int>(hn::Lanes(d))) {
        auto x0 = hn::Zero(di), x1 = x0, y0 = x0, y1 = x0;
        const auto z0 = corners(scratch.min_z, i, min), z1 = corners(scratch.max_z, i, max);
        const auto depths = hn::And(hn::Ge(z1, near), hn::Le(z0, far));
        const auto across = pixel_range(d, di, to_x, corners(scratch.min_x, i, min),
                                        corners(scratch.max_x, i, max), &x0, &x1);
        const auto down = pixel_range(d, di, to_y, corners(scratch.min_y, i, min),
                                      corners(scratch.max_y, i, max), &y0, &y1);
        const auto seen = hn::And(depths, hn::And(across, down));
        any = any || !hn::AllFalse(d, seen);
        x1 = hn::IfThenElse(hn::RebindMask(di, seen), x1, hn::Set(di, -1));
        hn::StoreU(x0, di, &scratch.x0[i]), hn::StoreU(x1, di, &scratch.x1[i]);
        hn::StoreU(y0, di, &scratch.y0[i]), hn::StoreU(y1, di, &scratch.y1[i]);
        hn::StoreU(z0, d, &scratch.depth[i]);
    }
    return any;
}

}  // namespace HWY_NAMESPACE
}  // namespace trapeze
HWY_AFTER_NAMESPACE();

#endif  // per-target include guard
