/// Cheap operations by component.
#include "shade/vm/kernels/families.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "shade/vm/kernels/arithmetic.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "shade/vm/kernels/operands-inl.h"

HWY_BEFORE_NAMESPACE();
namespace trapeze::vm::HWY_NAMESPACE {
namespace {

using rsl::Op;

HWY_INLINE V add(V a, V b) {
    return hn::Add(a, b);
}
HWY_INLINE V subtract(V a, V b) {
    return hn::Sub(a, b);
}
HWY_INLINE V multiply(V a, V b) {
    return hn::Mul(a, b);
}

/// Division by 0 gives infinity or NaN, as floats have it: RISpec leaves it open, and shaders test for it
/// themselves.
HWY_INLINE V divide(V a, V b) {
    return hn::Div(a, b);
}
HWY_INLINE V negate(V a) {
    return hn::Neg(a);
}
/// 0 for negative numbers, where RISpec leaves it open: NaN would spread over the picture.
HWY_INLINE V square_root(V x) {
    return hn::Sqrt(positive(x));
}
/// Finite for all x: 0 and less count as the least normal float. Divided, since approximate reciprocal roots
/// differ between processors.
HWY_INLINE V inverse_square_root(V x) {
    return hn::Div(set(1), hn::Sqrt(at_least(x, set(kLeastNormal))));
}
HWY_INLINE V absolute(V x) {
    return hn::Abs(x);
}
/// 1, -1, or 0 for 0 and NaN.
HWY_INLINE V sign(V x) {
    const V zero = hn::Zero(D());
    return hn::Sub(hn::IfThenElseZero(hn::Gt(x, zero), set(1)), hn::IfThenElseZero(hn::Lt(x, zero), set(1)));
}

/// The sign of x survives in a zero, as in floor_of(): targets must agree in every bit.
HWY_INLINE V ceil_of(V x) {
    return hn::CopySign(hn::Ceil(x), x);
}
/// Halves go up.
HWY_INLINE V round_of(V x) {
    const V low = floor_of(x);
    return hn::Add(low, hn::IfThenElseZero(hn::Ge(hn::Sub(x, low), set(0.5f)), set(1)));
}
/// In [0, b), or (b, 0] for negative b, also where a / b rounds to a whole number; 0 for b = 0. The sign is
/// that of b, unlike that of C's fmod().
HWY_INLINE V mod(V a, V b) {
    const V zero = hn::Zero(D());
    const V rest = hn::Sub(a, hn::Mul(b, floor_of(hn::Div(a, b))));
    // a / b may have been rounded up to a whole number: the rest is then beyond 0 by a rounding.
    const M past = hn::Lt(hn::Mul(hn::CopySign(set(1), b), rest), zero);
    const V inside = hn::Add(rest, hn::IfThenElseZero(past, b));
    return hn::IfThenZeroElse(hn::Or(hn::Eq(b, zero), hn::Eq(inside, b)), inside);
}

/// Written with comparisons, since Highway's Min() and Max() treat NaN in different ways on different
/// targets.
HWY_INLINE V least(V a, V b) {
    return at_most(a, b);
}
HWY_INLINE V most(V a, V b) {
    return at_least(a, b);
}
/// 0 where x < edge, else 1, at the edge itself too.
HWY_INLINE V step_at(V edge, V x) {
    return hn::IfThenZeroElse(hn::Lt(x, edge), set(1));
}
/// The lower bound is looked at first, where bounds are the wrong way round (RISpec 3.2, section 15.1).
HWY_INLINE V clamp(V x, V low, V high) {
    return hn::IfThenElse(hn::Ge(x, low), at_most(x, high), low);
}
/// (1 - t) a + t b as RISpec writes it, which for t = 1 gives b exactly.
HWY_INLINE V mix(V a, V b, V t) {
    return hn::Add(hn::Mul(a, hn::Sub(set(1), t)), hn::Mul(b, t));
}
/// Bounds that are equal or the wrong way round make a step at the lower one; the quotient, which is then no
/// number, is not taken.
HWY_INLINE V smooth_step(V low, V high, V x) {
    const V t = at_most(positive(hn::Div(hn::Sub(x, low), hn::Sub(high, low))), set(1));
    const V smooth = hn::Mul(hn::Mul(t, t), hn::Sub(set(3), hn::Add(t, t)));
    return hn::IfThenElse(hn::Lt(low, high), smooth, step_at(low, x));
}

/// out = function(... function(first, second) ..., last). min() and max() of RISpec take any number of
/// arguments. The result is kept in vectors until all inputs of the lane group have been read, for the output
/// may be one of them.
template <auto function, int width>
void fold(size_t lanes, Operands o) {
    const Output out(o[0]);
    for (size_t i = 0; i < lanes; i += lane_count()) {
        V result[width];
        for (int k = 0; k < width; ++k) result[k] = Input(o[1]).get(i, k);
        for (const Operand& other : o.subspan(2))
            for (int k = 0; k < width; ++k) result[k] = function(result[k], Input(other).get(i, k));
        for (int k = 0; k < width; ++k) out.put(result[k], i, k);
    }
}

/// The kernel of two inputs by component, or of more, as min() and max() have them.
template <auto function>
Kernel fold_kernel(std::span<const int> widths) {
    if (widths.size() == 3) return component_kernel<function>(widths);
    if (widths.size() < 2) return nullptr;
    return widths[0] == 1 ? fold<function, 1> : widths[0] == 3 ? fold<function, 3> : nullptr;
}

/// c ? a : b, without a branch: the condition is a mask.
template <int width>
void select(size_t lanes, Operands o) {
    const Output out(o[0]);
    const Input mask(o[1]), a(o[2]), b(o[3]);
    for (size_t i = 0; i < lanes; i += lane_count()) {
        const M chosen = mask.mask(i);
        V result[width];
        for (int k = 0; k < width; ++k) result[k] = hn::IfThenElse(chosen, a.get(i, k), b.get(i, k));
        for (int k = 0; k < width; ++k) out.put(result[k], i, k);
    }
}

/// A float as a matrix (RISpec 3.2, section 11).
void scaled_identity(size_t lanes, Operands o) {
    const Output out(o[0]);
    const Input in(o[1]);
    for (size_t i = 0; i < lanes; i += lane_count()) {
        const V value = in.get(i);
        for (int k = 0; k < 16; ++k) out.put(k % 5 == 0 ? value : hn::Zero(D()), i, k);
    }
}

/// Copies of 1, 3 or 16 components, and the conversions that a width implies: a float fills a triple, and
/// makes a scaled identity of a matrix.
Kernel find_move(std::span<const int> widths) {
    if (are(widths, {16, 1})) return scaled_identity;
    if (are(widths, {16, 16})) return by_component<same, 16>;
    return component_kernel<same>(widths);
}

/// One mask chooses whole triples and matrices.
Kernel find_select(std::span<const int> widths) {
    if (widths.size() != 4) return nullptr;
    return widths[0] == 1 ? select<1> : widths[0] == 3 ? select<3> : widths[0] == 16 ? select<16> : nullptr;
}

/// Chooses the kernel of a sum, a difference or a negation: floats and triples as all component kernels take
/// them, and matrices component by component.
template <auto function>
Kernel sum_kernel(std::span<const int> widths) {
    if (!widths.empty() && std::count(widths.begin(), widths.end(), 16) == std::ssize(widths) &&
        widths.size() == inputs_of(function).size() + 1)
        return by_component<function, 16>;
    return component_kernel<function>(widths);
}

constexpr KernelRow kRows[] = {
    {Op::Move, find_move},
    {Op::Select, find_select},
    {Op::Add, sum_kernel<static_cast<V (*)(V, V)>(add)>},
    {Op::Subtract, sum_kernel<static_cast<V (*)(V, V)>(subtract)>},
    {Op::Negate, sum_kernel<negate>},
    {Op::Multiply, component_kernel<multiply>},
    {Op::Divide, component_kernel<divide>},
    {Op::Sqrt, component_kernel<square_root>},
    {Op::InverseSqrt, component_kernel<inverse_square_root>},
    {Op::Abs, component_kernel<absolute>},
    {Op::Sign, component_kernel<sign>},
    {Op::Floor, component_kernel<floor_of>},
    {Op::Ceil, component_kernel<ceil_of>},
    {Op::Round, component_kernel<round_of>},
    {Op::Mod, component_kernel<mod>},
    {Op::Min, fold_kernel<least>},
    {Op::Max, fold_kernel<most>},
    {Op::Step, component_kernel<step_at>},
    {Op::Clamp, component_kernel<clamp>},
    {Op::Mix, component_kernel<mix>},
    {Op::SmoothStep, component_kernel<smooth_step>},
};

Kernel find_arithmetic(Op op, std::span<const int> widths) {
    return kernel_in(kRows, op, widths);
}

}  // namespace
}  // namespace trapeze::vm::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
TRAPEZE_KERNEL_FAMILY(find_arithmetic)
#endif
