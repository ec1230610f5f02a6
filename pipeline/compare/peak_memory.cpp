#include "pipeline/compare/peak_memory.h"

#include <malloc.h>

#include <algorithm>
#include <fstream>
#include <limits>
#include <string>

namespace trapeze {
namespace {

/// A line "NAME:   1234 kB" of /proc/self/status, in bytes.
std::optional<size_t> status(const std::string& name) {
    std::ifstream lines("/proc/self/status");
    for (std::string word; lines >> word;) {
        size_t kilobytes = 0;
        if (word == name + ":" && lines >> kilobytes) return kilobytes * 1024;
        lines.ignore(std::numeric_limits<std::streamsize>::max(), '\n');
    }
    return {};
}

/// Sets the mark of the most memory back to what there is now.
bool reset_mark() {
    std::ofstream mark("/proc/self/clear_refs");
    mark << "5" << std::flush;
    return mark.good();
}

}  // namespace

/// Memory that has been freed is given back first: else what is taken would come from there, unseen.
PeakMemory::PeakMemory() {
#ifdef __GLIBC__
    malloc_trim(0);
#endif
    if (reset_mark()) before_ = status("VmRSS");
}

std::optional<size_t> PeakMemory::bytes() const {
    const std::optional<size_t> most = status("VmHWM");
    if (!before_ || !most) return {};
    return *most - std::min(*before_, *most);
}

}  // namespace trapeze
