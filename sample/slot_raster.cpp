#include "sample/slot_raster.h"

#include "sample/visibility_method.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "sample/slot_raster.cpp"
#include <hwy/foreach_target.h>  // compiles this file once a target

#include "core/hit_micropolygon-inl.h"
#include "sample/slot_boxes-inl.h"

HWY_BEFORE_NAMESPACE();
namespace trapeze {
namespace HWY_NAMESPACE {

/// Where the corners of a micropolygon are at the samples' times.
enum class Motion { None, OneSegment, Segments };

/// Tests micropolygons of a grid against blocks of samples.
template <Motion kMotion, bool kLens>
class BlockTester {
  public:
    BlockTester(SlotRaster& raster, const GridInSlot& in, const VertexRows& rows, SampleStats& stats)
        : raster_(raster), in_(in), rows_(rows), stats_(stats) {}

    /// `at` is the index of vertex 00; `wanted` are lanes worth testing.
    template <class D, class M>
    HWY_INLINE void test(D d, SampleBlock& block, size_t index, size_t lane, int at, M wanted) {
        using V = hn::Vec<D>;
        const V zero = hn::Zero(d);
        V local = zero;
        auto segment = hn::Zero(hn::RebindToSigned<D>());
        if constexpr (kMotion != Motion::None)
            place_in_time(d, hn::Load(d, block.time + lane), &local, &segment);
        const auto vertex = [&](int component, int corner) HWY_ATTR {
            const int v = at + (corner & 1) + (corner >> 1) * rows_.row_length;
            const float* start = rows_.plane(0, component) + v;
            if constexpr (kMotion == Motion::None) return hn::Set(d, *start);
            if constexpr (kMotion == Motion::OneSegment)
                return position_at(hn::Set(d, *start), hn::Set(d, rows_.plane(0, 3 + component)[v]), local);
            return position_at(hn::GatherIndex(d, start, segment),
                               hn::GatherIndex(d, rows_.plane(0, 3 + component) + v, segment), local);
        };
        const V ox = kLens ? hn::Load(d, block.ox + lane) : zero;
        const V oy = kLens ? hn::Load(d, block.oy + lane) : zero;
        V depth = zero;
        const auto passed = hit_micropolygon(d, ox, oy, zero, hn::Load(d, block.ux + lane),
                                             hn::Load(d, block.uy + lane), vertex, in_.grid.facing, depth);
        const auto hit = hn::And(passed, wanted);
        stats_.predicate_tests += hn::CountTrue(d, wanted);
        if (raster_.scratch.heat) count_heat(d, index, lane, wanted);
        if (hn::AllFalse(d, hit)) return;
        stats_.predicate_hits += hn::CountTrue(d, hit);
        keep(d, block, index, lane, at, hit, depth);
    }

  private:
    /// segment_at(), of the grid's segments that the slot covers.
    template <class D, class V, class VI>
    HWY_INLINE void place_in_time(D d, V time, V* local, VI* segment) const {
        const hn::RebindToSigned<D> di;
        const V scaled = hn::Mul(time, hn::Set(d, static_cast<float>(in_.grid.key_count - 1)));
        const int first = in_.parts.front().segment;
        if constexpr (kMotion == Motion::OneSegment) {
            *local = hn::Sub(scaled, hn::Set(d, static_cast<float>(first)));
            return;
        }
        const auto at = hn::Min(hn::Max(hn::ConvertTo(di, scaled), hn::Set(di, first)),
                                hn::Set(di, in_.parts.back().segment));
        *local = hn::Sub(scaled, hn::ConvertTo(d, at));
        *segment = hn::Mul(hn::Sub(at, hn::Set(di, first)), hn::Set(di, rows_.components * rows_.padded));
    }

    template <class D, class M, class V>
    HWY_NOINLINE void keep(D d, SampleBlock& block, size_t index, size_t lane, int at, M hit, V depth) {
        const hn::RebindToUnsigned<D> du;
        const auto v = static_cast<uint32_t>(at / rows_.row_length),
                   u = static_cast<uint32_t>(at % rows_.row_length);
        const auto grid = hn::Set(du, in_.index), micropolygon = hn::Set(du, v << 4 | u);
        const V nearest = hn::Load(d, block.depth + lane);
        const auto old_grid = hn::Load(du, block.grid + lane),
                   old_micropolygon = hn::Load(du, block.micropolygon + lane);
        const auto smaller_id = hn::Or(
            hn::Lt(grid, old_grid), hn::And(hn::Eq(grid, old_grid), hn::Lt(micropolygon, old_micropolygon)));
        const auto in_range = hn::And(hn::Ge(depth, hn::Set(d, raster_.camera.near_clip)),
                                      hn::Le(depth, hn::Set(d, raster_.camera.far_clip)));
        const auto in_front =
            hn::Or(hn::Lt(depth, nearest), hn::And(hn::Eq(depth, nearest), hn::RebindMask(d, smaller_id)));
        const auto kept = hn::And(hit, hn::And(in_range, in_front));
        if (hn::AllFalse(d, kept)) return;
        if (in_.grid.opaque) {
            const auto kept_id = hn::RebindMask(du, kept);
            hn::Store(hn::IfThenElse(kept, depth, nearest), d, block.depth + lane);
            hn::Store(hn::IfThenElse(kept_id, grid, old_grid), du, block.grid + lane);
            hn::Store(hn::IfThenElse(kept_id, micropolygon, old_micropolygon), du, block.micropolygon + lane);
        }
        if (!raster_.all_opaque) list(d, index, lane, kept, depth, uint64_t{in_.index} << 8 | v << 4 | u);
    }

    template <class D, class M, class V>
    void list(D d, size_t index, size_t lane, M kept, V depth, uint64_t id) {
        HWY_ALIGN float depths[SampleBlock::kLanes], is_kept[SampleBlock::kLanes];
        hn::Store(depth, d, depths);
        hn::Store(hn::IfThenElseZero(kept, hn::Set(d, 1.0f)), d, is_kept);
        for (size_t i = 0; i < hn::Lanes(d); ++i) {
            if (is_kept[i] == 0) continue;
            raster_.scratch.hits.push_back({depths[i], id});
            raster_.scratch.hit_sample.push_back(raster_.slots.lanes(index).sample[lane + i]);
        }
    }

    template <class D, class M>
    void count_heat(D d, size_t index, size_t lane, M wanted) {
        HWY_ALIGN float is_wanted[SampleBlock::kLanes];
        hn::Store(hn::IfThenElseZero(wanted, hn::Set(d, 1.0f)), d, is_wanted);
        for (size_t i = 0; i < hn::Lanes(d); ++i) {
            if (is_wanted[i] == 0) continue;
            const uint32_t sample = raster_.slots.lanes(index).sample[lane + i];
            ++raster_.scratch.heat->tests[sample], ++raster_.scratch.heat->nodes[sample];
        }
    }

    SlotRaster& raster_;
    const GridInSlot& in_;
    const VertexRows& rows_;
    SampleStats& stats_;
};

/// The pixels of a micropolygon's box.
struct PixelBox {
    int x0, y0, x1, y1;  ///< inclusive
};

/// Lanes of a block whose pixel lies in a box.
template <class D>
HWY_INLINE hn::Mask<D> lanes_within(D d, const BlockSamples& lanes, size_t lane, const PixelBox& box) {
    const hn::RebindToSigned<D> di;
    const auto x = hn::Load(di, lanes.x + lane), y = hn::Load(di, lanes.y + lane);
    const auto outside = hn::Or(hn::Or(hn::Lt(x, hn::Set(di, box.x0)), hn::Gt(x, hn::Set(di, box.x1))),
                                hn::Or(hn::Lt(y, hn::Set(di, box.y0)), hn::Gt(y, hn::Set(di, box.y1))));
    return hn::RebindMask(d, hn::Not(outside));
}

/// Nothing at least this deep can be in front of any of a block's samples.
HWY_INLINE bool is_hidden(const SampleBlock& block, float depth) {
    const hn::CappedTag<float, SampleBlock::kLanes> d;
    auto farthest = hn::Load(d, block.depth);
    for (size_t lane = hn::Lanes(d); lane < SampleBlock::kLanes; lane += hn::Lanes(d))
        farthest = hn::Max(farthest, hn::Load(d, block.depth + lane));
    return hn::AllTrue(d, hn::Lt(farthest, hn::Set(d, depth)));
}

template <Motion kMotion, bool kLens>
void raster_micropolygons(SlotRaster& raster, const GridInSlot& in, const VertexRows& rows,
                          const SlotGridScratch& boxes, SampleStats& stats) {
    const hn::CappedTag<float, SampleBlock::kLanes> d;
    SampleSlots& slots = raster.slots;
    BlockTester<kMotion, kLens> tester(raster, in, rows, stats);
    const uint32_t* cells = slots.cells(in.slot);
    const int shift = slots.cell_shift(), cells_x = slots.cells_x();
    for (int v = 0; v < in.grid.shape.nv; ++v)
        for (int u = 0; u < in.grid.shape.nu; ++u) {
            const int at = v * rows.row_length + u;
            const PixelBox box{boxes.x0[at], boxes.y0[at], boxes.x1[at], boxes.y1[at]};
            if (box.x0 > box.x1) continue;
            ++stats.nodes_visited;
            for (int y = box.y0 >> shift; y <= box.y1 >> shift; ++y) {
                // The cells of a row follow each other, and so do their blocks.
                const size_t last = cells[y * cells_x + (box.x1 >> shift) + 1];
                for (size_t i = cells[y * cells_x + (box.x0 >> shift)]; i < last; ++i) {
                    SampleBlock& block = slots.block(i);
                    if (raster.cull && is_hidden(block, boxes.depth[at])) continue;
                    const auto count = static_cast<size_t>(slots.lane_count(i));
                    for (size_t lane = 0; lane < count; lane += hn::Lanes(d)) {
                        auto wanted = hn::FirstN(d, count - lane);
                        if (raster.sparse) {
                            wanted = lanes_within(d, slots.lanes(i), lane, box);
                            if (hn::AllFalse(d, wanted)) continue;
                        }
                        tester.test(d, block, i, lane, at, wanted);
                    }
                }
            }
        }
}

/// Whether nothing of a grid can be in front of the samples of the pixels that it may cover.
HWY_INLINE bool is_hidden(SlotRaster& raster, const GridInSlot& in) {
    SampleSlots& slots = raster.slots;
    const uint32_t* cells = slots.cells(in.slot);
    const int shift = slots.cell_shift();
    for (int y = in.pixels.y0 >> shift; y <= (in.pixels.y1 - 1) >> shift; ++y) {
        const uint32_t* row = cells + y * slots.cells_x();
        const size_t last = row[((in.pixels.x1 - 1) >> shift) + 1];
        for (size_t i = row[in.pixels.x0 >> shift]; i < last; ++i)
            if (!is_hidden(slots.block(i), in.z_min)) return false;
    }
    return true;
}

void raster_grid(SlotRaster& raster, const GridInSlot& in, SlotGridScratch& scratch, SampleStats& stats) {
    if (raster.cull && is_hidden(raster, in)) return;
    const VertexRows rows = vertex_rows(in, scratch);
    const BoxConstants constants = box_constants(raster.camera, in);
    const bool lens = raster.camera.has_lens();
    if (lens)
        bound_vertices<true>(constants, in, rows, scratch);
    else
        bound_vertices<false>(constants, in, rows, scratch);
    if (!bound_micropolygons(raster, in, rows, scratch)) return;
    SampleStats counted;
    const auto run = [&](auto motion) HWY_ATTR {
        if (lens)
            raster_micropolygons<motion(), true>(raster, in, rows, scratch, counted);
        else
            raster_micropolygons<motion(), false>(raster, in, rows, scratch, counted);
    };
    if (!in.grid.moves())
        run(std::integral_constant<Motion, Motion::None>());
    else if (in.parts.size() == 1)
        run(std::integral_constant<Motion, Motion::OneSegment>());
    else
        run(std::integral_constant<Motion, Motion::Segments>());
    stats += counted;
}

}  // namespace HWY_NAMESPACE
}  // namespace trapeze
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace trapeze {

HWY_EXPORT(raster_grid);

void raster_grid(SlotRaster& raster, const GridInSlot& grid, SlotGridScratch& scratch, SampleStats& stats) {
    HWY_DYNAMIC_DISPATCH(raster_grid)(raster, grid, scratch, stats);
}

}  // namespace trapeze
#endif  // HWY_ONCE
