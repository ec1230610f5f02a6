/// Moves the lanes of vectors where a mask is true to their front. Highway's Compress does that, but without
/// AVX-512 GCC copies its tables to the stack for every vector, which took two thirds of all time. Compiled
/// once a target.
#ifndef TRAPEZE_ACCEL_COMPACT_LANES_TABLE
#define TRAPEZE_ACCEL_COMPACT_LANES_TABLE

#include <array>
#include <cstdint>

namespace trapeze {

/// For every mask of 8 lanes: the lanes that are set, in order; then zeros.
inline constexpr auto kLanesOfMask = [] {
    std::array<std::array<uint8_t, 8>, 256> table{};
    for (size_t mask = 0; mask < table.size(); ++mask) {
        size_t count = 0;
        for (uint8_t lane = 0; lane < 8; ++lane)
            if (mask >> lane & 1) table[mask][count++] = lane;
    }
    return table;
}();

/// For every mask of 4 lanes: the bytes of the lanes that are set, in order.
inline constexpr auto kBytesOfMask = [] {
    std::array<std::array<uint8_t, 16>, 16> table{};
    for (size_t mask = 0; mask < table.size(); ++mask)
        for (size_t byte = 0; byte < 16; ++byte)
            table[mask][byte] = static_cast<uint8_t>(4 * kLanesOfMask[mask][byte / 4] + byte % 4);
    return table;
}();

}  // namespace trapeze
#endif

#if defined(TRAPEZE_ACCEL_COMPACT_LANES_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef TRAPEZE_ACCEL_COMPACT_LANES_INL_H_
#undef TRAPEZE_ACCEL_COMPACT_LANES_INL_H_
#else
#define TRAPEZE_ACCEL_COMPACT_LANES_INL_H_
#endif

#include <hwy/highway.h>

#include "accel/wide/block_hits-inl.h"

HWY_BEFORE_NAMESPACE();
namespace trapeze {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

/// A mask made ready once for compacting any number of vectors. Whole vectors are written; what is behind the
/// lanes of the mask means nothing, so that lists need room for a vector past their end.
class CompactLanes {
  public:
    using VU = hn::Vec<hn::RebindToUnsigned<F32>>;

#if HWY_TARGET == HWY_AVX2
    explicit CompactLanes(MF mask)
        : order_(_mm256_cvtepu8_epi32(_mm_loadl_epi64(reinterpret_cast<const __m128i*>(
              kLanesOfMask[static_cast<size_t>(_mm256_movemask_ps(mask.raw))].data())))) {}
    HWY_INLINE void store(VF v, float* to) const {
        _mm256_storeu_ps(to, _mm256_permutevar8x32_ps(v.raw, order_));
    }
    HWY_INLINE void store(VU v, uint32_t* to) const {
        _mm256_storeu_si256(reinterpret_cast<__m256i*>(to), _mm256_permutevar8x32_epi32(v.raw, order_));
    }

  private:
    __m256i order_;
#elif HWY_TARGET == HWY_SSE4
    explicit CompactLanes(MF mask)
        : order_(_mm_loadu_si128(reinterpret_cast<const __m128i*>(
              kBytesOfMask[static_cast<size_t>(_mm_movemask_ps(mask.raw))].data()))) {}
    HWY_INLINE void store(VF v, float* to) const {
        store(hn::BitCast(hn::RebindToUnsigned<F32>(), v), reinterpret_cast<uint32_t*>(to));
    }
    HWY_INLINE void store(VU v, uint32_t* to) const {
        _mm_storeu_si128(reinterpret_cast<__m128i*>(to), _mm_shuffle_epi8(v.raw, order_));
    }

  private:
    __m128i order_;
#else
    explicit CompactLanes(MF mask) : mask_(mask) {}
    HWY_INLINE void store(VF v, float* to) const {
        hn::StoreU(hn::Compress(v, mask_), F32(), to);
    }
    HWY_INLINE void store(VU v, uint32_t* to) const {
        const hn::RebindToUnsigned<F32> du;
        hn::StoreU(hn::Compress(v, hn::RebindMask(du, mask_)), du, to);
    }

  private:
    MF mask_;
#endif
};

}  // namespace HWY_NAMESPACE
}  // namespace trapeze
HWY_AFTER_NAMESPACE();

#endif  // per-target include guard
