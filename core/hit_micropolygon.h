/// The one predicate: does a ray hit a micropolygon, and how deep. Every visibility method calls it (or its
/// SIMD form in hit_micropolygon-inl.h, which rounds alike); everything else may only discard what it would
/// reject [decision 0015].
///
/// The pseudo-intersection of [Hou10 sec. 3.5]: the four vertices at the ray's time are moved along the ray
/// to its plane,
///     a = x - ox - ux * (z - oz),   b = y - oy - uy * (z - oz),
/// which is a parallel projection along the ray: good for any z, also for quads through the eye plane. The
/// ray passes the quad when the origin of (a, b) is inside by the even-odd rule. A quad may be a bow-tie or
/// degenerate.
///
/// An edge counts where it crosses the negative a axis: where the sign bits of b at its ends differ and that
/// of
///     t = a_i * |b_j| + a_j * |b_i|
/// is set, which is the crossing's a but for a positive factor: multiply, multiply, add, never fused. Walked
/// the other way it is the same sum: both micropolygons at an edge decide alike in every bit, zeros included
/// [decision 0007].
/// So a mesh that is closed in its bits has no leaks. (Sign bits, not comparisons with zero: vector units do
/// them by and, or and xor, without masks.)
///
// clang-format off
///     v  01 ---- 11     The diagonal 00-11 makes two triangles; the depth is that of the point on the one
///     ^   |    / |      that holds it.
///     |   |  /   |
///     |  00 ---- 10
///     +-------------> u
// clang-format on
///
/// Departs from the paper: depth on the triangle instead of bilinear interpolation of all four, clamped to
/// the quad's own depth range: the weights of a triangle seen edge-on round to anything, and this much stays
/// certain. (Culls by the depth at which a bound is entered must allow for it [decision 0004].)
#pragma once

#include <algorithm>
#include <cmath>

#include "core/rays.h"

namespace trapeze {

/// No coordinate of a grid is larger. Products may overflow, but a and b are numbers: where they were not,
/// signs would depend on the order of operands.
inline constexpr float kLargestCoordinate = 1e30f;

/// A quad's corners in the order 00, 10, 01, 11, at the ray's time, in the ray's turned axes (TurnedRay).
struct Quad {
    float x[4], y[4], z[4];
};

enum QuadCorner { k00 = 0, k10 = 1, k01 = 2, k11 = 3 };

/// One coordinate of a moving vertex. Never fused into a multiply-add: all methods must round alike.
inline float position_at(float start, float delta, float local_time) {
    return start + local_time * delta;
}

/// Which faces of a micropolygon can be hit, by the sign of its projected area (positive when 00, 10, 11, 01
/// turn counter-clockwise in (a, b)).
enum class Facing : uint8_t { Both, PositiveOnly, NegativeOnly };

/// Barycentric weights of the hit point on the corners 00, 10, 01, 11 (one of 10 and 01 is 0); they sum to 1.
struct QuadWeights {
    float w[4];
};

namespace predicate_detail {

/// A quad's corners along the ray to its plane, and the edge functions of its sides.
struct Edges {
    float a[4], b[4];
    float c_bottom, c_right, c_top, c_left;  ///< 00->10, 10->11, 11->01, 01->00
};

/// Twice the signed area of the triangle of the origin and an edge's ends.
inline float edge(float ai, float bi, float aj, float bj) {
    return ai * bj - aj * bi;
}

/// Moves the corners along the ray; all forms of the predicate do it in this order of operations.
inline Edges edges_of(const AxisRay& ray, const Quad& q) {
    Edges e;
    for (int i = 0; i < 4; ++i) {
        const float dz = q.z[i] - ray.oz;
        e.a[i] = (q.x[i] - ray.ox) - ray.ux * dz;
        e.b[i] = (q.y[i] - ray.oy) - ray.uy * dz;
    }
    e.c_bottom = edge(e.a[k00], e.b[k00], e.a[k10], e.b[k10]);
    e.c_right = edge(e.a[k10], e.b[k10], e.a[k11], e.b[k11]);
    e.c_top = edge(e.a[k11], e.b[k11], e.a[k01], e.b[k01]);
    e.c_left = edge(e.a[k01], e.b[k01], e.a[k00], e.b[k00]);
    return e;
}

/// Whether the edge between i and j crosses the negative a axis. The same answer for j and i, bit for bit.
inline bool crosses(const Edges& e, int i, int j) {
    return std::signbit(e.b[i]) != std::signbit(e.b[j]) &&
           std::signbit(e.a[i] * std::abs(e.b[j]) + e.a[j] * std::abs(e.b[i]));
}

/// Whether the origin is inside, by the even-odd rule over the four sides.
inline bool inside(const Edges& e) {
    return crosses(e, k00, k10) ^ crosses(e, k10, k11) ^ crosses(e, k11, k01) ^ crosses(e, k01, k00);
}

/// Twice the signed area of the quad.
inline float area(const Edges& e) {
    return (e.c_bottom + e.c_right) + (e.c_top + e.c_left);
}

/// Whether the quad can be hit from this side. A quad without area counts as positive.
inline bool faces(const Edges& e, Facing facing) {
    if (facing == Facing::Both) return true;
    const float twice_area = area(e);
    return facing == Facing::PositiveOnly ? twice_area >= 0 : twice_area < 0;
}

/// Unnormalised weights on the triangle that holds the point: 00-10-11 when its three edge functions agree,
/// those that are 0 with any, or when 00-11-01 has no area; else 00-11-01. Which side of the diagonal a point
/// is on may round otherwise than whether it is inside: a triangle without area may not be taken for that.
inline QuadWeights weights(const Edges& e) {
    const float c_diagonal = edge(e.a[k00], e.b[k00], e.a[k11], e.b[k11]);  // 00->11
    const float lowest = std::min(std::min(e.c_bottom, e.c_right), -c_diagonal);
    const float highest = std::max(std::max(e.c_bottom, e.c_right), -c_diagonal);
    const bool agree = (lowest < 0) != (highest > 0);
    const bool lower = agree || e.c_top + (c_diagonal + e.c_left) == 0;
    if (lower) return {{e.c_right, -c_diagonal, 0, e.c_bottom}};
    return {{e.c_top, 0, c_diagonal, e.c_left}};
}

}  // namespace predicate_detail

/// True when the ray's line passes the quad; then *depth is where, along the ray's axis. The caller compares
/// the depth with its range and orders equal depths by micropolygon id. Coordinates are within
/// kLargestCoordinate: pack_grid() sees to it.
inline bool hit_micropolygon(const AxisRay& ray, const Quad& q, Facing facing, float* depth) {
    namespace d = predicate_detail;
    const d::Edges e = d::edges_of(ray, q);
    if (!d::inside(e) || !d::faces(e, facing)) return false;
    const QuadWeights w = d::weights(e);
    const float sum = (w.w[k00] + w.w[k10]) + (w.w[k01] + w.w[k11]);
    const float weighted =
        (w.w[k00] * q.z[k00] + w.w[k10] * q.z[k10]) + (w.w[k01] * q.z[k01] + w.w[k11] * q.z[k11]);
    const float z_min = std::min(std::min(q.z[k00], q.z[k10]), std::min(q.z[k01], q.z[k11]));
    const float z_max = std::max(std::max(q.z[k00], q.z[k10]), std::max(q.z[k01], q.z[k11]));
    const float z = weighted / sum;  // 0 / 0 on a degenerate triangle: taken as the nearest depth
    *depth = z >= z_min ? (z <= z_max ? z : z_max) : z_min;
    return true;
}

/// The weights of a hit that hit_micropolygon has found, for interpolating what was shaded at the corners.
inline QuadWeights hit_weights(const AxisRay& ray, const Quad& q) {
    namespace d = predicate_detail;
    QuadWeights w = d::weights(d::edges_of(ray, q));
    const float scale = 1 / ((w.w[0] + w.w[1]) + (w.w[2] + w.w[3]));
    float total = 0;
    for (float& weight : w.w) {
        const float normalised = weight * scale;
        weight = normalised > 0 ? std::min(normalised, 1.0f) : 0.0f;  // also takes NaN to 0
        total += weight;
    }
    if (!(total > 0)) return {{1, 0, 0, 0}};
    const float share = 1 / total;
    for (float& weight : w.w) weight *= share;
    return w;
}

}  // namespace trapeze
