/// Sorting by Morton codes: in the time of a few passes, not of comparisons.
#pragma once

#include <cstdint>

#include "core/memory/large_pages.h"

namespace trapeze {

/// A code and the place of its item: what is sorted, for items are larger.
struct CodedItem {
    uint64_t code;
    uint32_t item;
};

/// Sorts by codes, which are below 2^bits. What has one code comes in order of `item`, as it has to come
/// here. In parallel, by radix; what comes out does not depend on threads. Takes as much memory again while
/// it sorts.
void sort_by_code(UnsetVector<CodedItem>& items, int bits);

}  // namespace trapeze
