#include "pipeline/cli/read_settings.h"

#include <cstdlib>
#include <filesystem>

namespace trapeze {

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

ReadOptions read_options(const Arguments& arguments) {
    ReadOptions options;
    options.defaults_file = user_defaults_file();
    for (const std::string& rib : arguments.first_rib) options.first_texts.push_back({"--option", rib});
    options.allow_programs = arguments.allow_programs;
    return options;
}

}  // namespace trapeze
