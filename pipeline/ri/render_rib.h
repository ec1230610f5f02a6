/// Renders RIB that is in memory.
#pragma once

#include <string>
#include <vector>

#include "pipeline/ri/errors.h"

namespace trapeze::ri {

/// As the command line renders a file in the current folder: every world, maps between them, displays; a
/// world without Display writes ri.exr. What is to be said of it comes back; nothing is thrown but
/// std::bad_alloc.
std::vector<Message> render_rib(const std::string& text, bool may_run_programs);

}  // namespace trapeze::ri
