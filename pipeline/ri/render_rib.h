/// Renders RIB that is in memory.
#pragma once

#include <string>
#include <vector>

#include "pipeline/ri/errors.h"

namespace trapeze::ri {

/// Renders as the command line renders a file in the current folder: every world, maps between them,
/// displays; a world without Display writes ri.exr. Returns the messages about it. Throws nothing but
/// std::bad_alloc.
std::vector<Message> render_rib(const std::string& text, bool may_run_programs);

}  // namespace trapeze::ri
