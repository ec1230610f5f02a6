/// Standard output and error as they may be: closed, full, or read by nobody.
#pragma once

#include <string_view>

#include "pipeline/cli/support/terminal.h"

namespace trapeze {

/// Before anything is opened. Streams that are closed are opened to nowhere, so that no picture takes their
/// places; a reader that goes away is an error of writing and not the end of the process. Programs that
/// are started have SIGPIPE as they had.
void prepare_standard_streams();

/// Prints a whole text; what goes wrong is for printed_all().
void print_text(std::string_view text);

/// Whether all that was printed has arrived; says why not.
bool printed_all(Terminal& terminal);

}  // namespace trapeze
