/// The SIMD form of hit_micropolygon(): lanes are rays against one micropolygon, which may have moved to
/// another place for each. The same operations in the same order as the scalar form, none fused: equal bit
/// for bit, depth included. Compiled once a target; see Highway's foreach_target.h.
///
/// Vectors stay local variables, because targets of unknown vector length forbid anything else.
#if defined(TRAPEZE_CORE_HIT_MICROPOLYGON_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef TRAPEZE_CORE_HIT_MICROPOLYGON_INL_H_
#undef TRAPEZE_CORE_HIT_MICROPOLYGON_INL_H_
#else
#define TRAPEZE_CORE_HIT_MICROPOLYGON_INL_H_
#endif

#include <hwy/highway.h>

#include "core/hit_micropolygon.h"

HWY_BEFORE_NAMESPACE();
namespace trapeze {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

namespace predicate_lanes {

template <class V>
HWY_INLINE V edge(V ai, V bi, V aj, V bj) {
    return hn::Sub(hn::Mul(ai, bj), hn::Mul(aj, bi));
}

/// Where the sign bit of `chooser` is set, that of `yes`, else of `no`; other bits mean nothing.
template <class V>
HWY_INLINE V sign_chosen(V chooser, V yes, V no) {
#if HWY_TARGET <= HWY_AVX3
    return hn::IfVecThenElse(chooser, yes, no);  // bit by bit, in one instruction
#else
    return hn::Or(hn::And(chooser, yes), hn::AndNot(chooser, no));
#endif
}

/// crosses() of the scalar form, in the sign bits; the other bits mean nothing.
template <class V>
HWY_INLINE V crossing(V ai, V bi, V aj, V bj) {
    const V x = hn::Mul(ai, bj), y = hn::Mul(aj, bi);
    return hn::And(hn::Xor(bi, bj), sign_chosen(bj, hn::Sub(x, y), hn::Sub(y, x)));
}

/// Lanes whose sign bit is set.
template <class D, class V>
HWY_INLINE hn::Mask<D> negative(D d, V v) {
    const hn::RebindToSigned<D> di;
    return hn::RebindMask(d, hn::Lt(hn::BitCast(di, v), hn::Zero(di)));
}

/// std::min and std::max: the first argument of equals, and where one is NaN.
template <class V>
HWY_INLINE V min_of(V a, V b) {
    return hn::IfThenElse(hn::Lt(b, a), b, a);
}
template <class V>
HWY_INLINE V max_of(V a, V b) {
    return hn::IfThenElse(hn::Lt(a, b), b, a);
}

/// Where the sign of an edge function counts as negative on both or on neither.
template <class M>
HWY_INLINE M alike(M a, M b) {
    return hn::Not(hn::Xor(a, b));
}

}  // namespace predicate_lanes

/// Of lanes that pass a micropolygon, those that see a side that can be hit, and their depths. The corners
/// are moved along the rays to their plane (a, b), z is from before.
template <class D, class V>
HWY_INLINE hn::Mask<D> hit_depth(D d, V a00, V b00, V a10, V b10, V a01, V b01, V a11, V b11, V z00, V z10,
                                 V z01, V z11, Facing facing, hn::Mask<D> hit, V& depth) {
    namespace p = predicate_lanes;
    using M = hn::Mask<D>;
    const V zero = hn::Zero(d);
    const V c_bottom = p::edge(a00, b00, a10, b10), c_right = p::edge(a10, b10, a11, b11);
    const V c_top = p::edge(a11, b11, a01, b01), c_left = p::edge(a01, b01, a00, b00);
    if (facing != Facing::Both) {
        const V twice_area = hn::Add(hn::Add(c_bottom, c_right), hn::Add(c_top, c_left));
        hit = hn::And(hit,
                      facing == Facing::PositiveOnly ? hn::Ge(twice_area, zero) : hn::Lt(twice_area, zero));
    }
    const V c_diagonal = p::edge(a00, b00, a11, b11);
    const M bottom_below = hn::Lt(c_bottom, zero);
    const M lower = hn::And(p::alike(bottom_below, hn::Lt(c_right, zero)),
                            hn::Xor(bottom_below, hn::Lt(c_diagonal, zero)));
    const V w00 = hn::IfThenElse(lower, c_right, c_top),
            w10 = hn::IfThenElse(lower, hn::Neg(c_diagonal), zero);
    const V w01 = hn::IfThenElse(lower, zero, c_diagonal), w11 = hn::IfThenElse(lower, c_bottom, c_left);
    const V sum = hn::Add(hn::Add(w00, w10), hn::Add(w01, w11));
    const V weighted =
        hn::Add(hn::Add(hn::Mul(w00, z00), hn::Mul(w10, z10)), hn::Add(hn::Mul(w01, z01), hn::Mul(w11, z11)));
    const V z_min = p::min_of(p::min_of(z00, z10), p::min_of(z01, z11));
    const V z_max = p::max_of(p::max_of(z00, z10), p::max_of(z01, z11));
    const V z = hn::Div(weighted, sum);
    depth = hn::IfThenElse(hn::Ge(z, z_min), hn::IfThenElse(hn::Le(z, z_max), z, z_max), z_min);
    return hit;
}

/// `vertex(component, corner)` gives lanes of coordinate 0, 1, 2 (x, y, z in the rays' turned axes) of a
/// corner at the rays' times. Depths are meaningful where the mask is true.
template <class D, class V, class Vertex>
HWY_INLINE hn::Mask<D> hit_micropolygon(D d, V ox, V oy, V oz, V ux, V uy, const Vertex& vertex,
                                        Facing facing, V& depth) {
    namespace p = predicate_lanes;
    const V z00 = vertex(2, k00), z10 = vertex(2, k10), z01 = vertex(2, k01), z11 = vertex(2, k11);
    const auto offset = [](V x, V o, V u, V dz) HWY_ATTR { return hn::Sub(hn::Sub(x, o), hn::Mul(u, dz)); };
    const V dz00 = hn::Sub(z00, oz), dz10 = hn::Sub(z10, oz), dz01 = hn::Sub(z01, oz),
            dz11 = hn::Sub(z11, oz);
    const V a00 = offset(vertex(0, k00), ox, ux, dz00), b00 = offset(vertex(1, k00), oy, uy, dz00);
    const V a10 = offset(vertex(0, k10), ox, ux, dz10), b10 = offset(vertex(1, k10), oy, uy, dz10);
    const V a01 = offset(vertex(0, k01), ox, ux, dz01), b01 = offset(vertex(1, k01), oy, uy, dz01);
    const V a11 = offset(vertex(0, k11), ox, ux, dz11), b11 = offset(vertex(1, k11), oy, uy, dz11);

    const V crossings = hn::Xor(hn::Xor(p::crossing(a00, b00, a10, b10), p::crossing(a10, b10, a11, b11)),
                                hn::Xor(p::crossing(a11, b11, a01, b01), p::crossing(a01, b01, a00, b00)));
    const hn::Mask<D> hit = p::negative(d, crossings);
    if (hn::AllFalse(d, hit)) return hit;
    return hit_depth(d, a00, b00, a10, b10, a01, b01, a11, b11, z00, z10, z01, z11, facing, hit, depth);
}

/// Lanes of position_at().
template <class V>
HWY_INLINE V position_at(V start, V delta, V local_time) {
    return hn::Add(start, hn::Mul(local_time, delta));
}

}  // namespace HWY_NAMESPACE
}  // namespace trapeze
HWY_AFTER_NAMESPACE();

#endif  // per-target include guard
