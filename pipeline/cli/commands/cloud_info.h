/// `trapeze info` of point clouds.
#pragma once

#include <string>

#include "core/diagnostics.h"
#include "core/files/access.h"
#include "pipeline/cli/support/arguments.h"

namespace trapeze {

/// By its ending: .ptc or .ply.
bool names_point_cloud(const std::string& input);

/// Prints what is in the inputs, all of which are taken for point clouds. Returns the exit code.
int cloud_info(const Arguments& arguments, const Access& access, Diagnostics& diagnostics);

}  // namespace trapeze
