/// Comparisons and operations on lane masks.
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
HWY_INLINE V to_float(V a) {
    return hn::And(a, set(1));
}

/// Whether all components are equal; with `negate`, whether any is not.
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

Kernel find_bools(Op op, std::span<const int> widths) {
    switch (op) {
        case Op::Less:
            return float_kernel<less>(widths);
        case Op::LessEqual:
            return float_kernel<less_equal>(widths);
        case Op::Greater:
            return float_kernel<greater>(widths);
        case Op::GreaterEqual:
            return float_kernel<greater_equal>(widths);
        case Op::Equal:
            return find_equal<false>(widths);
        case Op::NotEqual:
            return find_equal<true>(widths);
        case Op::And:
            return float_kernel<both>(widths);
        case Op::Or:
            return float_kernel<either>(widths);
        case Op::Not:
            return float_kernel<complement>(widths);
        case Op::ToBool:
            return float_kernel<to_bool>(widths);
        case Op::ToFloat:
            return float_kernel<to_float>(widths);
        default:
            return nullptr;
    }
}

}  // namespace
}  // namespace trapeze::vm::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace trapeze::vm {

HWY_EXPORT(find_bools);

Kernel find_bools(rsl::Op op, std::span<const int> widths) {
    return HWY_DYNAMIC_DISPATCH(find_bools)(op, widths);
}

}  // namespace trapeze::vm
#endif
