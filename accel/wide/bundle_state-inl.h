/// What all stages of a bundle's tracing share: its state, hits kept. A packet is a vector of consecutive
/// rays, a group a few packets. Compiled once a target.
#if defined(TRAPEZE_ACCEL_BUNDLE_STATE_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef TRAPEZE_ACCEL_BUNDLE_STATE_INL_H_
#undef TRAPEZE_ACCEL_BUNDLE_STATE_INL_H_
#else
#define TRAPEZE_ACCEL_BUNDLE_STATE_INL_H_
#endif

#include <hwy/highway.h>

#include <algorithm>
#include <bit>
#include <cmath>

#include "accel/wide/block_hits-inl.h"
#include "accel/wide/bundle.h"
#include "accel/wide/bundle_scratch.h"
#include "core/simd/simd-inl.h"

HWY_BEFORE_NAMESPACE();
namespace trapeze {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

constexpr uint32_t kAllLanes = (1u << kLanes) - 1;
/// Bytes of a mask in memory, a bit a lane.
constexpr size_t kMaskBytes = (kLanes + 7) / 8;
constexpr uint32_t kLanesOfByte = kLanes < 8 ? kLanes : 8;  ///< of a mask as it is stored
constexpr size_t kMetStride = BundleScratch::kMetStride;

HWY_INLINE uint32_t mask_bits(MF mask) {
    return mask_bits(F32(), mask);
}
HWY_INLINE MF mask_of(uint32_t bits) {
    return mask_of(F32(), bits);
}

HWY_INLINE float largest(VF v) {
    return hn::GetLane(hn::MaxOfLanes(F32(), v));
}
HWY_INLINE float least(VF v) {
    return hn::GetLane(hn::MinOfLanes(F32(), v));
}

/// One bundle on its way through a tree: what is asked, and how far its rays still look.
struct BundleState {
    const WideTree& tree;
    DepthRange range;
    float inverse_focal;
    RayBundle& rays;
    BundleScratch& scratch;
    SampleStats& stats;
    float nearest_depth;  ///< no box before this depth matters
    size_t packets;
    /// Packets of a group: whole vectors of them, as kGroups groups at most divide the packets.
    size_t group_packets =
        (packets + kLanes * BundleScratch::kGroups - 1) / (kLanes * BundleScratch::kGroups) * kLanes;
    float first_time = 0, last_time = 0;
    float farthest_depth = 0;   ///< some ray still looks as far as this
    bool layers_ended = false;  ///< some ray looks less far for its layers, and its packet does not know yet

    size_t groups() const { return (packets + group_packets - 1) / group_packets; }

    /// Calls visit(first) for each vector of kLanes packets of some groups (a bit a group); the last vector
    /// may reach past the last packet, where intervals are repeated and nothing looks farther than minus
    /// infinity.
    template <class Visit>
    HWY_INLINE void for_packets(uint32_t some, const Visit& visit) const {
        for (; some != 0; some &= some - 1) {
            const size_t first = static_cast<size_t>(std::countr_zero(some)) * group_packets,
                         end = std::min(first + group_packets, packets);
            for (size_t p = first; p < end; p += kLanes) visit(p);
        }
    }

    /// Sets farthest[packet] to how far the farthest-looking of its rays looks: when hits have come nearer.
    void refresh_packet(size_t packet) {
        scratch.farthest[packet] = largest(hn::Load(F32(), rays.depth + packet * kLanes));
    }
    /// Sets farthest_depth from all packets.
    void refresh_farthest() {
        const F32 d;
        VF farthest = hn::Load(d, scratch.farthest);
        for (size_t p = kLanes; p < packets; p += kLanes)
            farthest = hn::Max(farthest, hn::Load(d, scratch.farthest + p));
        farthest_depth = largest(farthest);
    }

    /// Takes in a hit of a ray, within the depths that count: as its nearest, if opaque and in front of the
    /// one known (equal depths by id), or as a layer. Returns whether the ray looks less far now.
    HWY_INLINE bool keep_hit(uint32_t ray, float depth, uint32_t id, bool opaque) {
        ++stats.predicate_hits;
        float& nearest = rays.depth[ray];
        if (!opaque) return depth <= nearest && keep_layer(ray, {depth, id});
        if (!(depth < nearest || (depth == nearest && id < rays.id[ray]))) return false;
        nearest = depth;
        rays.id[ray] = id;
        return true;
    }

    /// Takes in a layer no farther than the ray looks. Returns whether the ray looks less far now.
    bool keep_layer(uint32_t ray, const BundleLayer& layer) {
        const LayerLists::Ended ended = rays.layers.add(ray, layer);
        if (ended == LayerLists::Ended::Many) {
            for (uint32_t i = 0; i < rays.count; ++i) look_to_end(i);
            for (size_t p = 0; p < packets; ++p) refresh_packet(p);
            refresh_farthest();
        }
        if (ended == LayerLists::Ended::None || !look_to_end(ray)) return false;
        layers_ended = true;
        return true;
    }
    /// Lets a ray look no farther than its layers go, which forgets an opaque hit behind them.
    bool look_to_end(uint32_t ray) {
        if (!rays.layers.has_end(ray) || !(rays.layers.end(ray).depth < rays.depth[ray])) return false;
        rays.depth[ray] = rays.layers.end(ray).depth;
        rays.id[ray] = RayBundle::kNone;
        return true;
    }
};

/// Adds to the costs of a packet's rays, the first of which is number `first`.
inline void count_packet(uint32_t* counts, size_t first, uint32_t count) {
    for (size_t i = 0; i < kLanes; ++i) counts[first + i] += count;
}

}  // namespace HWY_NAMESPACE
}  // namespace trapeze
HWY_AFTER_NAMESPACE();

#endif  // per-target include guard
