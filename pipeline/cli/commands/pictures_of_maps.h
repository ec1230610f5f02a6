/// The pictures that an input makes maps of, found before anything is rendered.
#pragma once

#include <atomic>
#include <set>
#include <string>

#include "pipeline/cli/support/arguments.h"

namespace trapeze {

/// Names of pictures, as the input's requests for maps have them, in the frames that are wanted. The input is
/// read for this, but for its procedurals, and nothing is said of it. Empty where it is standard input, which
/// can be read once.
std::set<std::string> pictures_of_maps(const Arguments& arguments, const std::atomic<bool>& cancelled);

}  // namespace trapeze
