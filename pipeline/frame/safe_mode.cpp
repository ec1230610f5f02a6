#include "pipeline/frame/safe_mode.h"

#include <algorithm>
#include <cstdlib>
#include <string_view>

#include "pipeline/frame/frame_memory.h"

namespace trapeze {

bool safe_by_environment() {
    const char* const value = std::getenv("TRAPEZE_SAFE");
    return value && *value && std::string_view(value) != "0";
}

size_t safe_memory_budget() {
    return std::min(default_memory_budget(), size_t{4} << 30);
}

}  // namespace trapeze
