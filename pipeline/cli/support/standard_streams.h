/// Standard output and error as they may be: closed, full, or read by nobody.
#pragma once

#include <string_view>

#include "pipeline/cli/support/terminal.h"

namespace trapeze {

/// Makes the streams safe; to be called before anything is opened. Streams that are closed are opened to
/// nowhere, so that no picture takes their descriptors. A reader that goes away is an error of writing, and
/// not the end of the process, and so is a file that is larger than a limit (`ulimit -f`); programs that are
/// started get these signals as they were.
void prepare_standard_streams();

/// Prints a whole text to standard output; printed_all() says later whether that went wrong.
void print_text(std::string_view text);

/// Whether all that was printed has arrived; says on the terminal why not.
bool printed_all(Terminal& terminal);

}  // namespace trapeze
