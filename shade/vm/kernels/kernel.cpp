#include "shade/vm/kernels/kernel.h"

#include "shade/vm/kernels/families.h"

namespace trapeze::vm {

Kernel find_kernel(rsl::Op op, std::span<const int> widths) {
    for (const auto find : {find_arithmetic, find_bools, find_elementary, find_parts, find_geometry,
                            find_matrices, find_noises, find_splines, find_light_kernels})
        if (const Kernel kernel = find(op, widths)) return kernel;
    return nullptr;
}

}  // namespace trapeze::vm
