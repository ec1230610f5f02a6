#include "pipeline/frame/cost/frame_stats.h"

#include <sys/resource.h>

namespace trapeze {

uint64_t peak_resident_bytes() {
    rusage usage{};
    if (getrusage(RUSAGE_SELF, &usage) != 0) return 0;
    return static_cast<uint64_t>(usage.ru_maxrss) * 1024;  // Linux counts kilobytes
}

}  // namespace trapeze
