/// Numbers of consecutive lanes. Compiled once a target; see Highway's foreach_target.h.
#if defined(TRAPEZE_CORE_LANE_NUMBERS_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef TRAPEZE_CORE_LANE_NUMBERS_INL_H_
#undef TRAPEZE_CORE_LANE_NUMBERS_INL_H_
#else
#define TRAPEZE_CORE_LANE_NUMBERS_INL_H_
#endif

#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace trapeze {
namespace HWY_NAMESPACE {

/// first, first + 1 and so on. Early Highway's Iota() from a number that is not known to the compiler stores
/// it lane by lane and loads the vector, which waits for all of the stores.
template <class D>
HWY_INLINE hwy::HWY_NAMESPACE::Vec<D> lane_numbers(D d, hwy::HWY_NAMESPACE::TFromD<D> first) {
    namespace hn = hwy::HWY_NAMESPACE;
    return hn::Add(hn::Iota(d, 0), hn::Set(d, first));
}

}  // namespace HWY_NAMESPACE
}  // namespace trapeze
HWY_AFTER_NAMESPACE();

#endif  // per-target include guard
