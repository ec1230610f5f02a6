/// Files that another machine named.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace trapeze {

/// Other names to look for a file under when it is not found by its own, the likeliest first: with slashes
/// for backslashes, then without its leading folders, one after the other. "C:\maps\wood.tif" gives
/// "C:/maps/wood.tif", "maps/wood.tif", "wood.tif". Never the name itself.
std::vector<std::string> other_names(std::string_view name);

}  // namespace trapeze
