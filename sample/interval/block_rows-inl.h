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
#include "core/simd/simd-inl.h"
#include "sample/interval/slot_boxes-inl.h"
#include "sample/interval/slot_raster.h"
#include "sample/visibility.h"

HWY_BEFORE_NAMESPACE();
namespace trapeze {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

/// In how many segments of a grid's motion a slot's samples have their times. Corners of micropolygons get to
/// where they are then not at all, within one segment, or by looking up each sample's segment.
enum class SlotSegments { None, One, Several };

using BlockTag = hn::CappedTag<float, SampleBlock::kLanes>;
using BlockMask = hn::Mask<BlockTag>;

/// The test of rows of one grid against a vector of samples: all lanes of a block, or as many as a vector
/// has. Neighbouring micropolygons share vertices and edges: a row's upper vertices and edges, already moved
/// along the rays, are kept as the next row's lower ones. Only the arithmetic is shared; each crossing comes
/// out as the predicate has it, bit for bit.
template <SlotSegments kSegments, bool kLens>
class BlockRows {
  public:
    BlockRows(SlotRaster& raster, const GridInSlot& in, const VertexRows& rows, SampleStats& stats)
        : raster_(raster), in_(in), rows_(rows), stats_(stats) {}

    /// Turns to the samples of a block from a lane on.
    void begin(size_t block, size_t first_lane) {
        index_ = block, lane_ = first_lane;
        block_ = &raster_.slots.block(block);
        row_ = -1, vertices_ = edges_ = 0;
        if constexpr (kSegments != SlotSegments::None) place_in_time();
    }

    /// Tests the micropolygons (u, v) of the bits u of `columns`. wanted(u) gives the lanes worth testing.
    /// Rows ascend.
    template <class Wanted>
    void test(int v, uint32_t columns, const Wanted& wanted) {
        if (v != row_) vertices_ = edges_ = 0;
        const RowPair pair = pair_of_rows(v);
        const uint32_t needed = columns | columns << 1;
        complete_lower(pair, needed & ~vertices_, columns & ~edges_);
        for (uint32_t left = columns; left != 0;) {
            const int first = std::countr_zero(left), last = test_columns(pair, first, v, columns, wanted);
            left &= ~((uint32_t{1} << last) - 1);
        }
        row_ = v + 1, vertices_ = needed, edges_ = columns;
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
        const V time = hn::Load(d, block_->time + lane_);
        const int first = in_.parts.front().segment;
        if constexpr (kSegments == SlotSegments::One) {
            const V scaled = hn::Mul(time, hn::Set(d, static_cast<float>(in_.grid.key_count - 1)));
            hn::Store(hn::Sub(scaled, hn::Set(d, static_cast<float>(first))), d, local_);
            return;
        }
        const auto at = segments_at(d, time, in_.grid.key_count, first, in_.parts.back().segment);
        hn::Store(at.local, d, local_);
        hn::Store(
            hn::Mul(hn::Sub(at.index, hn::Set(di, first)), hn::Set(di, rows_.components * rows_.padded)), di,
            segment_);
    }

    /// Two rows of vertices and the rays. Locals: stores of vectors may alias whatever is in memory.
    struct RowPair {
        const float* lower;  ///< the row below: plane x, first segment
        size_t row, plane;   ///< floats to the row above, and from plane to plane
        const int32_t* segment;
        V ox, oy, ux, uy, local;
    };

    HWY_INLINE RowPair pair_of_rows(int v) const {
        const D d;
        const V zero = hn::Zero(d);
        return {rows_.first + static_cast<size_t>(v) * static_cast<size_t>(rows_.row_length),
                static_cast<size_t>(rows_.row_length),
                static_cast<size_t>(rows_.padded),
                segment_,
                kLens ? hn::Load(d, block_->ox + lane_) : zero,
                kLens ? hn::Load(d, block_->oy + lane_) : zero,
                hn::Load(d, block_->ux + lane_),
                hn::Load(d, block_->uy + lane_),
                kSegments == SlotSegments::None ? zero : hn::Load(d, local_)};
    }

    /// A coordinate of vertex `at` of the pair (floats from the row below) at the samples' times.
    static HWY_INLINE V coordinate(const RowPair& pair, size_t at, int component) {
        const D d;
        const float* start = pair.lower + static_cast<size_t>(component) * pair.plane + at;
        if constexpr (kSegments == SlotSegments::None) return hn::Set(d, *start);
        const float* delta = start + 3 * pair.plane;
        if constexpr (kSegments == SlotSegments::One)
            return position_at(hn::Set(d, *start), hn::Set(d, *delta), pair.local);
        const auto segment = hn::Load(hn::RebindToSigned<D>(), pair.segment);
        return position_at(hn::GatherIndex(d, start, segment), hn::GatherIndex(d, delta, segment),
                           pair.local);
    }

    /// A vertex along the rays to their plane: the predicate's a and b.
    static HWY_INLINE void move_to_plane(const RowPair& pair, size_t at, V* a, V* b) {
        const V z = coordinate(pair, at, 2);
        V x = coordinate(pair, at, 0), y = coordinate(pair, at, 1);
        if constexpr (kLens) x = hn::Sub(x, pair.ox), y = hn::Sub(y, pair.oy);
        *a = hn::Sub(x, hn::Mul(pair.ux, z));
        *b = hn::Sub(y, hn::Mul(pair.uy, z));
    }

    /// Computes vertices and edges of the lower row that the row before has not left behind.
    HWY_INLINE void complete_lower(const RowPair& pair, uint32_t vertices, uint32_t edges) {
        const D d;
        Row& below = *lower_;
        for (; vertices != 0; vertices &= vertices - 1) {
            const int i = std::countr_zero(vertices);
            V a, b;
            move_to_plane(pair, static_cast<size_t>(i), &a, &b);
            hn::Store(a, d, below.a[i]), hn::Store(b, d, below.b[i]);
        }
        for (; edges != 0; edges &= edges - 1) {
            const int i = std::countr_zero(edges);
            const V crossed =
                predicate_lanes::crossing(hn::Load(d, below.a[i]), hn::Load(d, below.b[i]),
                                          hn::Load(d, below.a[i + 1]), hn::Load(d, below.b[i + 1]));
            hn::Store(crossed, d, below.crossing[i]);
        }
    }

    /// Tests micropolygons from u on as far as bits follow each other; returns the first past them.
    template <class Wanted>
    HWY_INLINE int test_columns(const RowPair& pair, int u, int v, uint32_t columns, const Wanted& wanted) {
        namespace p = predicate_lanes;
        const D d;
        const Row& below = *lower_;
        Row& above = *upper_;
        V a00 = hn::Load(d, below.a[u]), b00 = hn::Load(d, below.b[u]), a01, b01;
        move_to_plane(pair, pair.row + static_cast<size_t>(u), &a01, &b01);
        hn::Store(a01, d, above.a[u]), hn::Store(b01, d, above.b[u]);
        V abs00 = hn::Abs(b00), abs01 = hn::Abs(b01);
        V left = p::crossing(a01, b01, abs01, a00, b00, abs00);
        for (; columns >> u & 1; ++u) {
            const V a10 = hn::Load(d, below.a[u + 1]), b10 = hn::Load(d, below.b[u + 1]);
            V a11, b11;
            move_to_plane(pair, pair.row + static_cast<size_t>(u) + 1, &a11, &b11);
            hn::Store(a11, d, above.a[u + 1]), hn::Store(b11, d, above.b[u + 1]);
            const V abs10 = hn::Abs(b10), abs11 = hn::Abs(b11);
            const V right = p::crossing(a10, b10, abs10, a11, b11, abs11),
                    top = p::crossing(a11, b11, abs11, a01, b01, abs01);
            hn::Store(top, d, above.crossing[u]);
            const V crossings = hn::Xor(hn::Xor(hn::Load(d, below.crossing[u]), right), hn::Xor(top, left));
            const BlockMask passed = p::negative(d, crossings);
            if (!hn::AllFalse(d, passed)) {
                const QuadLanes<V> quad = with_depths(pair, u, a00, a10, a01, a11, b00, b10, b01, b11);
                find_depths(static_cast<uint32_t>(v << 4 | u), quad, hn::And(passed, wanted(u)));
            }
            a00 = a10, b00 = b10, a01 = a11, b01 = b11, left = right, abs01 = abs11;
        }
        return u;
    }

    /// The quad of micropolygon u with its depths, which only those that are passed need.
    static HWY_INLINE QuadLanes<V> with_depths(const RowPair& pair, int u, V a00, V a10, V a01, V a11, V b00,
                                               V b10, V b01, V b11) {
        const auto at = static_cast<size_t>(u);
        return {a00,
                a10,
                a01,
                a11,
                b00,
                b10,
                b01,
                b11,
                coordinate(pair, at, 2),
                coordinate(pair, at + 1, 2),
                coordinate(pair, pair.row + at, 2),
                coordinate(pair, pair.row + at + 1, 2)};
    }

    /// Finds the depths of rays that pass inside a micropolygon, v << 4 | u, and keeps its hits.
    HWY_INLINE void find_depths(uint32_t micropolygon, const QuadLanes<V>& quad, BlockMask passed) {
        const D d;
        if (hn::AllFalse(d, passed)) return;
        V depth = hn::Zero(d);
        const BlockMask hit = hn::And(passed, depth_inside(d, quad, in_.grid.facing, depth));
        stats_.predicate_hits += hn::CountTrue(d, hit);
        keep(micropolygon, hit, depth);
    }

    /// Keeps hits in front of the nearest opaque ones, equal depths by id: in the block if the grid is
    /// opaque, and in the list of all hits if some grid is not.
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

    /// Adds hits to the scratch's list. Not inlined: only pictures with grids that are not opaque come here.
    HWY_NOINLINE void list(BlockMask kept, V depth, uint64_t id) {
        const D d;
        HWY_ALIGN float depths[SampleBlock::kLanes], is_kept[SampleBlock::kLanes];
        hn::Store(depth, d, depths);
        hn::Store(hn::IfThenElseZero(kept, hn::Set(d, 1.0f)), d, is_kept);
        for (size_t i = 0; i < hn::Lanes(d); ++i) {
            if (is_kept[i] == 0) continue;
            raster_.scratch.found.add(raster_.slots.sample(index_, lane_ + i), {depths[i], id});
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
