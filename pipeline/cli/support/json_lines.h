/// What the program says, as lines of JSON: `--progress json`.
#pragma once

#include <string>

#include "core/diagnostics.h"
#include "pipeline/cli/support/terminal.h"

namespace trapeze {

/// A message: {"severity", "file", "line", "column", "message"}, and "included_from" where there is one;
/// null: not known.
std::string json_line(const Diagnostic& diagnostic);

/// A step of progress: {"frame", "file", "stage", "fraction", "seconds", "estimate"}. `seconds` are since the
/// work began; the estimate, of the seconds that are left, follows from it and the fraction. Unknown values
/// are null. "waiting" is added while the work waits for something.
std::string json_line(const Work& work, double fraction, double seconds, const std::string& waiting = {});

}  // namespace trapeze
