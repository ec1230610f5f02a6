/// Rows of a grid's micropolygons against a block of samples; lanes are samples. A vertex and an edge that
/// micropolygons share are looked at once, by the arithmetic of hit_micropolygon(). Compiled once a target.
#if defined(TRAPEZE_SAMPLE_BLOCK_ROWS_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef TRAPEZE_SAMPLE_BLOCK_ROWS_INL_H_
#undef TRAPEZE_SAMPLE_BLOCK_ROWS_INL_H_
#else
#define TRAPEZE_SAMPLE_BLOCK_ROWS_INL_H_
#endif

#include <hwy/highway.h>

#include <bit>
#include <utility>

#include "core/hit_micropolygon-inl.h"
#include "sample/slot_boxes-inl.h"
#include "sample/slot_raster.h"
#include "sample/visibility_method.h"

HWY_BEFORE_NAMESPACE();
namespace trapeze {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

/// Where the corners of a micropolygon are at the samples' times.
enum class Motion { None, OneSegment, Segments };

using BlockTag = hn::CappedTag<float, SampleBlock::kLanes>;
using BlockMask = hn::Mask<BlockTag>;

/// Some lanes of a block: all, or as many as a vector has.
template <Motion kMotion, bool kLens>
class BlockRows {
  public:
    BlockRows(SlotRaster& raster, const GridInSlot& in, const VertexRows& rows, SampleStats& stats)
        : raster_(raster), in_(in), rows_(rows), stats_(stats) {}

    void begin(size_t block, size_t first_lane) {
        index_ = block, lane_ = first_lane;
        block_ = &raster_.slots.block(block);
        row_ = -1, vertices_ = edges_ = 0;
        if constexpr (kMotion != Motion::None) place_in_time();
    }

    /// Tests the micropolygons (u, v) of the bits u of `columns`. wanted(u) gives the lanes worth testing;
    /// `tests` is how many these are together. Rows ascend.
    template <class Wanted>
    void test(int v, uint32_t columns, const Wanted& wanted) {
        if (v != row_) vertices_ = edges_ = 0;
        uint32_t new_vertices = 0, new_edges = 0;
        for (uint32_t left = columns; left != 0;) {
            int u = std::countr_zero(left);
            const int first = u;
            u = test_run(u, v, columns, wanted);
            const uint32_t run = ((uint32_t{2} << (u - first)) - 1) << first;  // vertices of the run
            new_vertices |= run, new_edges |= run & (run >> 1);
            left &= ~run;
        }
        row_ = v + 1, vertices_ = new_vertices, edges_ = new_edges;
        std::swap(lower_, upper_);
    }

  private:
    using D = BlockTag;
    using V = hn::Vec<D>;

    /// Vertices of a row, moved along the rays to their plane, and whether edges between them are crossed.
    struct alignas(64) Row {
        float a[kMaxGridSide + 1][SampleBlock::kLanes], b[kMaxGridSide + 1][SampleBlock::kLanes];
        float crossing[kMaxGridSide][SampleBlock::kLanes];
    };

    /// segment_at(), of the grid's segments that the slot covers.
    HWY_INLINE void place_in_time() {
        const D d;
        const hn::RebindToSigned<D> di;
        const V scaled = hn::Mul(hn::Load(d, block_->time + lane_),
                                 hn::Set(d, static_cast<float>(in_.grid.key_count - 1)));
        const int first = in_.parts.front().segment;
        if constexpr (kMotion == Motion::OneSegment) {
            hn::Store(hn::Sub(scaled, hn::Set(d, static_cast<float>(first))), d, local_);
            return;
        }
        const auto at = hn::Min(hn::Max(hn::ConvertTo(di, scaled), hn::Set(di, first)),
                                hn::Set(di, in_.parts.back().segment));
        hn::Store(hn::Sub(scaled, hn::ConvertTo(d, at)), d, local_);
        hn::Store(hn::Mul(hn::Sub(at, hn::Set(di, first)), hn::Set(di, rows_.components * rows_.padded)), di,
                  segment_);
    }

    /// Two rows of vertices and the rays, in locals: stores of vectors may alias whatever is in memory.
    struct Run {
        const float* lower;  ///< the row below: plane x, segment 0
        size_t row, plane;   ///< floats to the row above, and from plane to plane
        const int32_t* segment;
    };

    static HWY_INLINE V coordinate(const Run& run, size_t at, int component, V local) {
        const D d;
        const float* start = run.lower + static_cast<size_t>(component) * run.plane + at;
        if constexpr (kMotion == Motion::None) return hn::Set(d, *start);
        const float* delta = start + 3 * run.plane;
        if constexpr (kMotion == Motion::OneSegment)
            return position_at(hn::Set(d, *start), hn::Set(d, *delta), local);
        const auto segment = hn::Load(hn::RebindToSigned<D>(), run.segment);
        return position_at(hn::GatherIndex(d, start, segment), hn::GatherIndex(d, delta, segment), local);
    }

    static HWY_INLINE void move_to_plane(const Run& run, size_t at, V ox, V oy, V ux, V uy, V local, V* a,
                                         V* b) {
        const V z = coordinate(run, at, 2, local);
        V x = coordinate(run, at, 0, local), y = coordinate(run, at, 1, local);
        if constexpr (kLens) x = hn::Sub(x, ox), y = hn::Sub(y, oy);
        *a = hn::Sub(x, hn::Mul(ux, z));
        *b = hn::Sub(y, hn::Mul(uy, z));
    }

    /// Tests micropolygons from u on as far as bits follow each other; returns the first past them.
    template <class Wanted>
    HWY_INLINE int test_run(int u, int v, uint32_t columns, const Wanted& wanted) {
        namespace p = predicate_lanes;
        const D d;
        const Run run{rows_.first + static_cast<size_t>(v) * static_cast<size_t>(rows_.row_length),
                      static_cast<size_t>(rows_.row_length), static_cast<size_t>(rows_.padded), segment_};
        const V zero = hn::Zero(d), ux = hn::Load(d, block_->ux + lane_),
                uy = hn::Load(d, block_->uy + lane_);
        const V ox = kLens ? hn::Load(d, block_->ox + lane_) : zero,
                oy = kLens ? hn::Load(d, block_->oy + lane_) : zero,
                local = kMotion == Motion::None ? zero : hn::Load(d, local_);
        const uint32_t known_vertices = vertices_, known_edges = edges_;
        const Row& below = *lower_;
        Row& above = *upper_;
        const auto lower_vertex = [&](int i, V* a, V* b) HWY_ATTR {
            if (known_vertices >> i & 1) {
                *a = hn::Load(d, below.a[i]), *b = hn::Load(d, below.b[i]);
                return;
            }
            move_to_plane(run, static_cast<size_t>(i), ox, oy, ux, uy, local, a, b);
        };
        const auto upper_vertex = [&](int i, V* a, V* b) HWY_ATTR {
            move_to_plane(run, run.row + static_cast<size_t>(i), ox, oy, ux, uy, local, a, b);
            hn::Store(*a, d, above.a[i]), hn::Store(*b, d, above.b[i]);
        };
        V a00, b00, a01, b01;
        lower_vertex(u, &a00, &b00);
        upper_vertex(u, &a01, &b01);
        V left = p::crossing(a01, b01, a00, b00);
        for (; columns >> u & 1; ++u) {
            V a10, b10, a11, b11;
            lower_vertex(u + 1, &a10, &b10);
            upper_vertex(u + 1, &a11, &b11);
            const V right = p::crossing(a10, b10, a11, b11), top = p::crossing(a11, b11, a01, b01);
            const V bottom =
                known_edges >> u & 1 ? hn::Load(d, below.crossing[u]) : p::crossing(a00, b00, a10, b10);
            hn::Store(top, d, above.crossing[u]);
            const BlockMask passed = p::negative(d, hn::Xor(hn::Xor(bottom, right), hn::Xor(top, left)));
            if (!hn::AllFalse(d, passed)) {
                const BlockMask wanted_passed = hn::And(passed, wanted(u));
                if (!hn::AllFalse(d, wanted_passed)) {
                    const auto at = static_cast<size_t>(u);
                    V depth = zero;
                    const QuadLanes<V> quad{a00,
                                            a10,
                                            a01,
                                            a11,
                                            b00,
                                            b10,
                                            b01,
                                            b11,
                                            coordinate(run, at, 2, local),
                                            coordinate(run, at + 1, 2, local),
                                            coordinate(run, run.row + at, 2, local),
                                            coordinate(run, run.row + at + 1, 2, local)};
                    const BlockMask hit =
                        hn::And(wanted_passed, depth_inside(d, quad, in_.grid.facing, depth));
                    stats_.predicate_hits += hn::CountTrue(d, hit);
                    keep(static_cast<uint32_t>(v << 4 | u), hit, depth);
                }
            }
            a00 = a10, b00 = b10, a01 = a11, b01 = b11, left = right;
        }
        return u;
    }

    HWY_INLINE void keep(uint32_t micropolygon_index, BlockMask hit, V depth) {
        const D d;
        const hn::RebindToUnsigned<D> du;
        const auto grid = hn::Set(du, in_.index), micropolygon = hn::Set(du, micropolygon_index);
        const V nearest = hn::Load(d, block_->depth + lane_);
        const auto old_grid = hn::Load(du, block_->grid + lane_),
                   old_micropolygon = hn::Load(du, block_->micropolygon + lane_);
        const auto smaller_id = hn::Or(
            hn::Lt(grid, old_grid), hn::And(hn::Eq(grid, old_grid), hn::Lt(micropolygon, old_micropolygon)));
        const auto in_range = hn::And(hn::Ge(depth, hn::Set(d, raster_.camera.near_clip)),
                                      hn::Le(depth, hn::Set(d, raster_.camera.far_clip)));
        const auto in_front =
            hn::Or(hn::Lt(depth, nearest), hn::And(hn::Eq(depth, nearest), hn::RebindMask(d, smaller_id)));
        const BlockMask kept = hn::And(hit, hn::And(in_range, in_front));
        if (in_.grid.opaque) {
            const auto kept_id = hn::RebindMask(du, kept);
            hn::Store(hn::IfThenElse(kept, depth, nearest), d, block_->depth + lane_);
            hn::Store(hn::IfThenElse(kept_id, grid, old_grid), du, block_->grid + lane_);
            hn::Store(hn::IfThenElse(kept_id, micropolygon, old_micropolygon), du,
                      block_->micropolygon + lane_);
        }
        if (!raster_.all_opaque) list(kept, depth, uint64_t{in_.index} << 8 | micropolygon_index);
    }

    HWY_NOINLINE void list(BlockMask kept, V depth, uint64_t id) {
        const D d;
        HWY_ALIGN float depths[SampleBlock::kLanes], is_kept[SampleBlock::kLanes];
        hn::Store(depth, d, depths);
        hn::Store(hn::IfThenElseZero(kept, hn::Set(d, 1.0f)), d, is_kept);
        for (size_t i = 0; i < hn::Lanes(d); ++i) {
            if (is_kept[i] == 0) continue;
            raster_.scratch.hits.push_back({depths[i], id});
            raster_.scratch.hit_sample.push_back(raster_.slots.sample(index_, lane_ + i));
        }
    }

    SlotRaster& raster_;
    const GridInSlot& in_;
    const VertexRows& rows_;
    SampleStats& stats_;

    SampleBlock* block_ = nullptr;
    size_t index_ = 0, lane_ = 0;
    int row_ = -1;                                    ///< of vertices, which *lower_ holds
    uint32_t vertices_ = 0, edges_ = 0;               ///< what of it is known
    HWY_ALIGN float local_[SampleBlock::kLanes];      ///< time within the segment
    HWY_ALIGN int32_t segment_[SampleBlock::kLanes];  ///< floats from the first segment's planes
    Row storage_[2];
    Row *lower_ = &storage_[0], *upper_ = &storage_[1];
};

}  // namespace HWY_NAMESPACE
}  // namespace trapeze
HWY_AFTER_NAMESPACE();

#endif  // per-target include guard
