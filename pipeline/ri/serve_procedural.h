/// The far side of Procedural "DynamicLoad" (RISpec 5.8): a process of its own loads the library and speaks
/// the protocol of "RunProgram", so that what the library does to memory, or for how long, is not the
/// renderer's.
#pragma once

#include <string>

namespace trapeze {

/// Answers requests on standard input, "DETAIL ARGUMENTS" a line, with the RIB of what the library's
/// Subdivide() calls, and a byte 0377; until the input ends. Returns the exit code: 1 when the library cannot
/// be loaded or has no ConvertParameters(), Subdivide() or Free(), with the reason on stderr.
int serve_procedural(const std::string& library);

}  // namespace trapeze
