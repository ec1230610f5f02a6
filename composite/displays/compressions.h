/// The compressions that a Display may ask for, by file format.
#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "composite/displays/display_plan.h"

namespace trapeze {

/// The library's name of a compression that a Display asks for in lower case; nothing where the format has no
/// such compression.
std::optional<std::string> compression_named(FileFormat format, std::string_view name);

/// Whether OpenEXR compresses deep pictures so.
bool holds_deep(std::string_view compression);

/// The compressions that a format has, as Displays ask for them: "none, lzw, zip".
std::string compression_names(FileFormat format);

}  // namespace trapeze
