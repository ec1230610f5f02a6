#include "sample/dualspace/dual_raster.h"

#include <algorithm>
#include <cstddef>

#include "sample/visibility.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "sample/dualspace/dual_raster.cpp"
#include <hwy/foreach_target.h>  // compiles this file once a target

#include "core/hit_micropolygon-inl.h"
#include "core/simd/simd-inl.h"
#include "sample/dualspace/dual_intervals-inl.h"
#include "sample/dualspace/dual_mesh-inl.h"

HWY_BEFORE_NAMESPACE();
namespace trapeze {
namespace HWY_NAMESPACE {

/// One grid in a tile, micropolygon by micropolygon. First the mesh is placed for a part of the shutter, then
/// each micropolygon's intervals of columns and rows of pixels are found, then the samples in both are tested
/// against it.
template <bool kMotion, bool kLens>
class GridDual {
  public:
    GridDual(DualRaster& raster, const BoundedGrid& grid, SampleStats& stats)
        : raster_(raster),
          camera_(raster.camera),
          grid_(grid),
          bound_(grid.bounds[grid.index]),
          segments_(segment_count(grid.grid.key_count)),
          scratch_(raster.own),
          vertices_(scratch_.vertices),
          masks_(scratch_.masks),
          width_(raster.samples.pixels.width()),
          stats_(stats) {
        // A perspective slack's far part counts per depth, which is no more than what `near` has.
        constants_.slack = camera_.perspective ? 3 * bound_.slack.near : bound_.slack.far;
        constants_.parts = kMotion ? std::max(segments_, kLens ? raster.parts : 1) : 1;
    }

    void run() {
        vertices_.load(grid_.grid);
        // A word of samples may come when one less than kFull are there, and a vector is read past the end.
        scratch_.candidates.resize(kFull + 64 + DualIntervals::kPadding);
        for (constants_.part = 0; constants_.part < constants_.parts; ++constants_.part)
            if (set_part()) raster_part();
    }

  private:
    using D = hn::CappedTag<float, DualIntervals::kPadding>;
    using DI = hn::RebindToSigned<D>;
    using V = hn::Vec<D>;
    using VI = hn::Vec<DI>;

    /// Candidates are tested when there are so many.
    static constexpr size_t kFull = 512;

    /// Corners are numbered as the predicate has them: 00, 10, 01, 11.
    int corner_of(int quad, int corner) const {
        return quad + (corner & 1) + (corner >> 1) * vertices_.row_length();
    }

    /// False when the grid shows nothing in the tile during the part of the shutter.
    bool set_part() {
        const int part = constants_.part, parts = constants_.parts;
        segment_ = part * segments_ / parts;
        // Bins have the same bounds as parts, where these are no more: no sample is in two of them.
        first_bin_ = part * SampleMasks::kBins / parts;
        last_bin_ = std::max(first_bin_, (part + 1) * SampleMasks::kBins / parts - 1);
        const auto local = [&](int at) {  // exact: all are powers of two
            return static_cast<float>(at * segments_) / static_cast<float>(parts) -
                   static_cast<float>(segment_);
        };
        const SegmentPart within{segment_, local(part), local(part + 1)};
        scratch_.part.assign(1, within);
        constexpr float kRim = kLens ? DualIntervals::kLensRim : 0;
        const SlotBound bound =
            grid_.bounds.slot_bound(grid_.index, scratch_.part, {-kRim, -kRim, kRim, kRim});
        if (pixels_within(bound.box, raster_.samples.pixels).empty()) return false;
        return DualMesh<kMotion, kLens>(raster_, bound_).place(within);
    }

    /// All micropolygons that show in the tile during the part: place() has left their boxes in pixels, both
    /// ends included, and -1 where there is none.
    void raster_part() {
        const DualMeshScratch& mesh = scratch_.mesh;
        for (quad_ = 0; quad_ < vertices_.quad_end(); ++quad_)
            if (mesh.x1[quad_] >= 0)
                raster_quad({mesh.x0[quad_], mesh.y0[quad_], mesh.x1[quad_] + 1, mesh.y1[quad_] + 1});
    }

    /// One micropolygon: which samples of which columns and rows may see it, then the tests of those. Where
    /// it cannot be bounded all samples of the box are tested.
    void raster_quad(const PixelRect& box) {
        DualIntervals &columns = scratch_.columns, &rows = scratch_.rows;
        if (bound_.boundable) {
            if (!find_intervals<kMotion, kLens>(corners(0), constants_, box.x0, box.x1 - 1, columns)) return;
            if (!find_intervals<kMotion, kLens>(corners(1), constants_, box.y0, box.y1 - 1, rows)) return;
        } else {
            columns.see_all(box.x0, box.x1 - 1), rows.see_all(box.y0, box.y1 - 1);
        }
        for (int row = box.y0; row < box.y1; ++row)
            if (rows.first_s[row] <= rows.last_s[row]) collect_row(row, box.x0, box.x1);
        test_candidates();
    }

    /// For find_intervals(), along x (0) or y (1). With an orthographic camera w is 1: slopes do not spread
    /// with depth.
    DualCorners corners(int axis) const {
        const DualMeshScratch& mesh = scratch_.mesh;
        DualCorners c;
        for (int end = 0; end < DualMesh<kMotion, kLens>::kEnds; ++end)
            for (int corner = 0; corner < 4; ++corner) {
                const auto at = static_cast<size_t>(corner_of(quad_, corner));
                c.at[end][corner] = mesh.at[end][axis][at];
                c.w[end][corner] = camera_.perspective ? mesh.at[end][2][at] : 1.0f;
                c.lens[end][corner] = mesh.lens[end][at];
            }
        return c;
    }

    /// The samples of a row of pixels that lie within both their column's and their row's intervals.
    void collect_row(int row, int begin, int end) {
        const DualIntervals &columns = scratch_.columns, &rows = scratch_.rows;
        const size_t words = masks_.words();
        const auto first_v = static_cast<size_t>(rows.first_s[row]) * words,
                   end_v = static_cast<size_t>(rows.last_s[row] + 1) * words;
        const size_t pixel_of_row = static_cast<size_t>(row) * static_cast<size_t>(width_);
        for (int column = begin; column < end; ++column) {
            const int first_t =
                          kMotion ? std::max({first_bin_, columns.first_t[column], rows.first_t[row]}) : 0,
                      last_t = kMotion ? std::min({last_bin_, columns.last_t[column], rows.last_t[row]}) : 0;
            if (first_t > last_t || columns.first_s[column] > columns.last_s[column]) continue;
            ++stats_.nodes_visited;
            const size_t pixel = pixel_of_row + static_cast<size_t>(column);
            const auto first_u = static_cast<size_t>(columns.first_s[column]) * words,
                       end_u = static_cast<size_t>(columns.last_s[column] + 1) * words;
            const uint64_t *u = masks_.below(pixel, SampleMasks::kU),
                           *v = masks_.below(pixel, SampleMasks::kV),
                           *t = masks_.below(pixel, SampleMasks::kTime);
            for (size_t word = 0; word < words; ++word) {
                uint64_t set =
                    (u[end_u + word] & ~u[first_u + word]) & (v[end_v + word] & ~v[first_v + word]);
                if constexpr (kMotion)
                    set &= t[static_cast<size_t>(last_t + 1) * words + word] &
                           ~t[static_cast<size_t>(first_t) * words + word];
                add_candidates(pixel, word, set);
            }
        }
    }

    /// Candidates of many pixels are collected before they are tested, so that vectors are full where each
    /// pixel has a few.
    HWY_INLINE void add_candidates(size_t pixel, size_t word, uint64_t set) {
        const size_t first = pixel * static_cast<size_t>(raster_.samples.samples_per_pixel) + word * 64;
        for (; set != 0; set &= set - 1)
            scratch_.candidates[count_++] =
                static_cast<uint32_t>(first + static_cast<size_t>(__builtin_ctzll(set)));
        if (count_ >= kFull) test_candidates();
    }

    /// The predicate on a vector of candidates: their rays are gathered, the micropolygon is the same for
    /// all. A sample whose time is in another segment is left out here; it meets the micropolygon in that
    /// segment's parts.
    void test_candidates() {
        const D d;
        const DI di;
        uint32_t* samples = scratch_.candidates.data();
        std::fill_n(samples + count_, DualIntervals::kPadding, 0);  // lanes past the end read what is there
        static_assert(sizeof(AxisRay) % sizeof(float) == 0);
        const VI ray_size = hn::Set(di, static_cast<int32_t>(sizeof(AxisRay) / sizeof(float)));
        const AxisRay* rays = raster_.samples.rays.data();
        for (size_t i = 0; i < count_; i += hn::Lanes(d)) {
            const VI ray = hn::Mul(hn::LoadU(di, reinterpret_cast<const int32_t*>(samples + i)), ray_size);
            auto wanted = hn::FirstN(d, count_ - i);
            V local = hn::Zero(d);
            if constexpr (kMotion) {
                // segment_at(); neighbours of the segment are tested in their own.
                const V scaled =
                    hn::Mul(hn::GatherIndex(d, &rays->time, ray), hn::Set(d, static_cast<float>(segments_)));
                const VI segment =
                    hn::Min(hn::Max(hn::ConvertTo(di, scaled), hn::Zero(di)), hn::Set(di, segments_ - 1));
                wanted = hn::And(wanted, hn::RebindMask(d, hn::Eq(segment, hn::Set(di, segment_))));
                local = hn::Sub(scaled, hn::ConvertTo(d, segment));
            }
            const auto vertex = [&](int component, int corner) HWY_ATTR {
                const int at = corner_of(quad_, corner);
                const V start = hn::Set(d, vertices_.plane(segment_, component)[at]);
                if constexpr (kMotion)
                    return position_at(start, hn::Set(d, vertices_.plane(segment_, 3 + component)[at]),
                                       local);
                else
                    return start;
            };
            V depth = hn::Zero(d);
            const auto hit = hn::And(
                hit_micropolygon(d, hn::GatherIndex(d, &rays->ox, ray), hn::GatherIndex(d, &rays->oy, ray),
                                 hn::Zero(d), hn::GatherIndex(d, &rays->ux, ray),
                                 hn::GatherIndex(d, &rays->uy, ray), vertex, grid_.grid.facing, depth),
                wanted);
            stats_.predicate_tests += hn::CountTrue(d, wanted);
            if (raster_.scratch.heat) count_heat(samples + i, wanted);
            if (!hn::AllFalse(d, hit)) keep(samples + i, hit, depth);
        }
        count_ = 0;
    }

    static uint32_t bits_of(hn::Mask<D> mask) { return mask_bits(D(), mask); }

    /// Hits are few, and are taken lane by lane. The clipping range is checked here, for a box that reaches
    /// it may hold hits outside.
    void keep(const uint32_t* samples, hn::Mask<D> hit, V depth) {
        const D d;
        HWY_ALIGN float depths[DualIntervals::kPadding];
        hn::Store(depth, d, depths);
        stats_.predicate_hits += hn::CountTrue(d, hit);
        const uint64_t id = uint64_t{grid_.index} << 8 | static_cast<uint64_t>(vertices_.quad_ids()[quad_]);
        for (uint32_t left = bits_of(hit); left != 0; left &= left - 1) {
            const int lane = __builtin_ctz(left);
            const uint32_t sample = samples[lane];
            const Hit found{depths[lane], id};
            if (!(found.depth >= camera_.near_clip && found.depth <= camera_.far_clip)) continue;
            Hit& nearest = raster_.scratch.nearest[sample];
            if (!in_front(found, nearest)) continue;
            if (grid_.grid.opaque) nearest = found;
            if (raster_.all_opaque) continue;
            raster_.scratch.found.add(sample, found);
        }
    }

    void count_heat(const uint32_t* samples, hn::Mask<D> wanted) {
        for (uint32_t left = bits_of(wanted); left != 0; left &= left - 1) {
            const uint32_t sample = samples[__builtin_ctz(left)];
            ++raster_.scratch.heat->tests[sample], ++raster_.scratch.heat->nodes[sample];
        }
    }

    DualRaster& raster_;
    const Camera& camera_;
    const BoundedGrid& grid_;
    const GridBound& bound_;
    const int segments_;
    DualScratch& scratch_;
    VertexRows& vertices_;
    const SampleMasks& masks_;
    const int width_;
    DualConstants constants_{};
    SampleStats& stats_;
    int segment_ = 0, first_bin_ = 0, last_bin_ = 0;  ///< of the part of the shutter
    int quad_ = 0;                                    ///< its vertex 00
    size_t count_ = 0;                                ///< candidates
};

/// Chooses the form for the grid and the camera: what does not move or has no lens spares the arithmetic of
/// it.
void raster_grid_dual(DualRaster& raster, const BoundedGrid& grid, SampleStats& stats) {
    const bool lens = raster.camera.has_lens();
    if (grid.grid.moves())
        lens ? GridDual<true, true>(raster, grid, stats).run()
             : GridDual<true, false>(raster, grid, stats).run();
    else
        lens ? GridDual<false, true>(raster, grid, stats).run()
             : GridDual<false, false>(raster, grid, stats).run();
}

}  // namespace HWY_NAMESPACE
}  // namespace trapeze
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace trapeze {

HWY_EXPORT(raster_grid_dual);

/// The image plane's coordinate at the left and right (upper and lower) side of each pixel, as the camera's
/// rays have it; padded, since vectors are read past the end.
void DualIntervals::set_pixels(int first, int count, float plane_scale, float plane_offset) {
    const auto size = static_cast<size_t>(count + kPadding);
    for (auto* plane : {&low, &high}) plane->resize(size);
    for (auto* plane : {&first_s, &last_s, &first_t, &last_t}) plane->resize(size);
    for (size_t i = 0; i < size; ++i) {
        const auto pixel = static_cast<float>(first + static_cast<int>(i));
        low[i] = pixel * plane_scale + plane_offset, high[i] = (pixel + 1) * plane_scale + plane_offset;
    }
}

/// Where no bound is known all bins may be met: slow, but no sample is lost.
void DualIntervals::see_all(int first, int last) {
    for (auto* plane : {&first_s, &first_t}) std::fill(plane->begin() + first, plane->begin() + last + 1, 0);
    for (auto* plane : {&last_s, &last_t})
        std::fill(plane->begin() + first, plane->begin() + last + 1, SampleMasks::kBins - 1);
}

/// Grows to the largest mesh of its thread, and is not cleared: each mesh writes what it reads.
void DualMeshScratch::resize(size_t count) {
    for (auto& end : at)
        for (auto& plane : end) plane.resize(count);
    for (auto& plane : lens) plane.resize(count);
    for (auto& plane : min) plane.resize(count);
    for (auto& plane : max) plane.resize(count);
    for (auto* plane : {&x0, &x1, &y0, &y1}) plane->resize(count);
}

void raster_grid_dual(DualRaster& raster, const BoundedGrid& grid, SampleStats& stats) {
    HWY_DYNAMIC_DISPATCH(raster_grid_dual)(raster, grid, stats);
}

}  // namespace trapeze
#endif  // HWY_ONCE
