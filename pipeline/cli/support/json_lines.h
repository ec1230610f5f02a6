/// What the program says, as lines of JSON: `--progress json`.
#pragma once

#include <string>

#include "core/diagnostics.h"
#include "pipeline/cli/support/terminal.h"

namespace trapeze {

/// {"severity", "file", "line", "column", "message"}, and "included_from" where there is one; null: not
/// known.
std::string json_line(const Diagnostic& diagnostic);

/// {"frame", "file", "stage", "fraction", "seconds", "estimate"}: since the work began, and that are left by
/// the fraction; null: not known. And "waiting", for what, where the work does.
std::string json_line(const Work& work, double fraction, double seconds, const std::string& waiting = {});

}  // namespace trapeze
