/// Option "searchpath": folders apart by colons (RISpec 4.1.4 and the usual extensions).
#pragma once

#include <string>
#include <vector>

namespace trapeze::rib {

/// Expands "&" (the previous path), "@" and empty entries (standard places: none), $NAME, ${NAME} and %NAME%
/// (the environment), ~ at the beginning (the home folder). A relative folder is searched beside the file
/// that names it, then from the working folder.
std::vector<std::string> expand_search_path(const std::string& path, const std::vector<std::string>& previous,
                                            const std::string& folder_of_file);

}  // namespace trapeze::rib
