#pragma once

namespace trapeze {

/// Its file, which lies where modules do.
inline constexpr const char* kLaboratory = "trapeze-laboratory";

/// Goes on as the laboratory's program, with these words. Comes back only where that cannot be: reports why,
/// and returns the exit code.
int become_laboratory(char** argv);

}  // namespace trapeze
