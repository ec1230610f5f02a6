/// The parameters of lights for which illuminance blocks send values ("send:light:NAME").
#pragma once

#include <set>
#include <string>

#include "shade/code/program.h"

namespace trapeze {

/// Adds the names for which a program sends values.
void add_sent_names(const rsl::Program& program, std::set<std::string>& names);

}  // namespace trapeze
