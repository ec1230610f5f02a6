#include "pipeline/cli/commands/made_files.h"

#include <filesystem>

#include "core/files/foreign_paths.h"

namespace trapeze {
namespace {

namespace fs = std::filesystem;

std::string normal(const fs::path& path) {
    std::error_code failed;
    const fs::path whole = fs::absolute(path, failed);
    return (failed ? path : whole).lexically_normal().string();
}

}  // namespace

void MadeFiles::add(const std::string& path) {
    paths_.insert(normal(path));
    // What belongs into a folder that is not here goes into the working folder.
    const std::vector<std::string> others = other_names(path);
    if (!others.empty()) paths_.insert(normal(others.back()));
}

bool MadeFiles::has(std::string_view name, const std::vector<std::string>& folders) const {
    if (paths_.empty()) return false;
    std::vector<std::string> names = other_names(name);
    names.emplace_back(name);
    for (const std::string& candidate : names) {
        if (paths_.contains(normal(candidate))) return true;
        for (const std::string& folder : folders)
            if (paths_.contains(normal(fs::path(folder) / candidate))) return true;
    }
    return false;
}

}  // namespace trapeze
