#include "shade/vm/context_ops.h"

namespace trapeze::vm {

ContextOp find_context_op(rsl::Op op) {
    for (const auto find : {find_text_op, find_named_op, find_neighbour_op, find_random_op, find_map_op,
                            find_light_op, find_message_op})
        if (const ContextOp found = find(op)) return found;
    return nullptr;
}

}  // namespace trapeze::vm
