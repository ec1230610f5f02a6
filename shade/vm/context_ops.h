/// Operations that are no kernels: they ask the Context, or handle texts. By family, a source file each, with
/// a table of its operations; which family an operation belongs to is said in the table of operations
/// (shade/operations/op_table.def), which find_context_op() asks.
#pragma once

#include <algorithm>
#include <cstring>

#include "shade/vm/machine.h"

namespace trapeze::vm {

/// An operation of a family and what does it.
struct ContextRow {
    rsl::Op op;
    ContextOp function;
};

/// The same for an operation that may have to run other shaders first, and so is a coroutine.
struct WaitingRow {
    rsl::Op op;
    WaitingOp function;
};

/// Tables are short and asked only while a program is laid out, so that a linear search does.
inline ContextOp context_op_in(std::span<const ContextRow> rows, rsl::Op op) {
    for (const ContextRow& row : rows)
        if (row.op == op) return row.function;
    return nullptr;
}

inline WaitingOp waiting_op_in(std::span<const WaitingRow> rows, rsl::Op op) {
    for (const WaitingRow& row : rows)
        if (row.op == op) return row.function;
    return nullptr;
}

// Each returns null for an operation that the family does not have.
ContextOp find_text_op(rsl::Op op);
ContextOp find_array_op(rsl::Op op);
ContextOp find_named_op(rsl::Op op);
ContextOp find_neighbour_op(rsl::Op op);
ContextOp find_random_op(rsl::Op op);
ContextOp find_map_op(rsl::Op op);
ContextOp find_cloud_op(rsl::Op op);
ContextOp find_ray_op(rsl::Op op);
ContextOp find_message_op(rsl::Op op);
WaitingOp find_waiting_map_op(rsl::Op op);
WaitingOp find_light_op(rsl::Op op);
WaitingOp find_waiting_ray_op(rsl::Op op);

/// Says that a call of an imager sends no rays: it finds what there is where there is nothing.
void warn_of_no_rays(Run& run, const Step& step);

/// The kernel of a spline() whose basis a text names; that of the usual basis, and a warning, where there is
/// none.
Kernel spline_or_usual(Run& run, const Step& step, const std::string& name, int width);

/// Floats in a plane of an operand.
inline size_t plane_size(const Run& run, const Operand& operand) {
    return operand.lane_mask ? run.lanes() : kLanes;
}

/// All lanes of an operand's components get a value each.
inline void fill_operand(const Run& run, const Operand& out, std::span<const float> values) {
    for (size_t k = 0; k < values.size(); ++k)
        std::fill_n(out.data + k * out.stride, plane_size(run, out), values[k]);
}

/// A Bool is all bits of a lane or none, as kernels/bools.cpp has it, and goes through memory as a float.
inline void fill_bool(const Run& run, const Operand& out, bool value) {
    const uint32_t bits = value ? ~0u : 0u;
    float lane;
    std::memcpy(&lane, &bits, sizeof lane);
    std::fill_n(out.data, plane_size(run, out), lane);
}

}  // namespace trapeze::vm
