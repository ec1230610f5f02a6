#include "shade/kernels.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "shade/kernels.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "shade/math-inl.h"

HWY_BEFORE_NAMESPACE();
namespace trapeze::kernels::HWY_NAMESPACE {

size_t lanes() {
    return hn::Lanes(D());
}

void normalize(ConstPlane3 v, float scale, Plane3 out) {
    for (size_t i = 0; i < out.size(); i += lanes()) {
        const V x = load(v.x, i), y = load(v.y, i), z = load(v.z, i);
        const V s = hn::Mul(inverse_length(x, y, z), set(scale));
        store(hn::Mul(x, s), out.x, i);
        store(hn::Mul(y, s), out.y, i);
        store(hn::Mul(z, s), out.z, i);
    }
}

void facing_normal(ConstPlane3 N, ConstPlane3 I, Plane3 out) {
    for (size_t i = 0; i < out.size(); i += lanes()) {
        const V x = load(N.x, i), y = load(N.y, i), z = load(N.z, i);
        const V toward = dot(x, y, z, load(I.x, i), load(I.y, i), load(I.z, i));
        const V s = inverse_length(x, y, z);
        const V turned = hn::IfThenElse(hn::Gt(toward, hn::Zero(D())), hn::Neg(s), s);
        store(hn::Mul(x, turned), out.x, i);
        store(hn::Mul(y, turned), out.y, i);
        store(hn::Mul(z, turned), out.z, i);
    }
}

void add(ConstPlane3 Cl, Plane3 out) {
    for (int k = 0; k < 3; ++k)
        for (size_t i = 0; i < out.size(); i += lanes())
            store(hn::Add(load(out[k], i), load(Cl[k], i)), out[k], i);
}

void multiply(ConstPlane3 a, ConstPlane3 b, Plane3 out) {
    for (int k = 0; k < 3; ++k)
        for (size_t i = 0; i < out.size(); i += lanes())
            store(hn::Mul(load(a[k], i), load(b[k], i)), out[k], i);
}

void add_diffuse(ConstPlane3 N, ConstPlane3 L, ConstPlane3 Cl, Plane3 out) {
    for (size_t i = 0; i < out.size(); i += lanes()) {
        const V cosine =
            positive(dot(load(N.x, i), load(N.y, i), load(N.z, i), load(L.x, i), load(L.y, i), load(L.z, i)));
        for (int k = 0; k < 3; ++k)
            store(hn::Add(load(out[k], i), hn::Mul(load(Cl[k], i), cosine)), out[k], i);
    }
}

void add_specular(ConstPlane3 N, ConstPlane3 Vp, ConstPlane3 L, ConstPlane3 Cl, ConstPlane roughness,
                  Plane3 out) {
    for (size_t i = 0; i < out.size(); i += lanes()) {
        const V nx = load(N.x, i), ny = load(N.y, i), nz = load(N.z, i);
        const V lx = load(L.x, i), ly = load(L.y, i), lz = load(L.z, i);
        const V hx = hn::Add(load(Vp.x, i), lx), hy = hn::Add(load(Vp.y, i), ly);
        const V hz = hn::Add(load(Vp.z, i), lz);
        const V cosine = hn::Mul(dot(nx, ny, nz, hx, hy, hz), inverse_length(hx, hy, hz));
        const V exponent = hn::Div(set(1), at_least(load(roughness, i), set(kMinRoughness)));
        const V lobe = pow(at_most(positive(cosine), set(1)), exponent);
        const V lit_side = hn::IfThenElseZero(hn::Gt(dot(nx, ny, nz, lx, ly, lz), hn::Zero(D())), lobe);
        for (int k = 0; k < 3; ++k)
            store(hn::Add(load(out[k], i), hn::Mul(load(Cl[k], i), lit_side)), out[k], i);
    }
}

void lit(ConstPlane3 Os, ConstPlane3 base, ConstPlane ka, ConstPlane3 a, ConstPlane kb, ConstPlane3 b,
         Plane3 out) {
    for (int k = 0; k < 3; ++k)
        for (size_t i = 0; i < out.size(); i += lanes()) {
            const V light = hn::Add(hn::Mul(load(ka, i), load(a[k], i)), hn::Mul(load(kb, i), load(b[k], i)));
            store(hn::Mul(hn::Mul(load(Os[k], i), load(base[k], i)), light), out[k], i);
        }
}

void add_highlight(ConstPlane3 Os, ConstPlane3 color, ConstPlane kp, ConstPlane3 a, Plane3 out) {
    for (int k = 0; k < 3; ++k)
        for (size_t i = 0; i < out.size(); i += lanes()) {
            const V light = hn::Mul(load(kp, i), load(a[k], i));
            const V seen = hn::Mul(hn::Mul(load(Os[k], i), load(color[k], i)), light);
            store(hn::Add(load(out[k], i), seen), out[k], i);
        }
}

void default_surface(ConstPlane3 Os, ConstPlane3 Cs, ConstPlane3 N, ConstPlane3 I, ConstPlane ka,
                     ConstPlane kd, Plane3 out) {
    for (size_t i = 0; i < out.size(); i += lanes()) {
        const V nx = load(N.x, i), ny = load(N.y, i), nz = load(N.z, i);
        const V ix = load(I.x, i), iy = load(I.y, i), iz = load(I.z, i);
        const V cosine = hn::Mul(dot(nx, ny, nz, ix, iy, iz),
                                 hn::Mul(inverse_length(nx, ny, nz), inverse_length(ix, iy, iz)));
        const V light = hn::Add(load(ka, i), hn::Mul(load(kd, i), hn::Mul(cosine, cosine)));
        for (int k = 0; k < 3; ++k) store(hn::Mul(hn::Mul(load(Os[k], i), load(Cs[k], i)), light), out[k], i);
    }
}

void point_light(ConstPlane3 P, const V3f& from, const V3f& color, Plane3 L, Plane3 direction, Plane3 Cl) {
    for (size_t i = 0; i < L.size(); i += lanes()) {
        const V x = hn::Sub(set(from.x), load(P.x, i)), y = hn::Sub(set(from.y), load(P.y, i));
        const V z = hn::Sub(set(from.z), load(P.z, i));
        const V squared = dot(x, y, z, x, y, z);
        const auto apart = hn::Gt(squared, set(kMinLightDistance * kMinLightDistance));
        const V s = hn::IfThenElseZero(apart, hn::Div(set(1), hn::Sqrt(squared)));
        const V falloff = hn::IfThenElseZero(apart, hn::Div(set(1), squared));
        store(x, L.x, i), store(y, L.y, i), store(z, L.z, i);
        store(hn::Mul(x, s), direction.x, i);
        store(hn::Mul(y, s), direction.y, i);
        store(hn::Mul(z, s), direction.z, i);
        for (int k = 0; k < 3; ++k) store(hn::Mul(set(color[k]), falloff), Cl[k], i);
    }
}

void spot_falloff(ConstPlane3 direction, const SpotCone& cone, Plane3 Cl) {
    const float width = cone.cos_inside - cone.cos_outside;
    const float inverse_width = width > 1e-6f ? 1 / width : 1e6f;
    for (size_t i = 0; i < Cl.size(); i += lanes()) {
        const V c = hn::Neg(dot(load(direction.x, i), load(direction.y, i), load(direction.z, i),
                                set(cone.axis.x), set(cone.axis.y), set(cone.axis.z)));
        const V t = at_most(positive(hn::Mul(hn::Sub(c, set(cone.cos_outside)), set(inverse_width))), set(1));
        const V smooth = hn::Mul(hn::Mul(t, t), hn::Sub(set(3), hn::Add(t, t)));
        const V beam = hn::Mul(pow(at_most(positive(c), set(1)), set(cone.beam)), smooth);
        for (int k = 0; k < 3; ++k) store(hn::Mul(load(Cl[k], i), beam), Cl[k], i);
    }
}

void transform_points(ConstPlane3 p, const M44f& m, Plane3 out) {
    for (size_t i = 0; i < out.size(); i += lanes()) {
        const V x = load(p.x, i), y = load(p.y, i), z = load(p.z, i);
        for (int k = 0; k < 3; ++k)
            store(hn::Add(dot(x, y, z, set(m[0][k]), set(m[1][k]), set(m[2][k])), set(m[3][k])), out[k], i);
    }
}

void noise_planes(ConstPlane3 p, Plane out) {
    for (size_t i = 0; i < out.size(); i += lanes())
        store(noise(load(p.x, i), load(p.y, i), load(p.z, i)), out, i);
}

void sine_waves(ConstPlane3 p, Plane out) {
    for (size_t i = 0; i < out.size(); i += lanes()) {
        const V sum = hn::Add(hn::Add(sine_of_turns(load(p.x, i)), sine_of_turns(load(p.y, i))),
                              sine_of_turns(load(p.z, i)));
        store(hn::Mul(sum, set(1.0f / 3.0f)), out, i);
    }
}

void move_along(ConstPlane3 P, ConstPlane3 N, ConstPlane amount, ConstPlane scale, Plane3 out) {
    for (int k = 0; k < 3; ++k)
        for (size_t i = 0; i < out.size(); i += lanes()) {
            const V move = hn::Mul(load(amount, i), load(scale, i));
            store(hn::Add(load(P[k], i), hn::Mul(load(N[k], i), move)), out[k], i);
        }
}

void scale(ConstPlane s, ConstPlane3 p, Plane3 out) {
    for (int k = 0; k < 3; ++k)
        for (size_t i = 0; i < out.size(); i += lanes()) store(hn::Mul(load(p[k], i), load(s, i)), out[k], i);
}

}  // namespace trapeze::kernels::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace trapeze::kernels {

HWY_EXPORT(normalize);
HWY_EXPORT(facing_normal);
HWY_EXPORT(add);
HWY_EXPORT(multiply);
HWY_EXPORT(add_diffuse);
HWY_EXPORT(add_specular);
HWY_EXPORT(lit);
HWY_EXPORT(add_highlight);
HWY_EXPORT(default_surface);
HWY_EXPORT(point_light);
HWY_EXPORT(spot_falloff);
HWY_EXPORT(transform_points);
HWY_EXPORT(sine_waves);
HWY_EXPORT(move_along);
HWY_EXPORT(scale);
HWY_EXPORT(noise_planes);

void normalize(ConstPlane3 v, float scale, Plane3 out) {
    HWY_DYNAMIC_DISPATCH(normalize)(v, scale, out);
}
void facing_normal(ConstPlane3 N, ConstPlane3 I, Plane3 out) {
    HWY_DYNAMIC_DISPATCH(facing_normal)(N, I, out);
}
void add(ConstPlane3 Cl, Plane3 out) {
    HWY_DYNAMIC_DISPATCH(add)(Cl, out);
}
void multiply(ConstPlane3 a, ConstPlane3 b, Plane3 out) {
    HWY_DYNAMIC_DISPATCH(multiply)(a, b, out);
}
void add_diffuse(ConstPlane3 N, ConstPlane3 L, ConstPlane3 Cl, Plane3 out) {
    HWY_DYNAMIC_DISPATCH(add_diffuse)(N, L, Cl, out);
}
void add_specular(ConstPlane3 N, ConstPlane3 V, ConstPlane3 L, ConstPlane3 Cl, ConstPlane roughness,
                  Plane3 out) {
    HWY_DYNAMIC_DISPATCH(add_specular)(N, V, L, Cl, roughness, out);
}
void lit(ConstPlane3 Os, ConstPlane3 base, ConstPlane ka, ConstPlane3 a, ConstPlane kb, ConstPlane3 b,
         Plane3 out) {
    HWY_DYNAMIC_DISPATCH(lit)(Os, base, ka, a, kb, b, out);
}
void add_highlight(ConstPlane3 Os, ConstPlane3 color, ConstPlane k, ConstPlane3 a, Plane3 out) {
    HWY_DYNAMIC_DISPATCH(add_highlight)(Os, color, k, a, out);
}
void default_surface(ConstPlane3 Os, ConstPlane3 Cs, ConstPlane3 N, ConstPlane3 I, ConstPlane ka,
                     ConstPlane kd, Plane3 out) {
    HWY_DYNAMIC_DISPATCH(default_surface)(Os, Cs, N, I, ka, kd, out);
}
void point_light(ConstPlane3 P, const V3f& from, const V3f& color, Plane3 L, Plane3 direction, Plane3 Cl) {
    HWY_DYNAMIC_DISPATCH(point_light)(P, from, color, L, direction, Cl);
}
void spot_falloff(ConstPlane3 direction, const SpotCone& cone, Plane3 Cl) {
    HWY_DYNAMIC_DISPATCH(spot_falloff)(direction, cone, Cl);
}
void transform_points(ConstPlane3 p, const M44f& m, Plane3 out) {
    HWY_DYNAMIC_DISPATCH(transform_points)(p, m, out);
}
void noise(ConstPlane3 p, Plane out) {
    HWY_DYNAMIC_DISPATCH(noise_planes)(p, out);
}
void sine_waves(ConstPlane3 p, Plane out) {
    HWY_DYNAMIC_DISPATCH(sine_waves)(p, out);
}
void move_along(ConstPlane3 P, ConstPlane3 N, ConstPlane amount, ConstPlane scale, Plane3 out) {
    HWY_DYNAMIC_DISPATCH(move_along)(P, N, amount, scale, out);
}
void scale(ConstPlane scale, ConstPlane3 p, Plane3 out) {
    HWY_DYNAMIC_DISPATCH(scale)(scale, p, out);
}

}  // namespace trapeze::kernels
#endif
