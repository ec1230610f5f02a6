/// Fetching what is read a little later.
#pragma once

#include <hwy/base.h>

#include <cstddef>

namespace trapeze {

/// Fetches some bytes, at least one, line by line. What does nothing but fetch is inlined: GCC takes calls of
/// it for calls without effect, and leaves them out.
HWY_INLINE void fetch(const void* from, size_t bytes) {
    const char* const first = static_cast<const char*>(from);
    for (size_t at = 0; at < bytes; at += 64) __builtin_prefetch(first + at);
    __builtin_prefetch(first + bytes - 1);
}

}  // namespace trapeze
