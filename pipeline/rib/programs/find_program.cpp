#include "pipeline/rib/programs/find_program.h"

#include <unistd.h>

#include <cstdlib>
#include <filesystem>
#include <sstream>

namespace trapeze::rib {
namespace {

namespace fs = std::filesystem;

/// A file that this user may execute.
bool is_program(const std::string& path) {
    std::error_code ignored;
    return fs::is_regular_file(path, ignored) && access(path.c_str(), X_OK) == 0;
}

}  // namespace

/// Folders are the scene's search path "procedural"; an empty one is the working folder. A name that is in
/// none of them is handed on as it is, since posix_spawnp() looks along PATH itself.
std::string program_path(const std::string& name, const std::vector<std::string>& folders) {
    if (fs::path(name).is_relative())
        for (const std::string& folder : folders) {
            const fs::path path = fs::path(folder.empty() ? "." : folder) / name;
            if (is_program(path.string())) return path.string();
        }
    return name;
}

/// Follows the rules of posix_spawnp(): a name with a slash in it is a path, any other is looked for along
/// PATH, of which an empty part is the working folder.
bool has_program(const std::string& name, const std::vector<std::string>& folders) {
    const std::string path = program_path(name, folders);
    if (path.find('/') != std::string::npos) return is_program(path);
    const char* const variable = std::getenv("PATH");
    std::istringstream places(variable ? variable : "/bin:/usr/bin");
    for (std::string folder; std::getline(places, folder, ':');)
        if (is_program((folder.empty() ? "." : folder) + "/" + path)) return true;
    return false;
}

}  // namespace trapeze::rib
