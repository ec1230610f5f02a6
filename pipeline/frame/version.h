#pragma once

namespace trapeze {

inline constexpr const char* kVersion = TRAPEZE_VERSION;  ///< the project's version, from CMake

}  // namespace trapeze
