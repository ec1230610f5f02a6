/// Comparisons and operations on lane masks. A Bool is all bits or none, so that And, Or and Not are those of
/// bits, and Select and MaskStack take it as it is.
#include "shade/vm/kernels/families.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "shade/vm/kernels/bools.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "shade/vm/kernels/operands-inl.h"

HWY_BEFORE_NAMESPACE();
namespace trapeze::vm::HWY_NAMESPACE {
namespace {

using rsl::Op;

// Comparisons with NaN are false, but for NotEqual.
HWY_INLINE V less(V a, V b) {
    return hn::VecFromMask(D(), hn::Lt(a, b));
}
HWY_INLINE V less_equal(V a, V b) {
    return hn::VecFromMask(D(), hn::Le(a, b));
}
HWY_INLINE V greater(V a, V b) {
    return hn::VecFromMask(D(), hn::Gt(a, b));
}
HWY_INLINE V greater_equal(V a, V b) {
    return hn::VecFromMask(D(), hn::Ge(a, b));
}
HWY_INLINE V both(V a, V b) {
    return hn::And(a, b);
}
HWY_INLINE V either(V a, V b) {
    return hn::Or(a, b);
}
HWY_INLINE V complement(V a) {
    return hn::Not(a);
}
/// True of NaN, which Ne() is not on every target.
HWY_INLINE V to_bool(V a) {
    return hn::VecFromMask(D(), hn::Not(hn::Eq(a, hn::Zero(D()))));
}
/// 1 where all bits are set, 0 where none: And with the bits of 1.
HWY_INLINE V to_float(V a) {
    return hn::And(a, set(1));
}

/// Whether all components are equal; when negated, whether any is not. NaN equals nothing, as everywhere in
/// C.
template <int width, bool negated>
void equal(size_t lanes, Operands o) {
    const Output out(o[0]);
    const Input a(o[1]), b(o[2]);
    for (size_t i = 0; i < lanes; i += lane_count()) {
        M same = hn::Eq(a.get(i), b.get(i));
        for (int k = 1; k < width; ++k) same = hn::And(same, hn::Eq(a.get(i, k), b.get(i, k)));
        out.put_mask(negated ? hn::Not(same) : same, i);
    }
}

/// A float beside a triple or matrix is compared with each of its components. A float's stride of 0 makes
/// Input::get() return its one component for every k.
template <bool negated>
Kernel find_equal(std::span<const int> widths) {
    if (widths.size() != 3) return nullptr;
    const int width = std::max(widths[1], widths[2]);
    if (std::min(widths[1], widths[2]) < 1) return nullptr;
    return width == 1    ? equal<1, negated>
           : width == 3  ? equal<3, negated>
           : width == 16 ? equal<16, negated>
                         : nullptr;
}

/// Operations whose operands are all of width 1.
template <auto function>
Kernel float_kernel(std::span<const int> widths) {
    const bool floats = std::count(widths.begin(), widths.end(), 1) == std::ssize(widths);
    return floats && widths.size() == inputs_of(function).size() + 1 ? by_component<function, 1> : nullptr;
}

constexpr KernelRow kRows[] = {
    {Op::Less, float_kernel<less>},        {Op::LessEqual, float_kernel<less_equal>},
    {Op::Greater, float_kernel<greater>},  {Op::GreaterEqual, float_kernel<greater_equal>},
    {Op::Equal, find_equal<false>},        {Op::NotEqual, find_equal<true>},
    {Op::And, float_kernel<both>},         {Op::Or, float_kernel<either>},
    {Op::Not, float_kernel<complement>},   {Op::ToBool, float_kernel<to_bool>},
    {Op::ToFloat, float_kernel<to_float>},
};

Kernel find_bools(Op op, std::span<const int> widths) {
    return kernel_in(kRows, op, widths);
}

}  // namespace
}  // namespace trapeze::vm::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
TRAPEZE_KERNEL_FAMILY(find_bools)
#endif
