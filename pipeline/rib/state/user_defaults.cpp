/// The place is that of the XDG base directory specification.
#include "pipeline/rib/state/user_defaults.h"

#include <cstdlib>
#include <filesystem>

namespace trapeze {

/// A variable that is set but empty counts as not set, as the specification says. Without a home there is no
/// such file: the working folder is not looked into.
std::string user_defaults_file() {
    namespace fs = std::filesystem;
    const char* const config = std::getenv("XDG_CONFIG_HOME");
    const char* const home = std::getenv("HOME");
    fs::path folder;
    if (config && *config)
        folder = config;
    else if (home && *home)
        folder = fs::path(home) / ".config";
    else
        return {};
    const fs::path file = folder / "trapeze" / "trapeze.rib";
    std::error_code ignored;
    return fs::is_regular_file(file, ignored) ? file.string() : std::string();
}

}  // namespace trapeze
