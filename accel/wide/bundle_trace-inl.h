/// The way of a bundle through a tree, stage by stage; the stages are in the other -inl.h files. Compiled
/// once a target.
#if defined(TRAPEZE_ACCEL_BUNDLE_TRACE_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef TRAPEZE_ACCEL_BUNDLE_TRACE_INL_H_
#undef TRAPEZE_ACCEL_BUNDLE_TRACE_INL_H_
#else
#define TRAPEZE_ACCEL_BUNDLE_TRACE_INL_H_
#endif

#include <hwy/highway.h>

#include <algorithm>
#include <cmath>

#include "accel/grid_block.h"
#include "accel/wide/bundle_scratch.h"
#include "accel/wide/candidates-inl.h"
#include "accel/wide/fetch.h"
#include "accel/wide/grid_boxes-inl.h"
#include "accel/wide/grid_rays-inl.h"
#include "accel/wide/sharp_packets-inl.h"

HWY_BEFORE_NAMESPACE();
namespace trapeze {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

/// How many candidates before a grid's turn its record is fetched, and its bounds, which the record tells
/// where to find.
inline constexpr size_t kPrefetchAhead = 8, kPrefetchBoundsAhead = 4;
/// Rays of the next bundle that are fetched with each candidate.
inline constexpr size_t kRaysWithGrid = 128;

/// A bundle's way through a tree. kMotion: something in the tree moves; kLens: rays do not start in one
/// point; kSharp, which is for neither: by sharp packets.
template <bool kMotion, bool kLens, bool kSharp>
class BundleTrace {
    static_assert(!kSharp || (!kMotion && !kLens));

  public:
    explicit BundleTrace(const TraceInput& in)
        : t_{in.tree,
             in.range,
             in.inverse_focal,
             in.rays,
             in.scratch,
             in.stats,
             in.range.min - in.tree.max_slack(),
             (in.rays.count + kLanes - 1) / kLanes} {}

    /// Looks at candidates from front to back, nearly: grids behind what all rays have hit by then are
    /// skipped.
    void run() {
        begin();
        for (const uint32_t grid : t_.tree.unbounded_grids()) test_unbounded(grid);
        for (size_t p = 0; p < t_.packets; ++p) t_.refresh_packet(p);
        t_.refresh_farthest();
        collect_candidates<kMotion, kLens>(t_);
        const auto& candidates = t_.scratch.candidates;
        order_candidates(t_);
        for (size_t i = 0; i < candidates.size(); ++i) {
            const Candidate candidate = candidate_of(candidates[i]);
            // Not `break`: candidates are in order only up to a step.
            if (candidate.depth > t_.farthest_depth) continue;
            prefetch_grids(i);
            prefetch_coming();
            visit_grid(candidate);
        }
        // Those that the last grids have left: fewer than fill the list.
        test_waiting<kMotion>(t_);
        t_.stats.rays += t_.rays.count;
    }

  private:
    /// Fetches records and bounds of candidates that come some places after this one.
    HWY_INLINE void prefetch_grids(size_t candidate) const {
        const auto& all = t_.scratch.candidates;
        if (candidate + kPrefetchAhead < all.size())
            fetch(&t_.tree.grid(candidate_of(all[candidate + kPrefetchAhead]).grid), sizeof(WideGrid));
        if (candidate + kPrefetchBoundsAhead < all.size()) {
            const WideGrid& grid = t_.tree.grid(candidate_of(all[candidate + kPrefetchBoundsAhead]).grid);
            fetch(t_.tree.keys_of(grid), grid.header_bytes());
        }
    }

    /// Rays lie in memory pixel by pixel, and a bundle takes some of each: without this, their way from the
    /// outer caches is a tenth of the time.
    void prefetch_coming() {
        std::span<const uint32_t>& coming = t_.rays.coming;
        const size_t count = std::min(kRaysWithGrid, coming.size());
        for (size_t i = 0; i < count; ++i) {
            const char* ray = reinterpret_cast<const char*>(t_.rays.coming_rays + coming[i]);
            __builtin_prefetch(ray, 0, 2);
            __builtin_prefetch(ray + sizeof(AxisRay) - 1, 0, 2);
        }
        coming = coming.subspan(count);
    }

    /// Sets all rays to having hit nothing, and the packets' intervals. Lanes past the end repeat the last
    /// ray, so that intervals are right, and never count.
    void begin() {
        const F32 d;
        const hn::RebindToUnsigned<F32> du;
        const size_t end = t_.packets * kLanes;
        for (size_t i = t_.rays.count; i < end; ++i) {
            t_.rays.ox[i] = t_.rays.ox[t_.rays.count - 1], t_.rays.oy[i] = t_.rays.oy[t_.rays.count - 1];
            t_.rays.ux[i] = t_.rays.ux[t_.rays.count - 1], t_.rays.uy[i] = t_.rays.uy[t_.rays.count - 1];
            t_.rays.time[i] = t_.rays.time[t_.rays.count - 1];
        }
        const VF focal = hn::Set(d, t_.inverse_focal);
        for (size_t p = 0; p < t_.packets; ++p) {
            const size_t i = p * kLanes;
            hn::Store(hn::Set(d, t_.range.max), d, t_.rays.depth + i);
            hn::Store(hn::Set(du, RayBundle::kNone), du, t_.rays.id + i);
            const VF ox = hn::Load(d, t_.rays.ox + i), oy = hn::Load(d, t_.rays.oy + i);
            // d = u + o / f: where the ray is at the focal distance, divided by it
            // (accel/wide/ray_intervals-inl.h).
            const VF dx = hn::MulAdd(ox, focal, hn::Load(d, t_.rays.ux + i));
            const VF dy = hn::MulAdd(oy, focal, hn::Load(d, t_.rays.uy + i));
            set_interval(RayIntervals::kDxMin, p, dx);
            set_interval(RayIntervals::kDyMin, p, dy);
            if constexpr (kLens) {
                set_interval(RayIntervals::kOxMin, p, ox);
                set_interval(RayIntervals::kOyMin, p, oy);
            }
            if constexpr (kMotion) set_interval(RayIntervals::kTimeMin, p, hn::Load(d, t_.rays.time + i));
        }
        for (size_t i = t_.rays.count; i < end; ++i) t_.rays.depth[i] = -HUGE_VALF;  // look at nothing
        for (size_t p = t_.packets; p < t_.packets + kLanes; ++p) {
            for (auto& row : t_.scratch.intervals.row) row[p] = row[t_.packets - 1];
            t_.scratch.farthest[p] = -HUGE_VALF;
        }
        if constexpr (kMotion) {
            const auto& row = t_.scratch.intervals.row;
            const float* first = row[RayIntervals::kTimeMin];
            const float* last = row[RayIntervals::kTimeMax];
            t_.first_time = *std::min_element(first, first + t_.packets);
            t_.last_time = *std::max_element(last, last + t_.packets);
        }
    }

    /// Lower and upper bound of a packet's lanes, to rows `row` and `row + 1`.
    void set_interval(int row, size_t packet, VF v) {
        t_.scratch.intervals.row[row][packet] = least(v);
        t_.scratch.intervals.row[row + 1][packet] = largest(v);
    }

    /// One candidate: in all motion segments from that of the first ray time of the bundle to that of the
    /// last.
    void visit_grid(const Candidate& candidate) {
        const WideGrid& grid = t_.tree.grid(candidate.grid);
        if constexpr (kSharp) {
            visit_sharp(t_, candidate, grid);
            return;
        }
        if (!grid.moves()) {
            visit_segment<false>(candidate, grid, 0);
            return;
        }
        if constexpr (kMotion) {
            const int first = segment_at(t_.first_time, grid.key_count).index;
            const int last = segment_at(t_.last_time, grid.key_count).index;
            for (int segment = first; segment <= last; ++segment)
                visit_segment<true>(candidate, grid, segment);
        }
    }

    /// A grid in one segment of its motion: its active rays, then what they meet in it. kGridMoves: the grid
    /// moves (others in the tree may move where this one does not).
    template <bool kGridMoves>
    void visit_segment(const Candidate& candidate, const WideGrid& grid, int segment) {
        const MovingBox box = t_.tree.segment_box(grid, segment);
        collect_active<kGridMoves, kLens>(t_, box, grid, segment, candidate);
        test_active<kGridMoves, kLens>(t_, candidate, box, grid, segment);
        if (t_.scratch.waiting_count >= BundleScratch::kMostWaiting) test_waiting<kMotion>(t_);
    }

    /// Tests all rays against a grid that no box can hold, by the scalar predicate.
    void test_unbounded(uint32_t index) {
        const Grid& grid = t_.tree.grids().grids[index];
        for (size_t i = 0; i < t_.rays.count; ++i) {
            const AxisRay ray{t_.rays.ox[i], t_.rays.oy[i], 0, t_.rays.ux[i], t_.rays.uy[i], t_.rays.time[i]};
            for (int v = 0; v < grid.shape.nv; ++v)
                for (int u = 0; u < grid.shape.nu; ++u) {
                    ++t_.stats.predicate_tests;
                    float depth;
                    if (!hit_micropolygon(ray, grid.quad(u, v, ray.time), grid.facing, &depth)) continue;
                    if (!(depth >= t_.range.min && depth <= t_.range.max)) continue;
                    t_.keep_hit(
                        static_cast<uint32_t>(i), depth,
                        static_cast<uint32_t>(
                            MicropolygonId{index, static_cast<uint8_t>(u), static_cast<uint8_t>(v)}.packed()),
                        grid.opaque);
                }
        }
    }

    BundleState t_;
};

}  // namespace HWY_NAMESPACE
}  // namespace trapeze
HWY_AFTER_NAMESPACE();

#endif  // per-target include guard
