/// The names that RIB has for functions and matrices of C.
#pragma once

#include "pipeline/ri/ri.h"

namespace trapeze::ri {

/// RIB's name of a filter function, such as "gaussian". Throws RIE_MISSINGDATA for null, RIE_INCAPABLE for a
/// function that is not of ri.h, since RIB cannot carry it.
const char* filter_name(RtFilterFunc filter);

/// RIB's name of a basis matrix; null when it is none of RISpec's, and is written as numbers.
const char* basis_name(const RtFloat (*basis)[4]);

}  // namespace trapeze::ri
