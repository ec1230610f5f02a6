/// The rays listed for a block (BlockRays) against its micropolygons: first all at once by signs of edges,
/// then the depth of those rays that hit one; rays that hit several, seldom, one by one. Compiled once a
/// target.
#if defined(TRAPEZE_ACCEL_BLOCK_TESTS_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef TRAPEZE_ACCEL_BLOCK_TESTS_INL_H_
#undef TRAPEZE_ACCEL_BLOCK_TESTS_INL_H_
#else
#define TRAPEZE_ACCEL_BLOCK_TESTS_INL_H_
#endif

#include <hwy/highway.h>

#include <bit>

#include "accel/wide/bundle_state-inl.h"
#include "accel/wide/whole_block-inl.h"
#include "core/simd/simd-inl.h"

HWY_BEFORE_NAMESPACE();
namespace trapeze {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

/// Fewer rays than this are tested one by one, lanes being micropolygons.
inline constexpr size_t kFewInBlock = 5;

/// Keeps the hits of a vector of block rays, those from `first` on, that are within the depths that count.
/// `hit`: lanes that hit micropolygon (u, v) of the block at `depth`.
inline void keep_hits(BundleState& t, const SegmentBlock& block, size_t first, MF hit, VI u, VI v, VF depth) {
    const F32 d;
    const I32 di;
    hit =
        hn::And(hit, hn::And(hn::Ge(depth, hn::Set(d, t.range.min)), hn::Le(depth, hn::Set(d, t.range.max))));
    uint32_t lanes = mask_bits(hit);
    if (lanes == 0) return;
    HWY_ALIGN float depths[kLanes];
    HWY_ALIGN int32_t uv[kLanes];
    hn::Store(depth, d, depths);
    // As in MicropolygonId::packed(): added to the id of the block's first, whose u and v are multiples of
    // four.
    hn::Store(hn::Or(u, hn::ShiftLeft<4>(v)), di, uv);
    for (; lanes != 0; lanes &= lanes - 1) {
        const auto lane = static_cast<size_t>(std::countr_zero(lanes));
        t.keep_hit(t.scratch.active.ray[t.scratch.block.active[first + lane]], depths[lane],
                   block.id + static_cast<uint32_t>(uv[lane]), block.opaque);
    }
}

/// Tests one ray, at a time local to the block's segment, against all micropolygons of a block: lanes are
/// micropolygons. Whether the ray looks less far now.
template <bool kMotion>
bool test_one_ray(BundleState& t, const SegmentBlock& block, uint32_t ray, float local) {
    BlockRay at;
    at.axis = {t.rays.ox[ray], t.rays.oy[ray], 0, t.rays.ux[ray], t.rays.uy[ray], 0};
    at.local = local;
    bool nearer = false;
    for (int m = 0; m < 4 * block.view.rows; m += static_cast<int>(kLanes)) {
        VF depth;
        uint32_t lanes = hit_micropolygons<kMotion>(block.view, block.columns, block.facing, m, at, depth);
        if (lanes == 0) continue;
        HWY_ALIGN float depths[kLanes];
        hn::Store(depth, F32(), depths);
        for (; lanes != 0; lanes &= lanes - 1) {
            const int lane = std::countr_zero(lanes), micropolygon = m + lane;
            if (!(depths[lane] >= t.range.min && depths[lane] <= t.range.max)) continue;
            const auto uv = static_cast<uint32_t>((micropolygon & 3) | micropolygon >> 2 << 4);
            nearer |= t.keep_hit(ray, depths[lane], block.id + uv, block.opaque);
        }
    }
    return nearer;
}

/// Counts what `rays` rays cost that meet a block: a leaf each, and its micropolygons.
inline void count_block_tests(BundleState& t, const SegmentBlock& block, size_t rays) {
    t.stats.leaves_visited += rays;
    t.stats.predicate_tests += rays * static_cast<uint64_t>(block.view.rows * block.columns);
}
/// Adds a block's tests to one ray's own costs.
inline void count_tests_of(BundleState& t, const SegmentBlock& block, uint32_t ray) {
    t.rays.tests[ray] += static_cast<uint32_t>(block.view.rows * block.columns);
}

/// Tests the first `count` of the rays listed for a block and keeps what they hit.
template <bool kMotion, bool kLens>
void test_block_rays(BundleState& t, const SegmentBlock& block, size_t count) {
    const F32 d;
    const BlockRays& from = t.scratch.block;
    count_block_tests(t, block, count);
    if (t.rays.tests)
        for (size_t i = 0; i < count; ++i) count_tests_of(t, block, t.scratch.active.ray[from.active[i]]);
    const auto test_one = [&](size_t i) HWY_ATTR {
        test_one_ray<kMotion>(t, block, t.scratch.active.ray[from.active[i]], kMotion ? from.local[i] : 0.0f);
    };
    for (size_t i = 0; i < count; i += kLanes) {
        const size_t left = count - i;
        if (left < kFewInBlock) {
            for (size_t k = i; k < count; ++k) test_one(k);
            return;
        }
        RayLanes r;
        if constexpr (kLens) r.ox = hn::Load(d, from.ox + i), r.oy = hn::Load(d, from.oy + i);
        r.ux = hn::Load(d, from.ux + i), r.uy = hn::Load(d, from.uy + i);
        if constexpr (kMotion) r.local = hn::Load(d, from.local + i);
        // Lanes past `count` hold whatever an earlier list left, and `valid` takes their answers away.
        const BlockBits bits = block.columns == 1 ? block_bits<kMotion, kLens, 1>(block.view, r)
                                                  : block_bits<kMotion, kLens, 4>(block.view, r);
        const MF valid = hn::FirstN(d, left);
        const MF any = hn::And(predicate_lanes::negative(d, bits.any), valid);
        if (hn::AllFalse(d, any)) continue;
        const MF several = hn::And(predicate_lanes::negative(d, bits.several), valid);
        VI u, v;
        decode(bits, u, v);
        VF depth = hn::Zero(d);
        const MF faces = depth_inside(d, quads_at<kMotion, kLens>(block.view, r, u, v), block.facing, depth);
        const MF hit = hn::AndNot(several, hn::And(any, faces));
        keep_hits(t, block, i, hit, u, v, depth);
        for (uint32_t more = mask_bits(several); more != 0; more &= more - 1)
            test_one(i + static_cast<size_t>(std::countr_zero(more)));
    }
}

}  // namespace HWY_NAMESPACE
}  // namespace trapeze
HWY_AFTER_NAMESPACE();

#endif  // per-target include guard
