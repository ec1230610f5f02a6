/// The compressions that a Display may ask for, by file format.
#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "composite/displays/display_plan.h"

namespace trapeze {

/// The library's name of a compression that is asked for in lower case; nothing where the format has none
/// such.
std::optional<std::string> compression_named(FileFormat format, std::string_view name);

/// "none, lzw, zip": what there is, as it is asked for.
std::string compression_names(FileFormat format);

}  // namespace trapeze
