#include "core/memory/large_pages.h"

#include <sys/mman.h>

#include <cstdlib>

namespace trapeze {

void* large_memory(size_t bytes) {
    if (bytes > ~size_t{0} / 2) throw std::bad_alloc();  // rounding up could wrap
    const bool large = bytes >= kLargePage;
    const size_t alignment = large ? kLargePage : 64, whole = (bytes + alignment - 1) & ~(alignment - 1);
    void* const memory = std::aligned_alloc(alignment, whole);
    if (!memory) throw std::bad_alloc();
#ifdef MADV_HUGEPAGE
    // Where the system has no such pages, memory is as any.
    if (large) madvise(memory, whole, MADV_HUGEPAGE);
#endif
    return memory;
}

}  // namespace trapeze
