#include "shade/vm/context_ops.h"

#include "shade/operations/op_table.h"

namespace trapeze::vm {

/// Lights have operations that wait and no others; an operation of Maps or Rays may be of either kind, and is
/// found by the one function or the other.
ContextOp find_context_op(rsl::Op op) {
    using rsl::ContextFamily;
    switch (rsl::row_of(op).context) {
        case ContextFamily::None:
            return nullptr;
        case ContextFamily::Texts:
            return find_text_op(op);
        case ContextFamily::Arrays:
            return find_array_op(op);
        case ContextFamily::Names:
            return find_named_op(op);
        case ContextFamily::Neighbours:
            return find_neighbour_op(op);
        case ContextFamily::Random:
            return find_random_op(op);
        case ContextFamily::Maps:
            return find_map_op(op);
        case ContextFamily::Clouds:
            return find_cloud_op(op);
        case ContextFamily::Rays:
            return find_ray_op(op);
        case ContextFamily::Lights:
            return nullptr;
        case ContextFamily::Messages:
            return find_message_op(op);
    }
    return nullptr;
}

/// Null says that a step is done without leaving the coroutine, which is the cheaper way: only what may run
/// other shaders is found here.
WaitingOp find_waiting_op(rsl::Op op) {
    using rsl::ContextFamily;
    switch (rsl::row_of(op).context) {
        case ContextFamily::Maps:
            return find_waiting_map_op(op);
        case ContextFamily::Rays:
            return find_waiting_ray_op(op);
        case ContextFamily::Lights:
            return find_light_op(op);
        default:
            return nullptr;
    }
}

}  // namespace trapeze::vm
