/// Elementary functions by component.
#include "shade/vm/kernels/families.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "shade/vm/kernels/elementary.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "shade/vm/kernels/elementary-inl.h"

HWY_BEFORE_NAMESPACE();
namespace trapeze::vm::HWY_NAMESPACE {
namespace {

using rsl::Op;

Kernel find_elementary(Op op, std::span<const int> widths) {
    switch (op) {
        case Op::Exp:
            return component_kernel<exponential>(widths);
        case Op::Log:
            return component_kernel<logarithm>(widths);
        case Op::Sin:
            return component_kernel<sine>(widths);
        case Op::Cos:
            return component_kernel<cosine>(widths);
        case Op::Tan:
            return component_kernel<tangent>(widths);
        case Op::Asin:
            return component_kernel<arc_sine>(widths);
        case Op::Acos:
            return component_kernel<arc_cosine>(widths);
        case Op::Atan:
            return component_kernel<static_cast<V (*)(V)>(arc_tangent)>(widths);
        case Op::Atan2:
            return component_kernel<static_cast<V (*)(V, V)>(arc_tangent)>(widths);
        case Op::Pow:
            return component_kernel<power>(widths);
        default:
            return nullptr;
    }
}

}  // namespace
}  // namespace trapeze::vm::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace trapeze::vm {

HWY_EXPORT(find_elementary);

Kernel find_elementary(rsl::Op op, std::span<const int> widths) {
    return HWY_DYNAMIC_DISPATCH(find_elementary)(op, widths);
}

}  // namespace trapeze::vm
#endif
