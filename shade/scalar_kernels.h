/// The scalar twins of kernels.h, a vertex at a time: the same steps, hence the same bits. Tests compare the
/// two on every target; this is also where the formulas are easiest to read.
#pragma once

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>

#include "core/math.h"
#include "shade/kernels.h"

namespace trapeze::scalar {

inline float positive(float x) {
    return x > 0 ? x : 0;
}
inline float at_most(float x, float limit) {
    return x < limit ? x : limit;
}
inline float at_least(float x, float limit) {
    return x > limit ? x : limit;
}

/// c[0] x^(n-1) + ... + c[n-1] by Horner's rule.
template <size_t n>
float polynomial(const float (&c)[n], float x) {
    float p = c[0];
    for (size_t k = 1; k < n; ++k) p = p * x + c[k];
    return p;
}

/// Of a normal positive number. x = 2^e * m with m in [sqrt(1/2), sqrt(2)) (0x3f3504f3 is the float
/// sqrt(1/2)); ln m by the polynomial of Cephes' logf, good to about 1e-7.
inline float log2(float x) {
    constexpr float kLn[] = {7.0376836292e-2f,  -1.1514610310e-1f, 1.1676998740e-1f,
                             -1.2420140846e-1f, 1.4249322787e-1f,  -1.6668057665e-1f,
                             2.0000714765e-1f,  -2.4999993993e-1f, 3.3333331174e-1f};
    const int32_t bits = std::bit_cast<int32_t>(x);
    const int32_t exponent = (bits - 0x3f3504f3) >> 23;
    const float f = std::bit_cast<float>(bits - exponent * (1 << 23)) - 1;
    const float ln = f + (f * f) * (f * polynomial(kLn, f) - 0.5f);
    return static_cast<float>(exponent) + ln * 1.44269504f;
}

/// Cephes' exp2f; 0 below 2^-126 and no more than about 2^127.
inline float exp2(float x) {
    constexpr float kPower[] = {1.535336188319500e-4f,
                                1.339887440266574e-3f,
                                9.618437357674640e-3f,
                                5.550332471162809e-2f,
                                2.402264791363012e-1f,
                                6.931472028550421e-1f,
                                1};
    if (!(x >= -126)) return 0;
    const float clamped = at_most(x, 127);
    const float whole = std::nearbyint(clamped);
    return polynomial(kPower, clamped - whole) *
           std::bit_cast<float>((static_cast<int32_t>(whole) + 127) << 23);
}

/// 0 for x that is not positive, but anything to the power of 0 is 1.
inline float pow(float x, float y) {
    if (y == 0) return 1;
    return x > 1.17549435e-38f ? exp2(y * log2(x)) : 0;
}

/// sin(2 pi x); Taylor series to the eleventh power on a quarter turn, good to 6e-8.
inline float sine_of_turns(float x) {
    constexpr float kSine[] = {-2.50521084e-8f, 2.75573192e-6f,  -1.98412698e-4f,
                               8.33333333e-3f,  -1.66666667e-1f, 1};
    const float r = x - std::nearbyint(x);
    const float folded = std::fabs(r) > 0.25f ? std::copysign(0.5f, r) - r : r;
    const float a = folded * 6.28318531f;
    return a * polynomial(kSine, a * a);
}

inline float inverse_length(const V3f& v) {
    const float squared = v.dot(v);
    return squared > 0 ? 1 / std::sqrt(squared) : 0;
}

inline V3f normalize(const V3f& v, float scale) {
    return v * (inverse_length(v) * scale);
}

inline V3f facing_normal(const V3f& N, const V3f& I) {
    const float s = inverse_length(N);
    return N * (N.dot(I) > 0 ? -s : s);
}

inline V3f diffuse(const V3f& N, const V3f& L, const V3f& Cl) {
    return Cl * positive(N.dot(L));
}

inline V3f specular(const V3f& N, const V3f& V, const V3f& L, const V3f& Cl, float roughness) {
    const V3f H = V + L;
    const float cosine = N.dot(H) * inverse_length(H);
    const float lobe = pow(at_most(positive(cosine), 1), 1 / at_least(roughness, kernels::kMinRoughness));
    return Cl * (N.dot(L) > 0 ? lobe : 0);
}

inline V3f default_surface(const V3f& Os, const V3f& Cs, const V3f& N, const V3f& I, float ka, float kd) {
    const float cosine = N.dot(I) * (inverse_length(N) * inverse_length(I));
    return (Os * Cs) * (ka + kd * (cosine * cosine));
}

struct Lit {
    V3f L, direction, Cl;
};

inline Lit point_light(const V3f& P, const V3f& from, const V3f& color) {
    const V3f L = from - P;
    const float squared = L.dot(L);
    if (!(squared > kernels::kMinLightDistance * kernels::kMinLightDistance)) return {L, V3f(0), V3f(0)};
    return {L, L * (1 / std::sqrt(squared)), color * (1 / squared)};
}

inline V3f spot_falloff(const V3f& direction, const kernels::SpotCone& cone, const V3f& Cl) {
    const float width = cone.cos_inside - cone.cos_outside;
    const float inverse_width = width > 1e-6f ? 1 / width : 1e6f;
    const float c = -direction.dot(cone.axis);
    const float t = at_most(positive((c - cone.cos_outside) * inverse_width), 1);
    const float smooth = (t * t) * (3 - (t + t));
    return Cl * (pow(at_most(positive(c), 1), cone.beam) * smooth);
}

inline V3f transform_point(const V3f& p, const M44f& m) {
    V3f out;
    for (int k = 0; k < 3; ++k) out[k] = (p.x * m[0][k] + p.y * m[1][k] + p.z * m[2][k]) + m[3][k];
    return out;
}

/// Perlin's twelve directions to the edges of a cube, chosen by hashed bits. The hash's odd constants are
/// Teschner's and two rounds of a multiply-xorshift mixer.
inline float lattice_gradient(int32_t ix, int32_t iy, int32_t iz, float x, float y, float z) {
    uint32_t h = static_cast<uint32_t>(ix) * 0x8da6b343u ^ static_cast<uint32_t>(iy) * 0xd8163841u ^
                 static_cast<uint32_t>(iz) * 0xcb1ab31fu;
    h = (h ^ h >> 15) * 0x2c1b3c6du;
    h = (h ^ h >> 12) * 0x297a2d39u;
    h ^= h >> 15;
    const uint32_t edge = h & 15;
    const float a = edge < 8 ? x : y;
    const float b = edge < 4 ? y : (edge & 13) == 12 ? x : z;
    return (h & 1 ? -a : a) + (h & 2 ? -b : b);
}

inline float lerp(float t, float a, float b) {
    return a + t * (b - a);
}

inline float fade(float t) {
    return ((t * t) * t) * ((6 * t + -15) * t + 10);
}

inline float noise(const V3f& p) {
    V3f f, t;
    int32_t i[3];
    for (int k = 0; k < 3; ++k) {
        const float x = at_least(at_most(p[k], 4194304), -4194304);
        i[k] = static_cast<int32_t>(std::floor(x));
        f[k] = x - std::floor(x);
        t[k] = fade(f[k]);
    }
    const auto corner = [&](int cx, int cy, int cz) {
        return lattice_gradient(i[0] + cx, i[1] + cy, i[2] + cz, cx ? f.x - 1 : f.x, cy ? f.y - 1 : f.y,
                                cz ? f.z - 1 : f.z);
    };
    const auto layer = [&](int cz) {
        return lerp(t.y, lerp(t.x, corner(0, 0, cz), corner(1, 0, cz)),
                    lerp(t.x, corner(0, 1, cz), corner(1, 1, cz)));
    };
    return lerp(t.z, layer(0), layer(1));
}

inline float sine_waves(const V3f& p) {
    return (sine_of_turns(p.x) + sine_of_turns(p.y) + sine_of_turns(p.z)) * (1.0f / 3.0f);
}

inline V3f move_along(const V3f& P, const V3f& N, float amount, float scale) {
    return P + N * (amount * scale);
}

}  // namespace trapeze::scalar
