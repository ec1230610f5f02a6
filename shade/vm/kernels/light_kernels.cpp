#include "shade/vm/kernels/light_kernels.h"

#include "shade/vm/kernels/families.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "shade/vm/kernels/light_kernels.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "shade/vm/kernels/elementary-inl.h"

HWY_BEFORE_NAMESPACE();
namespace trapeze::vm::HWY_NAMESPACE {
namespace {

/// Below this a highlight is smaller than any micropolygon, and its exponent leaves what pow() is good for.
constexpr float kMinRoughness = 1e-5f;

/// Adds a light's share, `s` of its colour, to the sum over lights.
HWY_INLINE void add_scaled(const Output& out, const Input& color, V s, size_t i) {
    for (int k = 0; k < 3; ++k) out.put(hn::Add(out.get(i, k), hn::Mul(color.get(i, k), s)), i, k);
}

/// Ambient light: no direction, no normal.
void sum_light(size_t lanes, const Operand& Cl, float share, const Operand& result) {
    const Output out(result);
    const Input color(Cl);
    for (size_t i = 0; i < lanes; i += lane_count()) add_scaled(out, color, set(share), i);
}

/// The names here differ from those of light_kernels.h, which call them by way of the dispatch.
void sum_diffuse(size_t lanes, const Operand& N, const Operand& L, const Operand& Cl, float share,
                 const Operand& result) {
    const Output out(result);
    const Input normal(N), to_light(L), color(Cl);
    for (size_t i = 0; i < lanes; i += lane_count()) {
        const V cosine = positive(dot(normal.get3(i), to_light.get3(i)));
        add_scaled(out, color, hn::Mul(cosine, set(share)), i);
    }
}

/// The exponent of roughness 1. RISpec 3.2 writes 1 / roughness; the roughnesses in shaders were chosen with
/// renderers that had 8 / roughness.
constexpr float kSpecularExponent = 8;

/// pow() is the quick one, in floats: a highlight's exponent needs no more. No highlight where the light is
/// behind the surface, though the halfway vector may still be in front.
HWY_INLINE V specular_lobe(const V3& N, const V3& view, const V3& L, V roughness) {
    const V3 h = add(view, L);
    const V cosine = at_most(positive(hn::Mul(dot(N, h), inverse_length(h))), set(1));
    const V lobe = pow(cosine, hn::Div(set(kSpecularExponent), at_least(roughness, set(kMinRoughness))));
    return hn::IfThenElseZero(hn::Gt(dot(N, L), hn::Zero(D())), lobe);
}

/// Blinn's highlight: the cosine between the normal and the vector halfway to the light.
void sum_specular(size_t lanes, const Operand& N, const Operand& view, const Operand& roughness,
                  const Operand& L, const Operand& Cl, float share, const Operand& result) {
    const Output out(result);
    const Input normal(N), to_eye(view), rough(roughness), to_light(L), color(Cl);
    for (size_t i = 0; i < lanes; i += lane_count()) {
        const V lobe = specular_lobe(normal.get3(i), to_eye.get3(i), to_light.get3(i), rough.get(i));
        add_scaled(out, color, hn::Mul(lobe, set(share)), i);
    }
}

/// Phong's highlight: the cosine between the mirrored view and the light. The normal is made of unit length
/// here, as shaders pass it as they have it.
void sum_phong(size_t lanes, const Operand& N, const Operand& view, const Operand& size, const Operand& L,
               const Operand& Cl, float share, const Operand& result) {
    const Output out(result);
    const Input normal(N), to_eye(view), exponent(size), to_light(L), color(Cl);
    for (size_t i = 0; i < lanes; i += lane_count()) {
        const V3 v = to_eye.get3(i), normal_here = normal.get3(i);
        const V3 n = scale(normal_here, inverse_length(normal_here));
        const V twice = hn::Mul(dot(n, v), set(2));
        const V3 mirrored = subtract(scale(n, twice), v);
        const V cosine = hn::Mul(dot(mirrored, to_light.get3(i)), inverse_length(mirrored));
        const V lobe = pow(at_most(positive(cosine), set(1)), exponent.get(i));
        add_scaled(out, color, hn::Mul(hn::IfThenElseZero(hn::Gt(cosine, hn::Zero(D())), lobe), set(share)),
                   i);
    }
}

/// Compares cosines: v.a >= |v| |a| cos(angle) needs no arc cosine and no division.
void find_cone(size_t lanes, const Operand& vectors, const Operand& axes, const Operand& angles,
               const Operand& result) {
    const Output out(result);
    const Input vector(vectors), axis(axes), angle(angles);
    const V zero = hn::Zero(D());
    for (size_t i = 0; i < lanes; i += lane_count()) {
        const V3 v = vector.get3(i), a = axis.get3(i);
        const V limit = angle.get(i);
        const V lengths = hn::Mul(hn::Sqrt(dot(v, v)), hn::Sqrt(dot(a, a)));
        const M inside = hn::Ge(dot(v, a), hn::Mul(lengths, cosine(limit)));
        const M some = hn::And(hn::Gt(lengths, zero), hn::Ge(limit, zero));
        out.put_mask(hn::Or(hn::Ge(limit, set(kPi)), hn::And(inside, some)), i);
    }
}

/// receive_light() of light_kernels.h: the light's run has left L as the way from it.
void turn_to_surface(size_t lanes, const Operand& lit, const Operand& color, const Operand& L,
                     const Operand& direction, const Operand& Cl) {
    const Input reached(lit), sent(color), from_light(L);
    const Output to_light(L), unit(direction), arriving(Cl);
    const V zero = hn::Zero(D());
    for (size_t i = 0; i < lanes; i += lane_count()) {
        const V3 way = from_light.get3(i);
        const V3 back{hn::Neg(way.x), hn::Neg(way.y), hn::Neg(way.z)};
        const V3 u = scale(back, inverse_length(back));
        // inverse_length() is 0 where there is no direction: the light stands at the point.
        const M apart = hn::Or(hn::Or(hn::Ne(u.x, zero), hn::Ne(u.y, zero)), hn::Ne(u.z, zero));
        const M shines = hn::And(reached.mask(i), apart);
        for (int k = 0; k < 3; ++k) arriving.put(hn::IfThenElseZero(shines, sent.get(i, k)), i, k);
        to_light.put3(back, i);
        unit.put3(u, i);
    }
}

/// specularbrdf(L, N, V, roughness), L of any length.
template <int width>
void specular_brdf(size_t lanes, Operands o) {
    const Output out(o[0]);
    const Input to_light(o[1]), normal(o[2]), to_eye(o[3]), rough(o[4]);
    for (size_t i = 0; i < lanes; i += lane_count()) {
        const V3 L = to_light.get3(i);
        const V3 unit = scale(L, inverse_length(L));
        const V lobe = specular_lobe(normal.get3(i), to_eye.get3(i), unit, rough.get(i));
        for (int k = 0; k < width; ++k) out.put(lobe, i, k);
    }
}

/// The result may be a colour: the same lobe in all three components.
Kernel find_specular_brdf(std::span<const int> widths) {
    if (are(widths, {1, 3, 3, 3, 1})) return specular_brdf<1>;
    return are(widths, {3, 3, 3, 3, 1}) ? specular_brdf<3> : nullptr;
}

constexpr KernelRow kRows[] = {{rsl::Op::SpecularBrdf, find_specular_brdf}};

Kernel find_light_kernels(rsl::Op op, std::span<const int> widths) {
    return kernel_in(kRows, op, widths);
}

}  // namespace
}  // namespace trapeze::vm::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace trapeze::vm {

HWY_EXPORT(sum_light);
HWY_EXPORT(sum_diffuse);
HWY_EXPORT(sum_specular);
HWY_EXPORT(sum_phong);
HWY_EXPORT(find_cone);
HWY_EXPORT(turn_to_surface);

void add_light(size_t lanes, const Operand& Cl, float share, const Operand& out) {
    HWY_DYNAMIC_DISPATCH(sum_light)(lanes, Cl, share, out);
}
void add_diffuse(size_t lanes, const Operand& N, const Operand& L, const Operand& Cl, float share,
                 const Operand& out) {
    HWY_DYNAMIC_DISPATCH(sum_diffuse)(lanes, N, L, Cl, share, out);
}
void add_specular(size_t lanes, const Operand& N, const Operand& V, const Operand& roughness,
                  const Operand& L, const Operand& Cl, float share, const Operand& out) {
    HWY_DYNAMIC_DISPATCH(sum_specular)(lanes, N, V, roughness, L, Cl, share, out);
}
void add_phong(size_t lanes, const Operand& N, const Operand& V, const Operand& size, const Operand& L,
               const Operand& Cl, float share, const Operand& out) {
    HWY_DYNAMIC_DISPATCH(sum_phong)(lanes, N, V, size, L, Cl, share, out);
}
void cone_mask(size_t lanes, const Operand& v, const Operand& axis, const Operand& angle,
               const Operand& out) {
    HWY_DYNAMIC_DISPATCH(find_cone)(lanes, v, axis, angle, out);
}
void receive_light(size_t lanes, const Operand& lit, const Operand& color, const Operand& L,
                   const Operand& direction, const Operand& Cl) {
    HWY_DYNAMIC_DISPATCH(turn_to_surface)(lanes, lit, color, L, direction, Cl);
}

}  // namespace trapeze::vm

TRAPEZE_KERNEL_FAMILY(find_light_kernels)
#endif
