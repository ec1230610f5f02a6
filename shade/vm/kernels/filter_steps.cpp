// The part of neighbours.h that goes lane by lane.
#include "shade/vm/kernels/neighbours.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "shade/vm/kernels/filter_steps.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "shade/vm/kernels/operands-inl.h"

HWY_BEFORE_NAMESPACE();
namespace trapeze::vm::HWY_NAMESPACE {
namespace {

/// The share above an edge of what lies from x to x + width. This is the convolution of a step with a box
/// filter, which is all that filterstep() promises.
HWY_INLINE V share_above(V edge, V x, V width) {
    const V share = hn::Div(hn::Sub(hn::Add(x, width), edge), width);
    const V step_there = hn::IfThenZeroElse(hn::Lt(x, edge), set(1));
    return hn::IfThenElse(hn::Gt(width, hn::Zero(D())), at_most(positive(share), set(1)), step_there);
}

/// An interval of width * scale_by with x in its middle.
void step_around(size_t lanes, const Operand& edges, const Operand& xs, const Operand& widths, float scale_by,
                 const Operand& result) {
    const Input edge(edges), x(xs), width(widths);
    const Output out(result);
    for (size_t i = 0; i < lanes; i += lane_count()) {
        const V w = hn::Mul(width.get(i), set(scale_by));
        out.put(share_above(edge.get(i), hn::Sub(x.get(i), hn::Mul(w, set(0.5f))), w), i);
    }
}

/// The interval from the lesser to the greater of two values. The interval has no filter's width of its own:
/// it is what the shader says x runs over.
void step_between(size_t lanes, const Operand& edges, const Operand& xs, const Operand& x2s,
                  const Operand& result) {
    const Input edge(edges), first(xs), second(x2s);
    const Output out(result);
    for (size_t i = 0; i < lanes; i += lane_count()) {
        const V a = first.get(i), b = second.get(i), least = at_most(a, b);
        out.put(share_above(edge.get(i), least, hn::Sub(at_least(a, b), least)), i);
    }
}

}  // namespace
}  // namespace trapeze::vm::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace trapeze::vm {

HWY_EXPORT(step_around);
HWY_EXPORT(step_between);

void filter_step(size_t lanes, const Operand& edge, const Operand& x, const Operand& width, float scale,
                 const Operand& out) {
    HWY_DYNAMIC_DISPATCH(step_around)(lanes, edge, x, width, scale, out);
}
void filter_step_between(size_t lanes, const Operand& edge, const Operand& x, const Operand& x2,
                         const Operand& out) {
    HWY_DYNAMIC_DISPATCH(step_between)(lanes, edge, x, x2, out);
}

}  // namespace trapeze::vm
#endif
