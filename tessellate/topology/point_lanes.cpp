#include "tessellate/topology/point_lanes.h"

#include <algorithm>
#include <cmath>
#include <limits>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "tessellate/topology/point_lanes.cpp"
#include <hwy/foreach_target.h>  // compiles this file once a target
#include <hwy/highway.h>

#include "tessellate/topology/lane_vectors-inl.h"

#ifndef TRAPEZE_TESSELLATE_POINT_LANES_ONCE
#define TRAPEZE_TESSELLATE_POINT_LANES_ONCE
namespace trapeze {

/// Sine of the angle between derivatives below which their cross product is mostly rounding.
constexpr float kParallelDerivatives = 1e-5f;

}  // namespace trapeze
#endif

HWY_BEFORE_NAMESPACE();
namespace trapeze {
namespace HWY_NAMESPACE {
/// Grids have some tens of vertices: longer vectors would be half empty.
constexpr size_t kMostLanes = 8;
using F = hn::CappedTag<float, kMostLanes>;
using Lanes = hn::Vec<F>;

using LaneVector = LaneVectors<F>;

/// Calls f(first, count) for runs of as many points as there are lanes, and one for what is left.
template <class Body>
HWY_INLINE void for_runs(size_t size, const Body& f) {
    const size_t lanes = hn::Lanes(F());
    size_t first = 0;
    for (; first + lanes <= size; first += lanes) f(first, lanes);
    if (first < size) f(first, size - first);
}

/// Three floats a vector, unpacked to planes; what is not there is read as 0.
HWY_INLINE LaneVector loaded(const V3f* vectors, size_t count) {
    const F d;
    LaneVector v;
    if (count == hn::Lanes(d)) {
        hn::LoadInterleaved3(d, &vectors->x, v.x, v.y, v.z);
        return v;
    }
    HWY_ALIGN float buffer[3 * kMostLanes] = {};
    std::copy_n(&vectors->x, 3 * count, buffer);
    hn::LoadInterleaved3(d, buffer, v.x, v.y, v.z);
    return v;
}

HWY_INLINE void store(const LaneVector& v, V3f* vectors, size_t count) {
    const F d;
    if (count == hn::Lanes(d)) return hn::StoreInterleaved3(v.x, v.y, v.z, d, &vectors->x);
    HWY_ALIGN float buffer[3 * kMostLanes];
    hn::StoreInterleaved3(v.x, v.y, v.z, d, buffer);
    std::copy_n(buffer, 3 * count, &vectors->x);
}

HWY_INLINE void store(const LaneVector& v, Triples& planes, size_t first, size_t count) {
    const F d;
    const Lanes values[3] = {v.x, v.y, v.z};
    for (int k = 0; k < 3; ++k) {
        float* const plane = planes.c[k].data() + first;
        if (count == hn::Lanes(d)) {
            hn::StoreU(values[k], d, plane);
            continue;
        }
        HWY_ALIGN float buffer[kMostLanes];
        hn::Store(values[k], d, buffer);
        std::copy_n(buffer, count, plane);
    }
}

/// Vectors are not moved by the matrix' last row.
void transform_lanes(const M44f& m, const V3f* in, size_t size, bool points, V3f* out) {
    const F d;
    for_runs(size, [&](size_t first, size_t count) {
        const LaneVector v = loaded(in + first, count);
        const LaneVector moved = points ? transformed_points(d, m, v) : transformed_vectors(d, m, v);
        store(moved, out + first, count);
    });
}

void planes_of(const V3f* vectors, size_t size, float scale, Triples& planes) {
    const Lanes by = hn::Set(F(), scale);
    for_runs(size, [&](size_t first, size_t count) {
        const LaneVector v = loaded(vectors + first, count);
        store(v * by, planes, first, count);
    });
}

/// Vectors whose largest component is 1, or 0.
HWY_INLINE LaneVector scaled(const LaneVector& v) {
    const F d;
    const auto larger = [](Lanes a, Lanes b) { return hn::IfThenElse(hn::Lt(a, b), b, a); };
    const Lanes largest = larger(larger(hn::Abs(v.x), hn::Abs(v.y)), hn::Abs(v.z));
    const auto has =
        hn::And(hn::Gt(largest, hn::Zero(d)), hn::Le(largest, hn::Set(d, std::numeric_limits<float>::max())));
    const Lanes scale = hn::IfThenElseZero(has, hn::Div(hn::Set(d, 1), largest));
    return v * scale;
}

/// As unit_normal(), operation by operation.
void normals_of(const V3f* dPdu, const V3f* dPdv, size_t size, Triples& normals) {
    const F d;
    for_runs(size, [&](size_t first, size_t count) {
        const LaneVector u = scaled(loaded(dPdu + first, count)), v = scaled(loaded(dPdv + first, count));
        const Lanes x = hn::Sub(hn::Mul(u.y, v.z), hn::Mul(u.z, v.y));
        const Lanes y = hn::Sub(hn::Mul(u.z, v.x), hn::Mul(u.x, v.z));
        const Lanes z = hn::Sub(hn::Mul(u.x, v.y), hn::Mul(u.y, v.x));
        const Lanes length = hn::Sqrt(LaneVector{x, y, z}.length2());
        const auto has = hn::Gt(length, hn::Set(d, kParallelDerivatives));
        store({hn::IfThenElseZero(has, hn::Div(x, length)), hn::IfThenElseZero(has, hn::Div(y, length)),
               hn::IfThenElseZero(has, hn::Div(z, length))},
              normals, first, count);
    });
}

}  // namespace HWY_NAMESPACE
}  // namespace trapeze
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace trapeze {

HWY_EXPORT(transform_lanes);
HWY_EXPORT(planes_of);
HWY_EXPORT(normals_of);

/// Zero where the derivatives are parallel, or one of them has no length.
V3f unit_normal(const V3f& dPdu, const V3f& dPdv) {
    // Scaled first: derivatives of tiny faces have squares that underflow.
    const auto scale = [](const V3f& v) {
        const float largest = std::max({std::abs(v.x), std::abs(v.y), std::abs(v.z)});
        return largest > 0 && std::isfinite(largest) ? 1 / largest : 0.0f;
    };
    const V3f u = dPdu * scale(dPdu), v = dPdv * scale(dPdv);
    const V3f n = u.cross(v);
    const float length = std::sqrt(n.dot(n));
    return length > kParallelDerivatives ? n / length : V3f(0, 0, 0);
}

void transform_points(const M44f& m, std::span<const V3f> in, V3f* out) {
    HWY_DYNAMIC_DISPATCH(transform_lanes)(m, in.data(), in.size(), true, out);
}

void transform_vectors(const M44f& m, std::span<V3f> vectors) {
    HWY_DYNAMIC_DISPATCH(transform_lanes)(m, vectors.data(), vectors.size(), false, vectors.data());
}

void to_planes(std::span<const V3f> vectors, float scale, Triples& planes) {
    HWY_DYNAMIC_DISPATCH(planes_of)(vectors.data(), vectors.size(), scale, planes);
}

void unit_normals(std::span<const V3f> dPdu, std::span<const V3f> dPdv, Triples& normals) {
    HWY_DYNAMIC_DISPATCH(normals_of)(dPdu.data(), dPdv.data(), dPdu.size(), normals);
}

}  // namespace trapeze
#endif
