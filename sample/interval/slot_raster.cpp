#include "sample/interval/slot_raster.h"

#include <algorithm>

#include "sample/visibility.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "sample/interval/slot_raster.cpp"
#include <hwy/foreach_target.h>  // compiles this file once a target

#include "core/simd/simd-inl.h"
#include "sample/interval/block_rows-inl.h"
#include "sample/interval/slot_boxes-inl.h"

HWY_BEFORE_NAMESPACE();
namespace trapeze {
namespace HWY_NAMESPACE {

/// The deepest of the nearest hits of a block.
HWY_INLINE float farthest_depth(const SampleBlock& block) {
    const BlockTag d;
    auto farthest = hn::Load(d, block.depth);
    for (size_t lane = hn::Lanes(d); lane < SampleBlock::kLanes; lane += hn::Lanes(d))
        farthest = hn::Max(farthest, hn::Load(d, block.depth + lane));
    return hn::GetLane(hn::MaxOfLanes(d, farthest));
}

/// Whether nothing of a grid can be in front of the samples of the pixels that it may cover: by its nearest
/// depth, which is safe and cheap. Blocks of a row of cells stand side by side.
HWY_INLINE bool is_hidden(SlotRaster& raster, const GridInSlot& in) {
    SampleSlots& slots = raster.slots;
    const uint32_t* cells = slots.cells(in.slot);
    const int shift = slots.cell_shift();
    for (int y = in.pixels.y0 >> shift; y <= (in.pixels.y1 - 1) >> shift; ++y) {
        const uint32_t* row = cells + y * slots.cells_x();
        const size_t last = row[((in.pixels.x1 - 1) >> shift) + 1];
        for (size_t i = row[in.pixels.x0 >> shift]; i < last; ++i)
            if (farthest_depth(slots.block(i)) >= in.z_min) return false;
    }
    return true;
}

/// Rasterizes a grid's micropolygons into the samples of a slot, cell by cell. Cells first, rows of
/// micropolygons second: the mask of rows that reach a cell is made once for a grid, and a cell's block of
/// samples is loaded once for all of them.
template <SlotSegments kSegments, bool kLens>
class CellRaster {
  public:
    CellRaster(SlotRaster& raster, const GridInSlot& in, const VertexRows& rows, SlotGridScratch& boxes,
               SampleStats& stats)
        : raster_(raster),
          in_(in),
          boxes_(boxes),
          stats_(stats),
          rows_(raster, in, rows, stats),
          row_length_(rows.row_length),
          shift_(raster.slots.cell_shift()) {}

    /// Goes through the cells that the grid's rows reach, and in each through its blocks of samples.
    void run() {
        const PixelRect cells = mark_rows();
        const uint32_t* first_block = raster_.slots.cells(in_.slot);
        const int width = cells.width();
        for (int y = cells.y0; y < cells.y1; ++y)
            for (int x = cells.x0; x < cells.x1; ++x) {
                const uint32_t rows = boxes_.rows_of_cell[(y - cells.y0) * width + (x - cells.x0)];
                if (rows == 0) continue;
                const int cell = y * raster_.slots.cells_x() + x;
                for (size_t i = first_block[cell]; i < first_block[cell + 1]; ++i) test_block(i, x, y, rows);
            }
    }

  private:
    /// Which rows of micropolygons reach which cells, by the box of the whole row; for the cells returned.
    PixelRect mark_rows() {
        PixelRect of_row[kMaxGridSide], all{1 << 30, 1 << 30, 0, 0};
        for (int v = 0; v < in_.grid.shape.nv; ++v) {
            of_row[v] = cells_of_row(v);
            if (of_row[v].empty()) continue;
            all = {std::min(all.x0, of_row[v].x0), std::min(all.y0, of_row[v].y0),
                   std::max(all.x1, of_row[v].x1), std::max(all.y1, of_row[v].y1)};
        }
        boxes_.rows_of_cell.assign(static_cast<size_t>(all.width()) * all.height(), 0);
        for (int v = 0; v < in_.grid.shape.nv; ++v)
            for (int y = of_row[v].y0; y < of_row[v].y1; ++y)
                for (int x = of_row[v].x0; x < of_row[v].x1; ++x)
                    boxes_.rows_of_cell[(y - all.y0) * all.width() + (x - all.x0)] |= uint32_t{1} << v;
        return all;
    }

    /// The cells that the boxes of a row of micropolygons reach together.
    PixelRect cells_of_row(int v) {
        PixelRect pixels{1 << 30, 1 << 30, -1, -1};  // inclusive
        for (int at = v * row_length_; at < v * row_length_ + in_.grid.shape.nu; ++at) {
            if (boxes_.x0[at] > boxes_.x1[at]) continue;
            ++stats_.nodes_visited;
            pixels = {std::min(pixels.x0, boxes_.x0[at]), std::min(pixels.y0, boxes_.y0[at]),
                      std::max(pixels.x1, boxes_.x1[at]), std::max(pixels.y1, boxes_.y1[at])};
        }
        if (pixels.x1 < 0) return {};
        return {pixels.x0 >> shift_, pixels.y0 >> shift_, (pixels.x1 >> shift_) + 1,
                (pixels.y1 >> shift_) + 1};
    }

    /// Tests a block of a cell against the marked rows, a vector of lanes after the other.
    void test_block(size_t index, int x, int y, uint32_t rows) {
        const BlockTag d;
        const auto count = static_cast<size_t>(raster_.slots.lane_count(index));
        const float farthest = raster_.cull ? farthest_depth(raster_.slots.block(index)) : 0;
        for (size_t lane = 0; lane < count; lane += hn::Lanes(d)) {
            rows_.begin(index, lane);
            const PixelBox pixels = pixels_of_lanes(x, y, lane, count);
            for (uint32_t left = rows; left != 0; left &= left - 1) {
                const int v = std::countr_zero(left);
                uint32_t columns = columns_within(v, pixels);
                if (raster_.cull) columns &= columns_before(v, farthest);
                if (columns != 0) test_row(index, lane, count, v, columns);
            }
        }
    }

    /// Pixels of the tile, both ends included.
    struct PixelBox {
        int x0, y0, x1, y1;
    };

    /// The pixels of a cell, or those rows of them that lanes from `lane` on have: known of full blocks of
    /// 4 x 4 pixels.
    HWY_INLINE PixelBox pixels_of_lanes(int cell_x, int cell_y, size_t lane, size_t count) const {
        const int size = 1 << shift_, x = cell_x << shift_, y = cell_y << shift_;
        if (raster_.sparse || shift_ != 2 || count != SampleBlock::kLanes)
            return {x, y, x + size - 1, y + size - 1};
        const int lanes = static_cast<int>(hn::Lanes(BlockTag())), first = static_cast<int>(lane);
        return {x, y + (first >> 2), x + 3, y + ((first + lanes - 1) >> 2)};
    }

    /// Bits of the micropolygons of a row whose boxes reach some pixels.
    HWY_INLINE uint32_t columns_within(int v, const PixelBox& pixels) const {
        const hn::RebindToSigned<BlockTag> di;
        const auto left = hn::Set(di, pixels.x0), right = hn::Set(di, pixels.x1);
        const auto top = hn::Set(di, pixels.y0), bottom = hn::Set(di, pixels.y1);
        return row_bits(v, [&](int at) HWY_ATTR {
            const auto beside = hn::Or(hn::Gt(hn::LoadU(di, &boxes_.x0[at]), right),
                                       hn::Lt(hn::LoadU(di, &boxes_.x1[at]), left));
            const auto above = hn::Or(hn::Gt(hn::LoadU(di, &boxes_.y0[at]), bottom),
                                      hn::Lt(hn::LoadU(di, &boxes_.y1[at]), top));
            return hn::RebindMask(BlockTag(), hn::Not(hn::Or(beside, above)));
        });
    }

    /// Bits of the micropolygons of a row that may be in front of something at a depth.
    HWY_INLINE uint32_t columns_before(int v, float depth) const {
        const BlockTag d;
        return row_bits(
            v, [&](int at) HWY_ATTR { return hn::Le(hn::LoadU(d, &boxes_.depth[at]), hn::Set(d, depth)); });
    }

    /// Bits of a row's micropolygons for which lanes(index of the first) is true.
    template <class Lanes>
    HWY_INLINE uint32_t row_bits(int v, const Lanes& lanes) const {
        const int step = static_cast<int>(hn::Lanes(BlockTag()));
        uint32_t bits = 0;
        for (int u = 0; u < in_.grid.shape.nu; u += step) {
            bits |= mask_bits(BlockTag(), lanes(v * row_length_ + u)) << u;
        }
        return bits & ((uint32_t{1} << in_.grid.shape.nu) - 1);
    }

    /// Tests micropolygons of a row against lanes. Sparse cells look at pixels first, and leave out
    /// micropolygons whose boxes hold none of the lanes.
    void test_row(size_t index, size_t lane, size_t count, int v, uint32_t columns) {
        const BlockTag d;
        if (raster_.sparse) {
            const BlockPlaces& places = raster_.slots.places(index);
            const auto within = [&](int u)
                                    HWY_ATTR { return lanes_within(places, lane, v * row_length_ + u); };
            for (uint32_t left = columns; left != 0; left &= left - 1) {
                const int u = std::countr_zero(left);
                const size_t tested = hn::CountTrue(d, within(u));
                if (tested == 0) columns &= ~(uint32_t{1} << u);
                stats_.predicate_tests += tested;
            }
            if (columns != 0) finish_row(index, lane, v, columns, within);
            return;
        }
        const auto valid = hn::FirstN(d, count - lane);
        stats_.predicate_tests += std::min(count - lane, hn::Lanes(d)) * std::popcount(columns);
        finish_row(index, lane, v, columns, [&](int) HWY_ATTR { return valid; });
    }

    /// Costs are counted before the test, of the same lanes.
    template <class Wanted>
    HWY_INLINE void finish_row(size_t index, size_t lane, int v, uint32_t columns, const Wanted& wanted) {
        if (raster_.scratch.heat) count_heat(index, lane, columns, wanted);
        rows_.test(v, columns, wanted);
    }

    /// Lanes of a block whose pixel lies in a micropolygon's box.
    HWY_INLINE BlockMask lanes_within(const BlockPlaces& places, size_t lane, int at) const {
        const BlockTag d;
        const hn::RebindToSigned<BlockTag> di;
        const auto x = hn::Load(di, places.x + lane), y = hn::Load(di, places.y + lane);
        const auto beside =
            hn::Or(hn::Lt(x, hn::Set(di, boxes_.x0[at])), hn::Gt(x, hn::Set(di, boxes_.x1[at])));
        const auto above =
            hn::Or(hn::Lt(y, hn::Set(di, boxes_.y0[at])), hn::Gt(y, hn::Set(di, boxes_.y1[at])));
        return hn::RebindMask(d, hn::Not(hn::Or(beside, above)));
    }

    /// Counts a test and a node for every sample that is tested, for pictures of costs.
    template <class Wanted>
    HWY_NOINLINE void count_heat(size_t index, size_t lane, uint32_t columns, const Wanted& wanted) {
        const BlockTag d;
        SampleHeat& heat = *raster_.scratch.heat;
        for (; columns != 0; columns &= columns - 1) {
            HWY_ALIGN float is_wanted[SampleBlock::kLanes];
            hn::Store(hn::IfThenElseZero(wanted(std::countr_zero(columns)), hn::Set(d, 1.0f)), d, is_wanted);
            for (size_t i = 0; i < hn::Lanes(d); ++i) {
                if (is_wanted[i] == 0) continue;
                const uint32_t sample = raster_.slots.sample(index, lane + i);
                ++heat.tests[sample], ++heat.nodes[sample];
            }
        }
    }

    SlotRaster& raster_;
    const GridInSlot& in_;
    SlotGridScratch& boxes_;
    SampleStats& stats_;
    BlockRows<kSegments, kLens> rows_;
    int row_length_, shift_;
};

/// Bounds vertices, then micropolygons, then tests samples; the form of the test is chosen by motion and
/// lens.
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
    const bool origins = lens || !raster.camera.perspective;  // else all rays start in one point
    const auto run = [&](auto segments) HWY_ATTR {
        if (origins)
            CellRaster<segments(), true>(raster, in, rows, scratch, counted).run();
        else
            CellRaster<segments(), false>(raster, in, rows, scratch, counted).run();
    };
    if (!in.grid.moves())
        run(std::integral_constant<SlotSegments, SlotSegments::None>());
    else if (in.parts.size() == 1)
        run(std::integral_constant<SlotSegments, SlotSegments::One>());
    else
        run(std::integral_constant<SlotSegments, SlotSegments::Several>());
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
