/// Where the files of textures lie.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "core/files/access.h"

namespace trapeze {

/// The file of a map of this name: the name itself, or in one of the folders. A name from another machine is
/// also tried without its leading folders. Nothing when there is none; without regard to what the file holds.
std::optional<std::string> map_file(const std::string& name, const std::vector<std::string>& folders,
                                    const Access& access = kEverything);

/// The picture that a texture was made from, where the texture itself is not there: grid.tif or grid.tif.tx
/// for grid.tex, say.
std::optional<std::string> source_of_texture(const std::string& name, const std::vector<std::string>& folders,
                                             const Access& access = kEverything);

}  // namespace trapeze
