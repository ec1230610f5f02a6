#include "shade/vm/kernels/kernel.h"

#include "shade/operations/op_table.h"
#include "shade/vm/kernels/families.h"

namespace trapeze::vm {

/// The table of operations names the family; the family's own table chooses by the widths.
Kernel find_kernel(rsl::Op op, std::span<const int> widths) {
    using rsl::KernelFamily;
    switch (rsl::row_of(op).kernels) {
        case KernelFamily::None:
            return nullptr;
        case KernelFamily::Arithmetic:
            return find_arithmetic(op, widths);
        case KernelFamily::Bools:
            return find_bools(op, widths);
        case KernelFamily::Elementary:
            return find_elementary(op, widths);
        case KernelFamily::Parts:
            return find_parts(op, widths);
        case KernelFamily::Geometry:
            return find_geometry(op, widths);
        case KernelFamily::Light:
            return find_light_kernels(op, widths);
        case KernelFamily::Matrices:
            return find_matrices(op, widths);
        case KernelFamily::Noise:
            return find_noises(op, widths);
        case KernelFamily::Splines:
            return find_splines(op, widths);
    }
    return nullptr;
}

}  // namespace trapeze::vm
