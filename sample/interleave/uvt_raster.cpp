#include "sample/interleave/uvt_raster.h"

#include "sample/visibility.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "sample/interleave/uvt_raster.cpp"
#include <hwy/foreach_target.h>  // compiles this file once a target

#include "core/hit_micropolygon-inl.h"
#include "core/simd/simd-inl.h"
#include "sample/interleave/uvt_mesh-inl.h"
#include "sample/interleave/uvt_tuples-inl.h"

HWY_BEFORE_NAMESPACE();
namespace trapeze {
namespace HWY_NAMESPACE {

/// One grid in a tile, tuple by tuple. For each tuple that may see the grid: place the vertices, make boxes,
/// queue the samples in them, test the queue. Depths so far are kept by tuple and cell, which is where
/// culling looks.
template <bool kPerspective>
class GridRaster {
  public:
    GridRaster(UvtRaster& raster, const BoundedGrid& grid, SampleStats& stats)
        : raster_(raster),
          grid_(grid),
          scratch_(raster.own),
          tile_(scratch_.tile),
          rows_(scratch_.rows),
          mesh_(raster.camera, grid.bounds[grid.index], scratch_),
          stats_(stats) {}

    void run() {
        find_tuples<kPerspective>(raster_, grid_, tile_, scratch_.tuples);
        if (scratch_.tuples.count == 0) return;
        const bool moves = grid_.grid.moves();
        mesh_.load(grid_.grid, moves);
        if (!moves && !raster_.camera.has_lens())
            raster_still();
        else
            for (size_t i = 0; i < scratch_.tuples.count; ++i) raster_tuple(i, moves);
    }

  private:
    using D = UvtLanes;
    using DI = hn::RebindToSigned<D>;
    using V = hn::Vec<D>;
    using VI = hn::Vec<DI>;

    using Tuple = PlacedTuple;

    /// `listed` counts among the tuples that may see the grid, and not among all.
    Tuple tuple(size_t listed) const {
        return mesh_.tuple(raster_, static_cast<size_t>(scratch_.tuples.tuple[listed]), grid_.grid.key_count,
                           scratch_.tuples.slack[listed]);
    }

    /// A grid that looks alike to all tuples: boxes are made once.
    void raster_still() {
        const Tuple first = tuple(0);
        const bool careful = scratch_.tuples.careful[0] != 0;
        for (auto* plane : {&scratch_.x0, &scratch_.x1, &scratch_.y0, &scratch_.y1, &scratch_.depth})
            plane->resize(static_cast<size_t>(rows_.padded_count()));
        mesh_.template place<false>(first);
        const auto store = [this](int i, V x0, V x1, V y0, V y1, V z0) HWY_ATTR {
            const D d;
            hn::StoreU(x0, d, &scratch_.x0[i]), hn::StoreU(x1, d, &scratch_.x1[i]);
            hn::StoreU(y0, d, &scratch_.y0[i]), hn::StoreU(y1, d, &scratch_.y1[i]);
            hn::StoreU(z0, d, &scratch_.depth[i]);
        };
        if (careful)
            stats_.nodes_visited += mesh_.template make_boxes<true>(first, raster_.cull, store);
        else
            stats_.nodes_visited += mesh_.template make_boxes<false>(first, raster_.cull, store);
        for (size_t listed = 0; listed < scratch_.tuples.count; ++listed) {
            if (raster_.cull && is_hidden(listed)) continue;
            const D d;
            const Tuple at = tuple(listed);
            for (int i = 0; i < rows_.quad_end(); i += static_cast<int>(hn::Lanes(d)))
                visit(at, i, hn::LoadU(d, &scratch_.x0[i]), hn::LoadU(d, &scratch_.x1[i]),
                      hn::LoadU(d, &scratch_.y0[i]), hn::LoadU(d, &scratch_.y1[i]),
                      hn::LoadU(d, &scratch_.depth[i]));
            test_queue(at);
        }
    }

    /// A grid as one tuple sees it: vertices are placed at its time and lens point, boxes made and visited.
    void raster_tuple(size_t listed, bool moves) {
        if (raster_.cull && is_hidden(listed)) return;
        const Tuple at = tuple(listed);
        if (moves)
            mesh_.template place<true>(at);
        else
            mesh_.template place<false>(at);
        const auto visit_box = [&](int i, V x0, V x1, V y0, V y1, V z0)
                                   HWY_ATTR { visit(at, i, x0, x1, y0, y1, z0); };
        if (scratch_.tuples.careful[listed] != 0)
            stats_.nodes_visited += mesh_.template make_boxes<true>(at, raster_.cull, visit_box);
        else
            stats_.nodes_visited += mesh_.template make_boxes<false>(at, raster_.cull, visit_box);
        test_queue(at);
    }

    /// Whether all samples of a tuple that the grid may cover see something nearer than it.
    bool is_hidden(size_t listed) {
        const D d;
        const UvtGridTuples& tuples = scratch_.tuples;
        const float* depths = tile_.depths(static_cast<size_t>(tuples.tuple[listed]));
        const V z_min = hn::Set(d, tuples.z_min[listed]);
        const int first = tuples.first_x[listed], last = tuples.last_x[listed];
        for (int y = tuples.first_y[listed]; y <= tuples.last_y[listed]; ++y)
            for (int x = first; x <= last; x += static_cast<int>(hn::Lanes(d))) {
                const auto covered = hn::FirstN(d, static_cast<size_t>(last + 1 - x));
                const V farthest = hn::LoadU(d, depths + y * tile_.cells_x() + x);
                if (!hn::AllFalse(d, hn::And(covered, hn::Ge(farthest, z_min)))) return false;
            }
        return true;
    }

    /// Queues the samples of a tuple in boxes: one for each cell at most.
    HWY_INLINE void visit(const Tuple& at, int first, V x0, V x1, V y0, V y1, V z0) {
        const D d;
        const DI di;
        const auto side = static_cast<float>(tile_.cell_side());
        const V per_side = hn::Set(d, 1 / side), x = hn::Set(d, at.x), y = hn::Set(d, at.y);
        const V last_x = hn::Set(d, at.x + (side - 1)), last_y = hn::Set(d, at.y + (side - 1));
        const VI one = hn::Set(di, 1), low_half = hn::Set(di, 0xffff), cells_x = hn::Set(di, tile_.cells_x());
        // A cell's sample lies between its first and its last pixel's.
        const auto first_cell = [&](V low, V last) HWY_ATTR {
            return hn::ConvertTo(di, hn::Ceil(hn::Mul(hn::Sub(low, last), per_side)));
        };
        const auto end_cell = [&](V high, V place) HWY_ATTR {
            return hn::Add(hn::ConvertTo(di, hn::Floor(hn::Mul(hn::Sub(high, place), per_side))), one);
        };
        const VI cx0 = first_cell(x0, last_x), cx1 = end_cell(x1, x);
        const VI cy0 = first_cell(y0, last_y), cy1 = end_cell(y1, y);
        const int32_t* pixels = tile_.cell_pixels(static_cast<int>(at.index / samples_per_pixel()));
        const float* depths = tile_.depths(at.index);
        auto of_rows = hn::And(hn::Lt(cx0, cx1), hn::Lt(cy0, cy1));
        for (VI cy = cy0; !hn::AllFalse(di, of_rows);
             cy = hn::Add(cy, one), of_rows = hn::And(of_rows, hn::Lt(cy, cy1))) {
            const VI row = hn::Mul(cy, cells_x);
            auto in_row = of_rows;
            for (VI cx = cx0; !hn::AllFalse(di, in_row);
                 cx = hn::Add(cx, one), in_row = hn::And(in_row, hn::Lt(cx, cx1))) {
                const VI cell = hn::IfThenElseZero(in_row, hn::Add(row, cx));
                const VI pixel = hn::GatherIndex(di, pixels, cell);
                const V sample_x = hn::Add(hn::ConvertTo(d, hn::And(pixel, low_half)), x);
                const V sample_y = hn::Add(hn::ConvertTo(d, hn::ShiftRight<16>(pixel)), y);
                auto wanted = hn::And(hn::And(hn::Ge(sample_x, x0), hn::Le(sample_x, x1)),
                                      hn::And(hn::Ge(sample_y, y0), hn::Le(sample_y, y1)));
                wanted = hn::And(wanted, hn::RebindMask(d, in_row));
                if (raster_.cull) wanted = hn::And(wanted, hn::Le(z0, hn::GatherIndex(d, depths, cell)));
                queue(at, first, hn::RebindMask(di, wanted), pixel);
            }
        }
    }

    /// Without a branch on whether there is any: that is hard to predict.
    HWY_INLINE void queue(const Tuple& at, int first, hn::Mask<DI> wanted, VI pixel) {
        const DI di;
        UvtQueue& queue = scratch_.queue;
        hn::StoreU(hn::Compress(lane_numbers(di, first), wanted), di, queue.quad + queue.count);
        hn::StoreU(hn::Compress(pixel, wanted), di, queue.pixel + queue.count);
        queue.count += hn::CountTrue(di, wanted);
        if (queue.count >= UvtQueue::kFull) test_queue(at);
    }

    /// Tests the queued pairs of micropolygon and sample, a vector of them at once, and empties the queue.
    void test_queue(const Tuple& at) {
        const D d;
        const DI di;
        UvtQueue& queue = scratch_.queue;
        hn::StoreU(hn::Zero(di), di,
                   queue.quad + queue.count);  // lanes past the end read something that is there
        hn::StoreU(hn::Zero(di), di, queue.pixel + queue.count);
        stats_.predicate_tests += queue.count;
        const float *columns = tile_.columns(at.index), *rows = tile_.rows(at.index);
        const int row = rows_.row_length();
        for (size_t i = 0; i < queue.count; i += hn::Lanes(d)) {
            const VI quad = hn::LoadU(di, queue.quad + i), pixel = hn::LoadU(di, queue.pixel + i);
            const V along_x = hn::GatherIndex(d, columns, hn::And(pixel, hn::Set(di, 0xffff)));
            const V along_y = hn::GatherIndex(d, rows, hn::ShiftRight<16>(pixel));
            const float* planes[3] = {mesh_.plane(0), mesh_.plane(1), mesh_.plane(2)};
            const auto vertex = [&](int component, int corner) HWY_ATTR {
                return hn::GatherIndex(d, planes[component] + (corner & 1) + (corner >> 1) * row, quad);
            };
            V depth = hn::Zero(d);
            hn::Mask<D> hit;
            if constexpr (kPerspective)
                hit = hit_micropolygon(d, hn::Set(d, at.lens_x), hn::Set(d, at.lens_y), hn::Zero(d), along_x,
                                       along_y, vertex, grid_.grid.facing, depth);
            else
                hit = hit_micropolygon(d, along_x, along_y, hn::Zero(d), hn::Set(d, -at.slope_x),
                                       hn::Set(d, -at.slope_y), vertex, grid_.grid.facing, depth);
            hit = hn::And(hit, hn::FirstN(d, queue.count - i));
            if (raster_.scratch.heat) count_heat(at, i, std::min(hn::Lanes(d), queue.count - i));
            if (!hn::AllFalse(d, hit)) keep(at, i, hit, depth);
        }
        queue.count = 0;
    }

    /// Goes over the lanes that hit: `left` has a bit for each. Two lanes may be of one sample, so they are
    /// taken one after the other.
    void keep(const Tuple& at, size_t first, hn::Mask<D> hit, V depth) {
        const D d;
        HWY_ALIGN float depths[UvtQueue::kPadding];
        hn::Store(depth, d, depths);
        uint32_t left = mask_bits(d, hit);
        stats_.predicate_hits += hn::CountTrue(d, hit);
        float* nearest = tile_.depths(at.index);
        uint64_t* ids = tile_.ids(at.index);
        for (; left != 0; left &= left - 1) {
            const auto lane = static_cast<size_t>(__builtin_ctz(left)), i = first + lane;
            const size_t cell = tile_.cell_of(scratch_.queue.pixel[i]);
            const Hit found{
                depths[lane],
                uint64_t{grid_.index} << 8 | static_cast<uint64_t>(rows_.quad_ids()[scratch_.queue.quad[i]])};
            if (!(found.depth >= raster_.camera.near_clip && found.depth <= raster_.camera.far_clip))
                continue;
            if (!in_front(found, {nearest[cell], ids[cell]})) continue;
            if (grid_.grid.opaque) nearest[cell] = found.depth, ids[cell] = found.id;
            if (raster_.all_opaque) continue;
            raster_.scratch.found.add(static_cast<uint32_t>(sample_of(at, i)), found);
        }
    }

    /// Counts costs by sample (SampleHeat), for pictures of where the work is: here a test counts as a node,
    /// too.
    void count_heat(const Tuple& at, size_t first, size_t count) {
        for (size_t i = first; i < first + count; ++i) {
            const size_t sample = sample_of(at, i);
            ++raster_.scratch.heat->tests[sample], ++raster_.scratch.heat->nodes[sample];
        }
    }

    size_t samples_per_pixel() const { return static_cast<size_t>(raster_.pattern.sample_count()); }

    /// In the rectangle, of an entry of the queue.
    size_t sample_of(const Tuple& at, size_t queued) const {
        const int32_t pixel = scratch_.queue.pixel[queued];
        const int x = (pixel & 0xffff) + tile_.x0() - raster_.pixels.x0,
                  y = (pixel >> 16) + tile_.y0() - raster_.pixels.y0;
        return static_cast<size_t>(y * raster_.pixels.width() + x) * samples_per_pixel() +
               at.index % samples_per_pixel();
    }

    UvtRaster& raster_;
    const BoundedGrid& grid_;
    UvtScratch& scratch_;
    UvtTile& tile_;
    VertexRows& rows_;
    UvtMesh<kPerspective> mesh_;
    SampleStats& stats_;
};

void raster_grid_uvt(UvtRaster& raster, const BoundedGrid& grid, SampleStats& stats) {
    if (raster.camera.perspective)
        GridRaster<true>(raster, grid, stats).run();
    else
        GridRaster<false>(raster, grid, stats).run();
}

}  // namespace HWY_NAMESPACE
}  // namespace trapeze
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace trapeze {

HWY_EXPORT(raster_grid_uvt);

/// The kind of projection is a template argument, as it stands in the innermost loop.
void raster_grid_uvt(UvtRaster& raster, const BoundedGrid& grid, SampleStats& stats) {
    HWY_DYNAMIC_DISPATCH(raster_grid_uvt)(raster, grid, stats);
}

}  // namespace trapeze
#endif  // HWY_ONCE
