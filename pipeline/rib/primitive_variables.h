#pragma once

#include "pipeline/rib/reader.h"

namespace trapeze::rib {

/// Checks a primitive's parameter list against its topology: points of a wrong number end the request; other
/// variables of a wrong length are reported and left out. "st" becomes "s" and "t", "Pz" becomes "P".
ParameterList checked_variables(Reader& reader, ParameterList list, const Topology& topology);

/// Numbers of points that the list holds in "P", "Pw" or "Pz"; 0 when there is none.
int point_count_of(const ParameterList& list);

}  // namespace trapeze::rib
