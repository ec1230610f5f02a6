/// What vector code of several rooms needs besides Highway: numbers of lanes, masks as bits, times in motion
/// segments. Compiled once a target; see Highway's foreach_target.h.
#if defined(TRAPEZE_CORE_SIMD_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef TRAPEZE_CORE_SIMD_INL_H_
#undef TRAPEZE_CORE_SIMD_INL_H_
#else
#define TRAPEZE_CORE_SIMD_INL_H_
#endif

#include <hwy/highway.h>

#include <cstdint>

HWY_BEFORE_NAMESPACE();
namespace trapeze {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

/// The lanes first, first + 1 and so on. Highway's own Iota() from a number that the compiler does not know
/// stores it lane by lane, in early versions, and loads the vector, which waits for all of the stores.
template <class D>
HWY_INLINE hn::Vec<D> lane_numbers(D d, hn::TFromD<D> first) {
    return hn::Add(hn::Iota(d, 0), hn::Set(d, first));
}

/// A mask as bits of an integer, lane 0 the lowest; for vectors of at most 16 lanes, which all targets'
/// floats keep to.
template <class D>
HWY_INLINE uint32_t mask_bits(D d, hn::Mask<D> mask) {
#if HWY_TARGET <= HWY_AVX3 && HWY_ARCH_X86
    // By way of bytes compilers make six instructions of it.
    return static_cast<uint32_t>(mask.raw) & ((1u << hn::MaxLanes(d)) - 1);
#else
    uint8_t bytes[8] = {};
    hn::StoreMaskBits(d, mask, bytes);
    return bytes[0] | static_cast<uint32_t>(bytes[1]) << 8;
#endif
}

/// The inverse of mask_bits().
template <class D>
HWY_INLINE hn::Mask<D> mask_of(D d, uint32_t bits) {
    const uint8_t bytes[8] = {static_cast<uint8_t>(bits), static_cast<uint8_t>(bits >> 8)};
    return hn::LoadMaskBits(d, bytes);
}

/// Lanes in motion segments, as MotionSegment (core/motion_keys.h).
template <class D>
struct SegmentLanes {
    hn::Vec<hn::RebindToSigned<D>> index;
    hn::Vec<D> local;  ///< in [0, 1] of the segment
};

/// segment_at() in lanes, bit for bit, for times of the shutter; only segments from `first` to `last` count.
template <class D>
HWY_INLINE SegmentLanes<D> segments_at(D d, hn::Vec<D> time, int key_count, int first, int last) {
    const hn::RebindToSigned<D> di;
    const auto scaled = hn::Mul(time, hn::Set(d, static_cast<float>(key_count - 1)));
    const auto index = hn::Min(hn::Max(hn::ConvertTo(di, scaled), hn::Set(di, first)), hn::Set(di, last));
    return {index, hn::Sub(scaled, hn::ConvertTo(d, index))};
}

/// segments_at() over all segments. With one key all times are in segment 0, at its start.
template <class D>
HWY_INLINE SegmentLanes<D> segments_at(D d, hn::Vec<D> time, int key_count) {
    return segments_at(d, time, key_count, 0, key_count > 2 ? key_count - 2 : 0);
}

}  // namespace HWY_NAMESPACE
}  // namespace trapeze
HWY_AFTER_NAMESPACE();

#endif  // per-target include guard
