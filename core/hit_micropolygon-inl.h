/// The SIMD form of hit_micropolygon() [Hou10 sec. 3.5]: lanes are rays against one micropolygon, which may
/// have moved to another place for each. The same operations in the same order as the scalar form, none
/// fused: equal bit for bit, depth included. Compiled once a target; see Highway's foreach_target.h.
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

/// A coordinate of a corner, dz behind the ray's origin, moved along the ray to the plane of its origin.
template <class V>
HWY_INLINE V offset(V x, V o, V u, V dz) {
    return hn::Sub(hn::Sub(x, o), hn::Mul(u, dz));
}

/// The edge function of the scalar form: twice the area of the triangle with the origin.
template <class V>
HWY_INLINE V edge(V ai, V bi, V aj, V bj) {
    return hn::Sub(hn::Mul(ai, bj), hn::Mul(aj, bi));
}

/// crosses() of the scalar form, in the sign bits; the other bits mean nothing. |b| comes along.
template <class V>
HWY_INLINE V crossing(V ai, V bi, V abs_bi, V aj, V bj, V abs_bj) {
    const V t = hn::Add(hn::Mul(ai, abs_bj), hn::Mul(aj, abs_bi));
#if HWY_TARGET <= HWY_AVX3 && HWY_ARCH_X86
    // In one instruction, which the compiler does not find.
    return V{_mm512_castsi512_ps(_mm512_ternarylogic_epi32(
        _mm512_castps_si512(bi.raw), _mm512_castps_si512(bj.raw), _mm512_castps_si512(t.raw), 0x28))};
#else
    return hn::And(hn::Xor(bi, bj), t);
#endif
}

template <class V>
HWY_INLINE V crossing(V ai, V bi, V aj, V bj) {
    return crossing(ai, bi, hn::Abs(bi), aj, bj, hn::Abs(bj));
}

/// Lanes whose sign bit is set.
template <class D, class V>
HWY_INLINE hn::Mask<D> negative(D d, V v) {
    const hn::RebindToSigned<D> di;
    return hn::RebindMask(d, hn::Lt(hn::BitCast(di, v), hn::Zero(di)));
}

/// std::min and std::max in lanes: the first argument where both are equal, and where one is NaN.
template <class V>
HWY_INLINE V min_of(V a, V b) {
    return hn::IfThenElse(hn::Lt(b, a), b, a);
}
template <class V>
HWY_INLINE V max_of(V a, V b) {
    return hn::IfThenElse(hn::Lt(a, b), b, a);
}

}  // namespace predicate_lanes

/// A quad whose corners are moved along the lanes' rays to the plane of the rays' origins, and the corners'
/// depths.
template <class V>
struct QuadLanes {
    V a00, a10, a01, a11, b00, b10, b01, b11;
    V z00, z10, z01, z11;
};

/// Moves a quad's corners along rays. `vertex(component, corner)` gives lanes of coordinate 0, 1, 2 (x, y, z
/// in the rays' turned axes) of a corner at the rays' times.
template <class V, class Vertex>
HWY_INLINE QuadLanes<V> quad_lanes(V ox, V oy, V oz, V ux, V uy, const Vertex& vertex) {
    using predicate_lanes::offset;
    QuadLanes<V> q;
    q.z00 = vertex(2, k00), q.z10 = vertex(2, k10), q.z01 = vertex(2, k01), q.z11 = vertex(2, k11);
    const V dz00 = hn::Sub(q.z00, oz), dz10 = hn::Sub(q.z10, oz), dz01 = hn::Sub(q.z01, oz),
            dz11 = hn::Sub(q.z11, oz);
    q.a00 = offset(vertex(0, k00), ox, ux, dz00), q.b00 = offset(vertex(1, k00), oy, uy, dz00);
    q.a10 = offset(vertex(0, k10), ox, ux, dz10), q.b10 = offset(vertex(1, k10), oy, uy, dz10);
    q.a01 = offset(vertex(0, k01), ox, ux, dz01), q.b01 = offset(vertex(1, k01), oy, uy, dz01);
    q.a11 = offset(vertex(0, k11), ox, ux, dz11), q.b11 = offset(vertex(1, k11), oy, uy, dz11);
    return q;
}

/// Lanes whose rays pass inside, whatever way the quad faces.
template <class D, class V>
HWY_INLINE hn::Mask<D> inside(D d, const QuadLanes<V>& q) {
    namespace p = predicate_lanes;
    const V abs00 = hn::Abs(q.b00), abs10 = hn::Abs(q.b10), abs01 = hn::Abs(q.b01), abs11 = hn::Abs(q.b11);
    return p::negative(d, hn::Xor(hn::Xor(p::crossing(q.a00, q.b00, abs00, q.a10, q.b10, abs10),
                                          p::crossing(q.a10, q.b10, abs10, q.a11, q.b11, abs11)),
                                  hn::Xor(p::crossing(q.a11, q.b11, abs11, q.a01, q.b01, abs01),
                                          p::crossing(q.a01, q.b01, abs01, q.a00, q.b00, abs00))));
}

/// Edge functions of a quad's sides, and what they weigh its corners by on the triangle that holds the ray:
/// weights() of the scalar form.
template <class V>
struct SideLanes {
    V c_bottom, c_right, c_top, c_left;
};
template <class V>
struct WeightLanes {
    V w00, w10, w01, w11;
};
template <class V>
HWY_INLINE SideLanes<V> side_lanes(const QuadLanes<V>& q) {
    namespace p = predicate_lanes;
    return {p::edge(q.a00, q.b00, q.a10, q.b10), p::edge(q.a10, q.b10, q.a11, q.b11),
            p::edge(q.a11, q.b11, q.a01, q.b01), p::edge(q.a01, q.b01, q.a00, q.b00)};
}
template <class D, class V>
HWY_INLINE WeightLanes<V> weight_lanes(D d, const QuadLanes<V>& q, const SideLanes<V>& c) {
    namespace p = predicate_lanes;
    using M = hn::Mask<D>;
    const V zero = hn::Zero(d);
    const V c_diagonal = p::edge(q.a00, q.b00, q.a11, q.b11);
    const V against = hn::Neg(c_diagonal);
    const V lowest = p::min_of(p::min_of(c.c_bottom, c.c_right), against);
    const V highest = p::max_of(p::max_of(c.c_bottom, c.c_right), against);
    const M agree = hn::Xor(hn::Lt(lowest, zero), hn::Gt(highest, zero));
    const M lower = hn::Or(agree, hn::Eq(hn::Add(c.c_top, hn::Add(c_diagonal, c.c_left)), zero));
    return {hn::IfThenElse(lower, c.c_right, c.c_top), hn::IfThenElse(lower, against, zero),
            hn::IfThenElse(lower, zero, c_diagonal), hn::IfThenElse(lower, c.c_bottom, c.c_left)};
}

/// Depths of rays that pass inside; false where the quad faces the wrong way.
template <class D, class V>
HWY_INLINE hn::Mask<D> depth_inside(D d, const QuadLanes<V>& q, Facing facing, V& depth) {
    namespace p = predicate_lanes;
    using M = hn::Mask<D>;
    const V zero = hn::Zero(d);
    const SideLanes<V> c = side_lanes(q);
    M hit = hn::Not(hn::FirstN(d, 0));
    if (facing != Facing::Both) {
        const V twice_area = hn::Add(hn::Add(c.c_bottom, c.c_right), hn::Add(c.c_top, c.c_left));
        hit = facing == Facing::PositiveOnly ? hn::Ge(twice_area, zero) : hn::Lt(twice_area, zero);
    }
    const auto [w00, w10, w01, w11] = weight_lanes(d, q, c);
    const V sum = hn::Add(hn::Add(w00, w10), hn::Add(w01, w11));
    const V weighted = hn::Add(hn::Add(hn::Mul(w00, q.z00), hn::Mul(w10, q.z10)),
                               hn::Add(hn::Mul(w01, q.z01), hn::Mul(w11, q.z11)));
    const V z_min = p::min_of(p::min_of(q.z00, q.z10), p::min_of(q.z01, q.z11));
    const V z_max = p::max_of(p::max_of(q.z00, q.z10), p::max_of(q.z01, q.z11));
    const V z = hn::Div(weighted, sum);
    depth = hn::IfThenElse(hn::Ge(z, z_min), hn::IfThenElse(hn::Le(z, z_max), z, z_max), z_min);
    return hit;
}

/// hit_micropolygon() in lanes. Depths are meaningful where the mask is true.
template <class D, class V, class Vertex>
HWY_INLINE hn::Mask<D> hit_micropolygon(D d, V ox, V oy, V oz, V ux, V uy, const Vertex& vertex,
                                        Facing facing, V& depth) {
    const QuadLanes<V> q = quad_lanes(ox, oy, oz, ux, uy, vertex);
    const hn::Mask<D> hit = inside(d, q);
    if (hn::AllFalse(d, hit)) return hit;
    return hn::And(hit, depth_inside(d, q, facing, depth));
}

/// hit_weights() in lanes.
template <class D, class V>
HWY_INLINE WeightLanes<V> hit_weights(D d, const QuadLanes<V>& q) {
    const WeightLanes<V> w = weight_lanes(d, q, side_lanes(q));
    const V zero = hn::Zero(d), one = hn::Set(d, 1.0f);
    const V scale = hn::Div(one, hn::Add(hn::Add(w.w00, w.w10), hn::Add(w.w01, w.w11)));
    const auto clamped = [&](V weight) HWY_ATTR {
        const V normalised = hn::Mul(weight, scale);
        return hn::IfThenElseZero(hn::Gt(normalised, zero),
                                  predicate_lanes::min_of(normalised, one));  // also takes NaN to 0
    };
    const V s00 = clamped(w.w00), s10 = clamped(w.w10), s01 = clamped(w.w01), s11 = clamped(w.w11);
    const V total = hn::Add(hn::Add(hn::Add(s00, s10), s01), s11);
    const auto some = hn::Gt(total, zero);
    const V share = hn::Div(one, total);
    return {hn::IfThenElse(some, hn::Mul(s00, share), one), hn::IfThenElseZero(some, hn::Mul(s10, share)),
            hn::IfThenElseZero(some, hn::Mul(s01, share)), hn::IfThenElseZero(some, hn::Mul(s11, share))};
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
