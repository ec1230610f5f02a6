#pragma once

#include "core/diagnostics.h"
#include "pipeline/cli/support/arguments.h"
#include "pipeline/cli/support/terminal.h"

namespace trapeze {

/// The laboratory's commands, a program of their own. Each returns the exit code.
int compare_command(const Arguments& arguments, Terminal& terminal, Diagnostics& diagnostics);
int study_command(const Arguments& arguments, Terminal& terminal, Diagnostics& diagnostics);
int scene_command(const Arguments& arguments, Terminal& terminal, Diagnostics& diagnostics);

}  // namespace trapeze
