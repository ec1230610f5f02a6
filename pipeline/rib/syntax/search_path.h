/// Option "searchpath": folders apart by colons (RISpec 4.1.4 and the usual extensions).
#pragma once

#include <string>
#include <vector>

#include "core/files/access.h"

namespace trapeze::rib {

/// How many folders up a file is looked for that is not where its name says.
inline constexpr int kMostFoldersAbove = 4;

/// Expands "&" (the previous path), "@" and empty entries (standard places: none), $NAME, ${NAME} and %NAME%
/// (the environment), ~ at the beginning (the home folder). A relative folder is searched beside the file
/// that names it, then from the working folder. One that is in none of these places may have been named by
/// another machine, or from its project's folder: it is looked for without its leading folders, from that of
/// the file and those above. Folders that are closed to scenes are left out, and what the path has of them is
/// put into *closed, if not null.
std::vector<std::string> expand_search_path(const std::string& path, const std::vector<std::string>& previous,
                                            const std::string& folder_of_file,
                                            const Access& access = kEverything,
                                            std::vector<std::string>* closed = nullptr);

/// The folders for files of a kind ("archive", "shader", "texture") that projects of the world have below a
/// scene's folder, or beside it; those that there are.
std::vector<std::string> usual_folders(const std::string& category, const std::string& folder_of_file,
                                       const Access& access);

}  // namespace trapeze::rib
