/// The names that RIB has for functions and matrices of C.
#pragma once

#include "pipeline/ri/ri.h"

namespace trapeze::ri {

/// Throws RIE_MISSINGDATA for null, RIE_INCAPABLE for a function that is not of ri.h.
const char* filter_name(RtFilterFunc filter);

/// Null when it is none of RISpec's.
const char* basis_name(const RtFloat (*basis)[4]);

}  // namespace trapeze::ri
