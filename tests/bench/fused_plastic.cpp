#include "tests/bench/fused_plastic.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "tests/bench/fused_plastic.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "shade/vm/kernels/elementary-inl.h"

HWY_BEFORE_NAMESPACE();
namespace trapeze::vm::HWY_NAMESPACE {
namespace {

constexpr float kKd = 0.5f, kKs = 0.5f, kRoughness = 0.1f;

HWY_INLINE V3 unit(const V3& v) {
    return scale(v, inverse_length(v));
}

void shade(size_t lanes, const Operand& P, const Operand& N, const Operand& Cs, const Operand& Os,
           const Operand& Ci, const Operand& Oi) {
    const Input eye_ray(P), normal(N), color(Cs), opacity(Os);
    const Output out(Ci), opaque(Oi);
    const V3 L{set(0), set(0), set(-1)};
    for (size_t i = 0; i < lanes; i += lane_count()) {
        const V3 I = eye_ray.get3(i), n = unit(normal.get3(i));
        const V turn = hn::IfThenElse(hn::Lt(dot(I, n), hn::Zero(D())), set(1), set(-1));
        const V3 Nf = scale(n, turn), view = scale(unit(I), set(-1));
        const V3 half = add(view, L);
        const V cosine = at_most(positive(hn::Mul(dot(Nf, half), inverse_length(half))), set(1));
        const V facing = dot(Nf, L);
        const V lobe = hn::IfThenElseZero(hn::Gt(facing, hn::Zero(D())), pow(cosine, set(8 / kRoughness)));
        for (int k = 0; k < 3; ++k) {
            const V lit = hn::Add(hn::Mul(color.get(i, k), hn::Mul(positive(facing), set(kKd))),
                                  hn::Mul(lobe, set(kKs)));
            out.put(hn::Mul(opacity.get(i, k), lit), i, k);
            opaque.put(opacity.get(i, k), i, k);
        }
    }
}

}  // namespace
}  // namespace trapeze::vm::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace trapeze::vm {

HWY_EXPORT(shade);

void fused_plastic(size_t lanes, const Operand& P, const Operand& N, const Operand& Cs, const Operand& Os,
                   const Operand& Ci, const Operand& Oi) {
    HWY_DYNAMIC_DISPATCH(shade)(lanes, P, N, Cs, Os, Ci, Oi);
}

}  // namespace trapeze::vm
#endif
