/// Values of the parts of a shape that stay when others are left out.
#pragma once

#include <utility>
#include <vector>

#include "core/scene/parameters.h"

namespace trapeze::rib {

/// Keeps those runs of `item` values whose place in `kept` is not 0, in their order. In place: what stays
/// moves towards the front, never past what has not been read. `values` holds `item` of them for each element
/// of `kept`.
template <class Value>
void select_values(std::vector<Value>& values, const std::vector<char>& kept, size_t item = 1) {
    size_t to = 0;
    for (size_t from = 0; from < kept.size(); ++from) {
        if (!kept[from]) continue;
        for (size_t k = 0; k < item; ++k, ++to)
            if (to != from * item + k) values[to] = std::move(values[from * item + k]);
    }
    values.resize(to);
}

/// Keeps items of a variable, each of which may be an array, in the same way.
inline void select_items(Parameter& variable, const std::vector<char>& kept) {
    if (variable.is_string())
        select_values(variable.strings, kept, static_cast<size_t>(variable.declaration.array_length));
    else
        select_values(variable.floats, kept, static_cast<size_t>(variable.declaration.floats_per_item()));
}

}  // namespace trapeze::rib
