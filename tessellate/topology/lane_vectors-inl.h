/// Vectors of three floats in lanes, and how matrices turn them: in the order of operations of
/// transform_vector() and transform_point(), for the same bits. Compiled once a target; see Highway's
/// foreach_target.h.
#if defined(TRAPEZE_TESSELLATE_LANE_VECTORS_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef TRAPEZE_TESSELLATE_LANE_VECTORS_INL_H_
#undef TRAPEZE_TESSELLATE_LANE_VECTORS_INL_H_
#else
#define TRAPEZE_TESSELLATE_LANE_VECTORS_INL_H_
#endif

#include <hwy/highway.h>

#include "core/math.h"

HWY_BEFORE_NAMESPACE();
namespace trapeze {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

template <class D>
struct LaneVectors {
    using Lanes = hn::Vec<D>;
    Lanes x, y, z;

    HWY_INLINE Lanes length2() const { return hn::Add(hn::Add(hn::Mul(x, x), hn::Mul(y, y)), hn::Mul(z, z)); }
    HWY_INLINE LaneVectors operator*(Lanes by) const {
        return {hn::Mul(x, by), hn::Mul(y, by), hn::Mul(z, by)};
    }
};

template <class D>
HWY_INLINE hn::Vec<D> dot(const LaneVectors<D>& a, const LaneVectors<D>& b) {
    return hn::Add(hn::Add(hn::Mul(a.x, b.x), hn::Mul(a.y, b.y)), hn::Mul(a.z, b.z));
}
template <class D>
HWY_INLINE LaneVectors<D> difference(const LaneVectors<D>& a, const LaneVectors<D>& b) {
    return {hn::Sub(a.x, b.x), hn::Sub(a.y, b.y), hn::Sub(a.z, b.z)};
}
template <class D>
HWY_INLINE LaneVectors<D> cross(const LaneVectors<D>& a, const LaneVectors<D>& b) {
    return {hn::Sub(hn::Mul(a.y, b.z), hn::Mul(a.z, b.y)), hn::Sub(hn::Mul(a.z, b.x), hn::Mul(a.x, b.z)),
            hn::Sub(hn::Mul(a.x, b.y), hn::Mul(a.y, b.x))};
}

template <class D>
HWY_INLINE LaneVectors<D> transformed_vectors(D d, const M44f& m, const LaneVectors<D>& v) {
    const auto component = [&](int k) HWY_ATTR {
        return hn::Add(hn::Add(hn::Mul(v.x, hn::Set(d, m[0][k])), hn::Mul(v.y, hn::Set(d, m[1][k]))),
                       hn::Mul(v.z, hn::Set(d, m[2][k])));
    };
    return {component(0), component(1), component(2)};
}

/// Points are turned like vectors and then moved; no division, as matrices here are affine.
template <class D>
HWY_INLINE LaneVectors<D> transformed_points(D d, const M44f& m, const LaneVectors<D>& p) {
    const LaneVectors<D> turned = transformed_vectors(d, m, p);
    return {hn::Add(turned.x, hn::Set(d, m[3][0])), hn::Add(turned.y, hn::Set(d, m[3][1])),
            hn::Add(turned.z, hn::Set(d, m[3][2]))};
}

}  // namespace HWY_NAMESPACE
}  // namespace trapeze
HWY_AFTER_NAMESPACE();

#endif  // per-target include guard
