/// Operations on points, vectors and normals.
#include "shade/vm/families.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "shade/vm/geometry.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "shade/vm/operands-inl.h"

HWY_BEFORE_NAMESPACE();
namespace trapeze::vm::HWY_NAMESPACE {
namespace {

using rsl::Op;

void dot_product(size_t lanes, Operands o) {
    const Output out(o[0]);
    const Input a(o[1]), b(o[2]);
    for (size_t i = 0; i < lanes; i += lane_count()) out.put(dot(a.get3(i), b.get3(i)), i);
}

void cross_product(size_t lanes, Operands o) {
    const Output out(o[0]);
    const Input a(o[1]), b(o[2]);
    for (size_t i = 0; i < lanes; i += lane_count()) out.put3(cross(a.get3(i), b.get3(i)), i);
}

void length(size_t lanes, Operands o) {
    const Output out(o[0]);
    const Input in(o[1]);
    for (size_t i = 0; i < lanes; i += lane_count()) {
        const V3 v = in.get3(i);
        out.put(hn::Sqrt(dot(v, v)), i);
    }
}

void distance(size_t lanes, Operands o) {
    const Output out(o[0]);
    const Input a(o[1]), b(o[2]);
    for (size_t i = 0; i < lanes; i += lane_count()) {
        const V3 v = subtract(a.get3(i), b.get3(i));
        out.put(hn::Sqrt(dot(v, v)), i);
    }
}

void normalize(size_t lanes, Operands o) {
    const Output out(o[0]);
    const Input in(o[1]);
    for (size_t i = 0; i < lanes; i += lane_count()) {
        const V3 v = in.get3(i);
        out.put3(scale(v, inverse_length(v)), i);
    }
}

/// RISpec's sign(-I.Nref) * N, but N where I.Nref is 0: a silhouette must not lose its normal.
void face_forward(size_t lanes, Operands o) {
    const Output out(o[0]);
    const Input N(o[1]), I(o[2]), reference(o[3]);
    for (size_t i = 0; i < lanes; i += lane_count()) {
        const M behind = hn::Gt(dot(I.get3(i), reference.get3(i)), hn::Zero(D()));
        const V turn = hn::IfThenElseZero(behind, set(-0.0f));
        const V3 n = N.get3(i);
        out.put3({hn::Xor(n.x, turn), hn::Xor(n.y, turn), hn::Xor(n.z, turn)}, i);
    }
}

Kernel find_geometry(Op op, std::span<const int> widths) {
    switch (op) {
        case Op::Dot:
            return widths.size() == 3 ? dot_product : nullptr;
        case Op::Cross:
            return widths.size() == 3 ? cross_product : nullptr;
        case Op::Length:
            return widths.size() == 2 ? length : nullptr;
        case Op::Distance:
            return widths.size() == 3 ? distance : nullptr;
        case Op::Normalize:
            return widths.size() == 2 ? normalize : nullptr;
        case Op::FaceForward:
            return widths.size() == 4 ? face_forward : nullptr;
        default:
            return nullptr;
    }
}

}  // namespace
}  // namespace trapeze::vm::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace trapeze::vm {

HWY_EXPORT(find_geometry);

Kernel find_geometry(rsl::Op op, std::span<const int> widths) {
    return HWY_DYNAMIC_DISPATCH(find_geometry)(op, widths);
}

}  // namespace trapeze::vm
#endif
