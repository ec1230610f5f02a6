/// The arithmetic of shading over whole planes, in SIMD (Highway, run-time dispatch). All planes of a call
/// have the output's size. Every operation is rounded once and never fused, so that each target, and the
/// scalar twin in scalar_kernels.h, gives the same bits.
///
/// Vectors of zero length normalise to zero, and no input that is finite and of moderate size gives NaN.
#pragma once

#include "core/math.h"
#include "shade/planes.h"

namespace trapeze::kernels {

/// out = scale * v / |v|.
void normalize(ConstPlane3 v, float scale, Plane3 out);

/// faceforward(normalize(N), I) of RISpec: N, turned to the side that I comes from.
void facing_normal(ConstPlane3 N, ConstPlane3 I, Plane3 out);

/// out += Cl.
void add(ConstPlane3 Cl, Plane3 out);

/// out = a * b.
void multiply(ConstPlane3 a, ConstPlane3 b, Plane3 out);

/// RISpec's diffuse() for one light: out += Cl * max(0, N.L), N and L of unit length.
void add_diffuse(ConstPlane3 N, ConstPlane3 L, ConstPlane3 Cl, Plane3 out);

/// RISpec's specular() for one light: out += Cl * max(0, N.H)^(1 / roughness) where N.L > 0, with
/// H = normalize(L + V); N, V and L of unit length. Roughness is taken to be at least kMinRoughness.
inline constexpr float kMinRoughness = 1e-5f;
void add_specular(ConstPlane3 N, ConstPlane3 V, ConstPlane3 L, ConstPlane3 Cl, ConstPlane roughness,
                  Plane3 out);

/// out = Os * base * (ka * a + kb * b).
void lit(ConstPlane3 Os, ConstPlane3 base, ConstPlane ka, ConstPlane3 a, ConstPlane kb, ConstPlane3 b,
         Plane3 out);

/// out += Os * color * (k * a).
void add_highlight(ConstPlane3 Os, ConstPlane3 color, ConstPlane k, ConstPlane3 a, Plane3 out);

/// out = Os * Cs * (ka + kd * (I.N)^2 / (I.I * N.N)): the light that sits at the eye.
void default_surface(ConstPlane3 Os, ConstPlane3 Cs, ConstPlane3 N, ConstPlane3 I, ConstPlane ka,
                     ConstPlane kd, Plane3 out);

/// L = from - P, direction = L / |L|, Cl = color / (L.L). A point nearer than kMinLightDistance is not lit.
inline constexpr float kMinLightDistance = 1e-10f;
void point_light(ConstPlane3 P, const V3f& from, const V3f& color, Plane3 L, Plane3 direction, Plane3 Cl);

/// What point_light's Cl is multiplied by in a spotlight whose axis has unit length:
/// max(0, c)^beam * smoothstep(cos_outside, cos_inside, c) where c is the cosine of the axis and -direction.
struct SpotCone {
    V3f axis;
    float cos_outside = 0, cos_inside = 1, beam = 2;
};
void spot_falloff(ConstPlane3 direction, const SpotCone& cone, Plane3 Cl);

/// p' = p * m for an affine m (row vectors).
void transform_points(ConstPlane3 p, const M44f& m, Plane3 out);

/// Gradient noise in about -1..1, 0 at the lattice: Perlin's improved noise with a hash for his table.
void noise(ConstPlane3 p, Plane out);

/// (sin(2 pi x) + sin(2 pi y) + sin(2 pi z)) / 3.
void sine_waves(ConstPlane3 p, Plane out);

/// out = P + N * (amount * scale).
void move_along(ConstPlane3 P, ConstPlane3 N, ConstPlane amount, ConstPlane scale, Plane3 out);

/// out = scale * p.
void scale(ConstPlane scale, ConstPlane3 p, Plane3 out);

}  // namespace trapeze::kernels
