/// Whether a run has looked for shaders in vain, which has an exit code of its own under --strict.
#pragma once

#include <algorithm>

#include "core/diagnostics.h"

namespace trapeze {

inline bool has_missing_shader(const Diagnostics& diagnostics) {
    const auto kinds = diagnostics.kinds();
    return std::any_of(kinds.begin(), kinds.end(),
                       [](const auto& kind) { return kind.first.starts_with("missing-shader"); });
}

}  // namespace trapeze
