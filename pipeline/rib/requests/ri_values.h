/// PRMan since version 22 writes options and attributes that have requests of their own as values of the
/// category "Ri": Option "Ri" "int[2] FormatResolution" [640 480].
#pragma once

#include "pipeline/rib/reader/request_context.h"

namespace trapeze::rib {

/// Executes the request that sets the value; false when there is none. A value that its request does not
/// accept ends the Option or Attribute request around it with a RequestError.
bool execute_ri_value(OptionContext& context, const Parameter& value);

}  // namespace trapeze::rib
