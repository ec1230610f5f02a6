/// What a file says of how numbers of pictures stand for light (core/colors/transfer.h).
#pragma once

#include "core/colors/transfer.h"
#include "pipeline/rib/reader/request_report.h"

namespace trapeze::rib {

/// Whether the value of Option "color" "transfer", or of a "colorspace", is one that there is; an error where
/// it is not.
bool names_transfer(RequestReport& report, const Parameter& value);

/// The "colorspace" among a request's parameters; one that is not known is an error, and none.
std::optional<Transfer> colorspace_of(RequestReport& report, ParameterList& parameters);

}  // namespace trapeze::rib
