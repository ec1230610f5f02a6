/// The viewers of a run, as the command line asks for them.
#pragma once

#include <memory>

#include "core/diagnostics.h"
#include "pipeline/cli/support/arguments.h"
#include "pipeline/cli/support/terminal.h"
#include "pipeline/preview/preview.h"

namespace trapeze {

/// Null where nobody is to watch. A viewer that cannot be is told in a note, as one that goes away later: the
/// run needs none. The terminal says where a page is.
std::unique_ptr<Preview> preview_of(const Arguments& arguments, Terminal& terminal, Diagnostics& diagnostics);

}  // namespace trapeze
