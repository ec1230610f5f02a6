#include "core/memory/large_pages.h"

#include <sys/mman.h>

#include <cstdlib>

namespace trapeze {
namespace {

/// Bytes that no machine has addresses for; sanitizers end the program where so much is asked for.
constexpr size_t kMostAddressed = size_t{1} << 47;

}  // namespace

void* large_memory(size_t bytes) {
    if (bytes > kMostAddressed) throw std::bad_alloc();
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
