#pragma once

#include "core/diagnostics.h"
#include "pipeline/cli/support/arguments.h"
#include "pipeline/cli/support/terminal.h"

namespace trapeze {

/// The renderer's commands. Each returns the exit code.
int render_command(const Arguments& arguments, Terminal& terminal, Diagnostics& diagnostics);
int farm_command(const Arguments& arguments, Terminal& terminal, Diagnostics& diagnostics);
int merge_command(const Arguments& arguments, Terminal& terminal, Diagnostics& diagnostics);
int check_command(const Arguments& arguments, Terminal& terminal, Diagnostics& diagnostics);
int info_command(const Arguments& arguments, Terminal& terminal, Diagnostics& diagnostics);
int cat_command(const Arguments& arguments, Terminal& terminal, Diagnostics& diagnostics);
int compliance_command(const Arguments& arguments, Terminal& terminal, Diagnostics& diagnostics);
int shader_command(const Arguments& arguments, Terminal& terminal, Diagnostics& diagnostics);

}  // namespace trapeze
