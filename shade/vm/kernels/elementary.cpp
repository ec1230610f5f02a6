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

// Each is a function of vectors from elementary-inl.h, for floats and for triples.
constexpr KernelRow kRows[] = {
    {Op::Exp, component_kernel<exponential>},
    {Op::Log, component_kernel<logarithm>},
    {Op::Sin, component_kernel<sine>},
    {Op::Cos, component_kernel<cosine>},
    {Op::Tan, component_kernel<tangent>},
    {Op::Asin, component_kernel<arc_sine>},
    {Op::Acos, component_kernel<arc_cosine>},
    {Op::Atan, component_kernel<static_cast<V (*)(V)>(arc_tangent)>},
    {Op::Atan2, component_kernel<static_cast<V (*)(V, V)>(arc_tangent)>},
    {Op::Pow, component_kernel<power>},
    {Op::Erf, component_kernel<error_function>},
    {Op::Erfc, component_kernel<complementary_error_function>},
};

Kernel find_elementary(Op op, std::span<const int> widths) {
    return kernel_in(kRows, op, widths);
}

}  // namespace
}  // namespace trapeze::vm::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
TRAPEZE_KERNEL_FAMILY(find_elementary)
#endif
