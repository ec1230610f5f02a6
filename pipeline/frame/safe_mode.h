/// Scenes from strangers: how a run is asked for that confines them (Access), and what bounds it then.
#pragma once

#include <cstddef>

namespace trapeze {

/// Whether TRAPEZE_SAFE is set in the environment, to anything but nothing or 0.
bool safe_by_environment();

/// The memory budget of a confined run where the user gives none, in bytes: four gibibytes, or less on a
/// small machine.
size_t safe_memory_budget();

/// The time limit of a confined run where the user gives none, in seconds.
inline constexpr double kSafeSeconds = 600;

}  // namespace trapeze
