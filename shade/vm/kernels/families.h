/// The kernels by family, a source file each; find_kernel() asks them in turn. Each returns null for what it
/// does not have.
#pragma once

#include <span>

#include "shade/vm/kernels/kernel.h"

namespace trapeze::vm {

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
