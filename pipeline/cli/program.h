#pragma once

#include <span>

#include "core/diagnostics.h"
#include "pipeline/cli/support/arguments.h"
#include "pipeline/cli/support/terminal.h"

namespace trapeze {

/// A command, and the function that does its work and returns the exit code.
struct CommandFunction {
    Command command;
    int (*run)(const Arguments& arguments, Terminal& terminal, Diagnostics& diagnostics);
};

/// What a program of ours does, from its command line to its exit code. Both programs, the renderer and the
/// laboratory, read all commands; of one that is not among `functions`, `otherwise` gives the exit code.
int run_program(int argc, char** argv, std::span<const CommandFunction> functions,
                int (*otherwise)(char** argv));

}  // namespace trapeze
