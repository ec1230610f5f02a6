/// Scenes from strangers: how a run is asked for that confines them (Access), and what bounds it then.
#pragma once

#include <cstddef>

namespace trapeze {

/// Whether TRAPEZE_SAFE is set in the environment, to anything but nothing or 0.
bool safe_by_environment();

/// Bytes, where the user says nothing: four gibibytes, or less on a small machine.
size_t safe_memory_budget();

/// Seconds, where the user says nothing.
inline constexpr double kSafeSeconds = 600;

}  // namespace trapeze
