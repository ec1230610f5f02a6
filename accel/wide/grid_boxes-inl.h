/// The tests within a grid: which boxes of blocks its active rays meet, then for each block the rays that may
/// hit it. Compiled once a target.
#if defined(TRAPEZE_ACCEL_GRID_BOXES_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef TRAPEZE_ACCEL_GRID_BOXES_INL_H_
#undef TRAPEZE_ACCEL_GRID_BOXES_INL_H_
#else
#define TRAPEZE_ACCEL_GRID_BOXES_INL_H_
#endif

#include <hwy/highway.h>

#include <bit>
#include <cstring>

#include "accel/wide/block_slabs-inl.h"
#include "accel/wide/block_tests-inl.h"
#include "accel/wide/box_codes-inl.h"
#include "accel/wide/compact_lanes-inl.h"
#include "core/simd/simd-inl.h"

HWY_BEFORE_NAMESPACE();
namespace trapeze {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

/// Finding a block's slabs pays for so many rays or more.
inline constexpr size_t kFewForSlabs = 12;

/// Up to so many rays meet a grid's boxes one ray at a time, lanes being boxes; their number fits the bits of
/// a byte.
inline constexpr size_t kFewInGrid = std::min<size_t>(kLanes / 2, 8);

/// Tests a vector of active rays, those from `i` on, against one box after another, and writes a mask for
/// each box, kMetStride bytes apart from `met` on. kAlike: along each axis all look to the same side
/// (sides[k]: against it), so that it is known which plane of a box comes first.
template <bool kMotion, bool kLens, bool kAlike>
void meet_boxes_of(BundleState& t, size_t i, const float* planes, int boxes, const int* sides, uint8_t* met) {
    const F32 d;
    const ActiveRays& active = t.scratch.active;
    constexpr size_t stride = BoxPlanes::kMost;
    const VF local = kMotion ? hn::Load(d, active.local + i) : hn::Zero(d);
    const VF limit = hn::Load(d, active.limit + i);
    VF inverse[3], offset[3];
    const float *first[3], *last[3];
    for (size_t k = 0; k < 3; ++k) {
        inverse[k] = hn::Load(d, active.inverse[k] + i);
        offset[k] = kLens ? hn::Load(d, active.offset[k] + i) : hn::Zero(d);
        // Rows 0 to 2 are low planes, 3 to 5 high ones; six rows further on is how far each moves.
        first[k] = planes + (k + (kAlike && sides[k] ? 3 : 0)) * stride;
        last[k] = planes + (k + (kAlike && sides[k] ? 0 : 3)) * stride;
    }
    for (int b = 0; b < boxes; ++b, met += kMetStride) {
        VF near, far;
        for (int k = 0; k < 3; ++k) {
            VF from = hn::Set(d, first[k][b]), to = hn::Set(d, last[k][b]);
            if constexpr (kMotion) {
                from = hn::MulAdd(local, hn::Set(d, first[k][b + 6 * stride]), from);
                to = hn::MulAdd(local, hn::Set(d, last[k][b + 6 * stride]), to);
            }
            VF enter = kLens ? hn::MulSub(from, inverse[k], offset[k]) : hn::Mul(from, inverse[k]);
            VF leave = kLens ? hn::MulSub(to, inverse[k], offset[k]) : hn::Mul(to, inverse[k]);
            if constexpr (!kAlike) {
                const VF a = enter;
                enter = hn::Min(a, leave), leave = hn::Max(a, leave);
            }
            near = k == 0 ? enter : hn::Max(near, enter);
            far = k == 0 ? hn::Min(leave, limit) : hn::Min(far, leave);
        }
        hn::StoreMaskBits(d, hn::Le(near, far), met);
    }
}

/// Lanes past the end of the active rays meet nothing, whatever an earlier bundle has left there: infinities
/// would.
template <bool kMotion, bool kLens>
void pad_active(ActiveRays& active) {
    const F32 d;
    hn::StoreU(hn::Set(d, -HUGE_VALF), d, active.limit + active.count);
    if constexpr (kMotion) hn::StoreU(hn::Zero(d), d, active.local + active.count);
    for (int k = 0; k < 3; ++k) {
        hn::StoreU(hn::Zero(d), d, active.inverse[k] + active.count);
        if constexpr (kLens) hn::StoreU(hn::Zero(d), d, active.offset[k] + active.count);
    }
}

/// Whether any bit of a row of meet_boxes() is set, and how many are. Unused bits of a row are 0.
inline bool has_bits(const uint8_t* row, size_t bytes) {
    uint64_t all = 0, word;
    size_t i = 0;
    for (; i + 8 <= bytes; i += 8) std::memcpy(&word, row + i, 8), all |= word;
    for (; i < bytes; ++i) all |= row[i];
    return all != 0;
}
inline size_t count_bits(const uint8_t* row, size_t bytes) {
    size_t count = 0, i = 0;
    for (; i + 8 <= bytes; i += 8) {
        uint64_t word;
        std::memcpy(&word, row + i, 8);
        count += static_cast<size_t>(std::popcount(word));
    }
    for (; i < bytes; ++i) count += static_cast<size_t>(std::popcount(row[i]));
    return count;
}

/// Tests all active rays, in vectors, against one box after another; a bit for each box that any ray meets.
template <bool kMotion, bool kLens>
uint32_t meet_boxes_in_turn(BundleState& t, const float* planes, int boxes) {
    const F32 d;
    ActiveRays& active = t.scratch.active;
    pad_active<kMotion, kLens>(active);
    for (size_t i = 0; i < active.count; i += kLanes) {
        // Lanes past the end have no side: they must not make a vector count as one of both.
        const uint32_t valid = active.count - i < kLanes ? (1u << (active.count - i)) - 1 : kAllLanes;
        int sides[3];
        bool alike = true;
        for (int k = 0; k < 3; ++k) {
            const VF inverse = hn::Load(d, active.inverse[k] + i);
            const uint32_t backward = mask_bits(predicate_lanes::negative(d, inverse)) & valid;
            // A ray that looks along an axis crosses the low plane first, one that looks against it the high
            // plane.
            sides[k] = backward != 0;
            alike = alike && (backward == 0 || backward == valid);
        }
        uint8_t* met = t.scratch.met + i / kLanes * kMaskBytes;
        if (alike)
            meet_boxes_of<kMotion, kLens, true>(t, i, planes, boxes, sides, met);
        else
            meet_boxes_of<kMotion, kLens, false>(t, i, planes, boxes, sides, met);
    }
    uint32_t any = 0;
    const size_t bytes = (active.count + kLanes - 1) / kLanes * kMaskBytes;
    for (int b = 0; b < boxes; ++b)
        any |= uint32_t{has_bits(t.scratch.met + static_cast<size_t>(b) * kMetStride, bytes)} << b;
    return any;
}

/// What meet_boxes_in_turn() does, for at most kFewInGrid rays: each against vectors of boxes, because
/// vectors of so few rays would be nearly empty.
template <bool kMotion, bool kLens>
uint32_t meet_boxes_each(BundleState& t, const float* planes, int boxes) {
    const F32 d;
    const ActiveRays& active = t.scratch.active;
    constexpr size_t stride = BoxPlanes::kMost;
    const auto count = static_cast<size_t>(boxes);
    for (size_t b = 0; b < count; ++b) std::memset(t.scratch.met + b * kMetStride, 0, kMaskBytes);
    uint32_t any = 0;
    for (size_t r = 0; r < active.count; ++r) {
        const VF local = kMotion ? hn::Set(d, active.local[r]) : hn::Zero(d);
        uint32_t met = 0;
        for (size_t b = 0; b < count; b += kLanes) {
            VF near = hn::Set(d, -HUGE_VALF), far = hn::Set(d, active.limit[r]);
            for (size_t k = 0; k < 3; ++k) {
                const float* low = planes + k * stride + b;
                const float* high = low + 3 * stride;
                VF from = hn::Load(d, low), to = hn::Load(d, high);
                if constexpr (kMotion) {
                    from = hn::MulAdd(local, hn::Load(d, low + 6 * stride), from);
                    to = hn::MulAdd(local, hn::Load(d, high + 6 * stride), to);
                }
                const VF inverse = hn::Set(d, active.inverse[k][r]);
                const VF offset = kLens ? hn::Set(d, active.offset[k][r]) : hn::Zero(d);
                const VF enter = kLens ? hn::MulSub(from, inverse, offset) : hn::Mul(from, inverse);
                const VF leave = kLens ? hn::MulSub(to, inverse, offset) : hn::Mul(to, inverse);
                near = hn::Max(near, hn::Min(enter, leave)), far = hn::Min(far, hn::Max(enter, leave));
            }
            met |= mask_bits(hn::And(hn::Le(near, far), hn::FirstN(d, count - b))) << b;
        }
        any |= met;
        for (; met != 0; met &= met - 1)
            t.scratch.met[static_cast<size_t>(std::countr_zero(met)) * kMetStride] |=
                static_cast<uint8_t>(1u << r);
    }
    return any;
}

/// Finds which active rays meet which boxes of a grid in a segment: in scratch.met a row for each box, a bit
/// for each ray. Gives a bit for each box that any ray meets.
template <bool kMotion, bool kLens>
uint32_t meet_boxes(BundleState& t, const WideGrid& grid, int segment, int boxes) {
    decode_boxes<kMotion>(t.tree, grid, segment, t.scratch.oriented, t.scratch.boxes);
    const float* planes = t.scratch.boxes.values;
    const size_t count = t.scratch.active.count;
    t.stats.nodes_visited += count * static_cast<size_t>(boxes);
    return count <= kFewInGrid ? meet_boxes_each<kMotion, kLens>(t, planes, boxes)
                               : meet_boxes_in_turn<kMotion, kLens>(t, planes, boxes);
}

/// What meet_boxes() does where the only box is the grid's own, which active rays are known to meet: sets all
/// bits.
inline uint32_t meet_only_box(BundleState& t) {
    constexpr uint8_t kAll = (1u << kLanesOfByte) - 1;
    const size_t count = t.scratch.active.count, whole = count / kLanesOfByte;
    std::memset(t.scratch.met, kAll, whole);
    std::memset(t.scratch.met + whole, 0, kMaskBytes + 1);
    t.scratch.met[whole] = static_cast<uint8_t>((1u << count % kLanesOfByte) - 1);
    return 1;
}

/// Lists, of `candidates` active rays whose bits are set in the row of a block's box, those that do not pass
/// the block by, in scratch.block; how many. `rounding`: what the block's bounds grow by.
template <bool kMotion, bool kLens>
size_t collect_block(BundleState& t, const SegmentBlock& block, const uint8_t* met, size_t candidates,
                     float rounding) {
    const F32 d;
    const hn::RebindToUnsigned<F32> du;
    const ActiveRays& active = t.scratch.active;
    BlockRays& to = t.scratch.block;
    BlockSlabs slabs;
    const bool has_slabs = candidates >= kFewForSlabs && slabs_of<kMotion>(block.view, rounding, slabs);
    if (has_slabs) t.stats.nodes_visited += candidates;
    size_t count = 0;
    for (size_t i = 0; i < active.count; i += kLanes, met += kMaskBytes) {
        uint32_t bits = 0;
        std::memcpy(&bits, met, kMaskBytes);
        if (bits == 0) continue;
        MF here = hn::LoadMaskBits(d, met);
        RayLanes r;
        if constexpr (kLens) r.ox = hn::Load(d, active.ox + i), r.oy = hn::Load(d, active.oy + i);
        r.ux = hn::Load(d, active.ux + i), r.uy = hn::Load(d, active.uy + i);
        if constexpr (kMotion) r.local = hn::Load(d, active.local + i);
        if (has_slabs) {
            here = hn::AndNot(misses<kMotion, kLens>(slabs, r), here);
            bits = mask_bits(here);
            if (bits == 0) continue;
        }
        const CompactLanes compact(here);
        if constexpr (kLens) compact.store(r.ox, to.ox + count), compact.store(r.oy, to.oy + count);
        compact.store(r.ux, to.ux + count), compact.store(r.uy, to.uy + count);
        if constexpr (kMotion) compact.store(r.local, to.local + count);
        compact.store(lane_numbers(du, static_cast<uint32_t>(i)), to.active + count);
        count += static_cast<size_t>(std::popcount(bits));
    }
    return count;
}

/// The largest |coordinate| of a box at any of its times.
inline float absolute_max(const MovingBox& box) {
    float most = 0;
    for (int k = 0; k < 3; ++k)
        for (const float at :
             {box.low[k], box.high[k], box.low[k] + box.low_delta[k], box.high[k] + box.high_delta[k]})
            most = std::max(most, std::abs(at));
    return most;
}

static_assert(BundleScratch::kMostWaiting + 16 * (kFewInBlock - 1) <= BundleScratch::kWaitingRoom);

/// Lets the few active rays whose bits are set in a row of meet_boxes() wait for a block, whose vertices are
/// fetched meanwhile: waiting for them would take longer than the tests.
template <bool kMotion>
void let_wait(BundleState& t, const WaitingRay& common, const SegmentBlock& block, const uint8_t* met) {
    const ActiveRays& active = t.scratch.active;
    fetch_block(block, kMotion ? 6 : 3);
    for (uint32_t first = 0; first < active.count; first += kLanesOfByte, ++met)
        for (uint32_t bits = *met; bits != 0; bits &= bits - 1) {
            const uint32_t a = first + static_cast<uint32_t>(std::countr_zero(bits));
            WaitingRay& ray = t.scratch.waiting[t.scratch.waiting_count++];
            ray = common;
            ray.ray = active.ray[a];
            if constexpr (kMotion) ray.local = active.local[a];
        }
}

/// Tests all rays that wait, but for those that have come to see something nearer meanwhile; then none waits.
template <bool kMotion>
void test_waiting(BundleState& t) {
    size_t nearer = 0;
    for (size_t i = 0; i < t.scratch.waiting_count; ++i) {
        const WaitingRay& waiting = t.scratch.waiting[i];
        if (waiting.depth > t.rays.depth[waiting.ray]) continue;
        const WideGrid& grid = t.tree.grid(waiting.grid);
        const SegmentBlock block = block_of(grid, waiting.segment, waiting.u, waiting.v, waiting.grid);
        count_block_tests(t, block, 1);
        if (t.rays.tests) count_tests_of(t, block, waiting.ray);
        bool found;
        if (kMotion && grid.moves())
            found = test_one_ray<kMotion>(t, block, waiting.ray, waiting.local);
        else
            found = test_one_ray<false>(t, block, waiting.ray, 0);
        t.scratch.nearer[nearer] = static_cast<uint32_t>(waiting.ray / kLanes);
        nearer += found;
    }
    t.scratch.waiting_count = 0;
    // Not at once: vectors cannot be loaded while a depth in them is on its way to memory.
    for (size_t i = 0; i < nearer; ++i) t.refresh_packet(t.scratch.nearer[i]);
    if (nearer != 0) t.refresh_farthest();
}

/// Tests the active rays of a grid in a segment. `whole`: its box in camera space. Blocks that few rays may
/// meet let them wait; the packets of tested rays then look less far, if the grid is opaque or layers have
/// ended.
template <bool kMotion, bool kLens>
void test_active(BundleState& t, const Candidate& candidate, const MovingBox& whole, const WideGrid& grid,
                 int segment) {
    const uint32_t index = candidate.grid;
    const ActiveRays& active = t.scratch.active;
    if (active.count == 0) return;
    const int boxes = grid.box_count(), blocks_u = grid.blocks_u(), per_box = grid.blocks_per_box();
    uint32_t some = boxes == 1 ? meet_only_box(t) : meet_boxes<kMotion, kLens>(t, grid, segment, boxes);
    const float rounding = t.tree.rounding(absolute_max(whole));
    const size_t bytes = (active.count + kLanes - 1) / kLanes * kMaskBytes;
    bool tested = false;
    for (; some != 0; some &= some - 1) {
        const int box = std::countr_zero(some), last = std::min((box + 1) * per_box, grid.block_count());
        // Blocks that share a box share its row of rays.
        const uint8_t* met = t.scratch.met + static_cast<size_t>(box) * kMetStride;
        const size_t candidates = count_bits(met, bytes);
        for (int b = box * per_box; b < last; ++b) {
            const int u = b % blocks_u, v = b / blocks_u;
            const SegmentBlock block = block_of(grid, segment, u, v, index);
            if (candidates < kFewInBlock) {
                let_wait<kMotion>(t,
                                  {0, index, 0, candidate.depth, static_cast<uint16_t>(segment),
                                   static_cast<uint8_t>(u), static_cast<uint8_t>(v)},
                                  block, met);
                continue;
            }
            const size_t count = collect_block<kMotion, kLens>(t, block, met, candidates, rounding);
            if (count != 0) test_block_rays<kMotion, kLens>(t, block, count);
            tested = true;
        }
    }
    // Rays that only wait have changed nothing; test_waiting() refreshes the packets of those.
    if (!tested || !(grid.opaque || t.layers_ended)) return;
    t.layers_ended = false;
    for (size_t i = 0; i < t.scratch.touched_count; ++i) t.refresh_packet(t.scratch.touched[i]);
    t.refresh_farthest();
}

}  // namespace HWY_NAMESPACE
}  // namespace trapeze
HWY_AFTER_NAMESPACE();

#endif  // per-target include guard
