/// How the grid machine calls its arithmetic. A register's components are planes of floats, one for each
/// vertex; a uniform register's planes are kLanes equal floats, and the kernels, which read planes through
/// Operand::lane_mask, need no second form for them.
///
/// A kernel is one pass over all lanes of a batch, which has no branches and keeps nothing: it may compute
/// lanes that hold no vertex, or whose vertices do not run, and never traps on what it finds there.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "shade/operations/op.h"
#include "shade/planes/planes.h"

namespace trapeze::vm {

/// One register as kernels see it. All planes are 64-byte aligned and padded as planes.h says. It is a view:
/// Registers or the scratch of a run own the planes, and a kernel never keeps one beyond its call.
struct Operand {
    float* data = nullptr;  ///< component 0
    size_t lane_mask = 0;   ///< lane i is at data[i & lane_mask]: ~0 varying, 0 uniform (i is a multiple of
                            ///< the vector's length)
    size_t stride = 0;      ///< floats from a component to the next; 0: one component serves for all
    size_t element_stride = 0;  ///< of an array: floats from an element's component 0 to the next's
    int length = 0;             ///< of an array: elements
};

/// Runs over lanes 0, N, 2N ... < lanes (a multiple of kLanes). Outputs stand first; they may be inputs too,
/// lane by lane: a kernel reads a lane group's inputs before it writes its outputs.
using Kernel = void (*)(size_t lanes, std::span<const Operand> operands);

/// The kernel of an operation for operands of these widths (1, 3 or 16; outputs first), in the best
/// instruction set; null when there is none. Thread-safe.
Kernel find_kernel(rsl::Op op, std::span<const int> widths);

}  // namespace trapeze::vm
