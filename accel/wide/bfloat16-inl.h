/// Lanes of from_bfloat16() (accel/wide/bfloat16.h). Compiled once a target.
#if defined(TRAPEZE_ACCEL_BFLOAT16_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef TRAPEZE_ACCEL_BFLOAT16_INL_H_
#undef TRAPEZE_ACCEL_BFLOAT16_INL_H_
#else
#define TRAPEZE_ACCEL_BFLOAT16_INL_H_
#endif

#include <hwy/highway.h>

#include <cstdint>

HWY_BEFORE_NAMESPACE();
namespace trapeze {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

/// A vector of floats from aligned bfloat16: their bits are the upper half.
template <class D>
HWY_INLINE hn::Vec<D> from_bfloat16(D d, const uint16_t* at) {
    const hn::Rebind<uint16_t, D> d16;
    const hn::Rebind<uint32_t, D> d32;
    return hn::BitCast(d, hn::ShiftLeft<16>(hn::PromoteTo(d32, hn::Load(d16, at))));
}

}  // namespace HWY_NAMESPACE
}  // namespace trapeze
HWY_AFTER_NAMESPACE();

#endif  // per-target include guard
