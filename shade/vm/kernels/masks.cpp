#include "shade/vm/kernels/masks.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "shade/vm/kernels/masks.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "shade/vm/kernels/operands-inl.h"

HWY_BEFORE_NAMESPACE();
namespace trapeze::vm::HWY_NAMESPACE {
namespace {

bool any_of(size_t lanes, const Operand& mask) {
    const Input in(mask);
    V seen = hn::Zero(D());
    for (size_t i = 0; i < lanes; i += lane_count()) seen = hn::Or(seen, in.get(i));
    return !hn::AllFalse(D(), hn::MaskFromVec(seen));
}

/// Both look at all lanes without leaving early: batches are some hundred lanes, and a branch each costs
/// more.
bool all_of(size_t lanes, const Operand& mask) {
    const Input in(mask);
    V seen = in.get(0);
    for (size_t i = 0; i < lanes; i += lane_count()) seen = hn::And(seen, in.get(i));
    return hn::AllTrue(D(), hn::MaskFromVec(seen));
}

/// Lanes that are set are -1 as integers.
size_t count_of(size_t lanes, const Operand& mask) {
    const DI di;
    const Input in(mask);
    VI sum = hn::Zero(di);
    size_t i = 0;
    for (; i + lane_count() <= lanes; i += lane_count()) sum = hn::Sub(sum, hn::BitCast(di, in.get(i)));
    // The last vector may hold lanes of no vertex, which are not to be counted.
    const M inside = hn::FirstN(D(), lanes - i);
    if (i < lanes) sum = hn::Sub(sum, hn::BitCast(di, hn::IfThenElseZero(inside, in.get(i))));
    return static_cast<size_t>(hn::GetLane(hn::SumOfLanes(di, sum)));
}

/// A component after the other, so that a plane is read and written as it lies in memory.
void move_where(size_t lanes, int width, const Operand& mask, const Operand& from, const Operand& to) {
    const Input where(mask), in(from);
    const Output out(to);
    for (int k = 0; k < width; ++k)
        for (size_t i = 0; i < lanes; i += lane_count())
            out.put(hn::IfThenElse(where.mask(i), in.get(i, k), out.get(i, k)), i, k);
}

HWY_INLINE V both(V a, V b) {
    return hn::And(a, b);
}
HWY_INLINE V either(V a, V b) {
    return hn::Or(a, b);
}
HWY_INLINE V first_only(V a, V b) {
    return hn::AndNot(b, a);
}
HWY_INLINE V complement(V a) {
    return hn::Not(a);
}

void combine_and(size_t lanes, Operands o) {
    by_component<both, 1>(lanes, o);
}
void combine_or(size_t lanes, Operands o) {
    by_component<either, 1>(lanes, o);
}
void combine_and_not(size_t lanes, Operands o) {
    by_component<first_only, 1>(lanes, o);
}
void combine_not(size_t lanes, Operands o) {
    by_component<complement, 1>(lanes, o);
}

}  // namespace
}  // namespace trapeze::vm::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
#include <array>
#include <bit>

namespace trapeze::vm {

HWY_EXPORT(any_of);
HWY_EXPORT(all_of);
HWY_EXPORT(count_of);
HWY_EXPORT(move_where);
HWY_EXPORT(combine_and);
HWY_EXPORT(combine_or);
HWY_EXPORT(combine_and_not);
HWY_EXPORT(combine_not);

void fill_mask(size_t lanes, bool value, const Operand& out) {
    std::fill_n(out.data, lanes, std::bit_cast<float>(value ? ~uint32_t{0} : uint32_t{0}));
}
void mask_and(size_t lanes, const Operand& a, const Operand& b, const Operand& out) {
    HWY_DYNAMIC_DISPATCH(combine_and)(lanes, std::array{out, a, b});
}
void mask_or(size_t lanes, const Operand& a, const Operand& b, const Operand& out) {
    HWY_DYNAMIC_DISPATCH(combine_or)(lanes, std::array{out, a, b});
}
void mask_and_not(size_t lanes, const Operand& a, const Operand& b, const Operand& out) {
    HWY_DYNAMIC_DISPATCH(combine_and_not)(lanes, std::array{out, a, b});
}
void mask_not(size_t lanes, const Operand& a, const Operand& out) {
    HWY_DYNAMIC_DISPATCH(combine_not)(lanes, std::array{out, a});
}
bool any_lane(size_t lanes, const Operand& mask) {
    return HWY_DYNAMIC_DISPATCH(any_of)(lanes, mask);
}
bool all_lanes(size_t lanes, const Operand& mask) {
    return HWY_DYNAMIC_DISPATCH(all_of)(lanes, mask);
}
size_t count_lanes(size_t lanes, const Operand& mask) {
    return HWY_DYNAMIC_DISPATCH(count_of)(lanes, mask);
}
void masked_move(size_t lanes, int width, const Operand& mask, const Operand& from, const Operand& to) {
    HWY_DYNAMIC_DISPATCH(move_where)(lanes, width, mask, from, to);
}

}  // namespace trapeze::vm
#endif
