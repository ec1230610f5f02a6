/// The kernels by family, a source file each, and the form that all of them share.
///
/// A family's file is compiled once for each instruction set (Highway's foreach_target.h). In each it has a
/// table `kRows` of its operations and the function that finds one in it, and it ends with
/// TRAPEZE_KERNEL_FAMILY, which makes of them the function declared here. Which operations a family has is
/// said a second time in the table of operations, for find_kernel(); op_table_test.cpp holds both together.
#pragma once

#include <span>

#include "shade/vm/kernels/kernel.h"

namespace trapeze::vm {

/// An operation of a family, and what chooses its kernel by the widths of the operands, outputs first; null
/// for widths that it does not know.
struct KernelRow {
    rsl::Op op;
    Kernel (*choose)(std::span<const int> widths);
};

/// The kernel of a family's table; null for an operation that is not in it. Every kernel has an output.
inline Kernel kernel_in(std::span<const KernelRow> rows, rsl::Op op, std::span<const int> widths) {
    for (const KernelRow& row : rows)
        if (row.op == op && !widths.empty()) return row.choose(widths);
    return nullptr;
}

// Each returns null for an operation that the family does not have. The kernels are those of the best
// instruction set that the machine has and the user allows (core/simd/simd_limit.h).
Kernel find_arithmetic(rsl::Op op, std::span<const int> widths);
Kernel find_bools(rsl::Op op, std::span<const int> widths);
Kernel find_elementary(rsl::Op op, std::span<const int> widths);
Kernel find_parts(rsl::Op op, std::span<const int> widths);
Kernel find_geometry(rsl::Op op, std::span<const int> widths);
Kernel find_light_kernels(rsl::Op op, std::span<const int> widths);
Kernel find_matrices(rsl::Op op, std::span<const int> widths);
Kernel find_noises(rsl::Op op, std::span<const int> widths);
Kernel find_splines(rsl::Op op, std::span<const int> widths);

}  // namespace trapeze::vm

/// Defines a family's function as a call of the one of the same name in the best instruction set's namespace.
/// Stands at the end of its file, where HWY_ONCE is true.
#define TRAPEZE_KERNEL_FAMILY(find)                        \
    namespace trapeze::vm {                                \
    HWY_EXPORT(find);                                      \
    Kernel find(rsl::Op op, std::span<const int> widths) { \
        return HWY_DYNAMIC_DISPATCH(find)(op, widths);     \
    }                                                      \
    }
