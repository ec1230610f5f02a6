#include "core/files/foreign_paths.h"

#include <algorithm>

namespace trapeze {

std::vector<std::string> other_names(std::string_view name) {
    constexpr size_t kMostFolders = 64;
    std::string path(name);
    std::replace(path.begin(), path.end(), '\\', '/');
    std::vector<std::string> names;
    if (path != name) names.push_back(path);
    for (size_t slash = path.find('/'); slash != std::string::npos && names.size() < kMostFolders;
         slash = path.find('/', slash)) {
        while (slash < path.size() && path[slash] == '/') ++slash;
        if (slash < path.size()) names.push_back(path.substr(slash));
    }
    return names;
}

}  // namespace trapeze
