#include "pipeline/rib/search_path.h"

#include <algorithm>
#include <cctype>
#include <cstdlib>
#include <filesystem>
#include <map>

#include "core/foreign_paths.h"

namespace trapeze::rib {
namespace {

namespace fs = std::filesystem;

bool is_name(char c) {
    return std::isalnum(static_cast<unsigned char>(c)) || c == '_';
}

std::string environment(const std::string& name) {
    const char* value = std::getenv(name.c_str());
    return value ? value : "";
}

std::string expand_variables(const std::string& text) {
    std::string expanded;
    const bool is_home = text[0] == '~' && (text.size() == 1 || text[1] == '/');
    if (is_home) expanded = environment("HOME");
    for (size_t i = is_home ? 1 : 0; i < text.size();) {
        const bool braces = text[i] == '$' && i + 1 < text.size() && text[i + 1] == '{';
        if (text[i] == '%' || braces) {
            const size_t begin = i + (braces ? 2 : 1), end = text.find(braces ? '}' : '%', begin);
            if (end != std::string::npos) {
                expanded += environment(text.substr(begin, end - begin));
                i = end + 1;
                continue;
            }
        } else if (text[i] == '$') {
            size_t end = i + 1;
            while (end < text.size() && is_name(text[end])) ++end;
            expanded += environment(text.substr(i + 1, end - i - 1));
            i = end;
            continue;
        }
        expanded += text[i++];
    }
    return expanded;
}

bool is_folder(const fs::path& path) {
    std::error_code ignored;
    return fs::is_directory(path, ignored);
}

/// A folder that is not where it is said to be: without its leading folders, or seen from the folders above
/// the file.
std::string folder_elsewhere(const std::string& folder, const std::string& folder_of_file) {
    std::vector<std::string> names = other_names(folder);
    if (fs::path(folder).is_relative()) names.insert(names.begin(), folder);
    fs::path from = folder_of_file.empty() ? "." : folder_of_file;
    for (int level = 0; level <= kMostFoldersAbove; ++level, from /= "..")
        for (const std::string& name : names)
            if (const fs::path candidate = from / name; !name.empty() && is_folder(candidate))
                return candidate.string();
    return {};
}

}  // namespace

std::vector<std::string> expand_search_path(const std::string& path, const std::vector<std::string>& previous,
                                            const std::string& folder_of_file) {
    std::vector<std::string> folders;
    for (size_t begin = 0; begin <= path.size();) {
        const size_t end = std::min(path.find(':', begin), path.size());
        const std::string entry = path.substr(begin, end - begin);
        begin = end + 1;
        if (entry == "&") folders.insert(folders.end(), previous.begin(), previous.end());
        if (entry.empty() || entry == "@" || entry == "&") continue;
        const std::string folder = expand_variables(entry);
        if (folder.empty()) continue;
        const size_t before = folders.size();
        if (fs::path(folder).is_absolute()) {
            folders.push_back(folder);
        } else {
            folders.push_back((fs::path(folder_of_file) / folder).string());
            if (!folder_of_file.empty()) folders.push_back(folder);
        }
        if (std::any_of(folders.begin() + static_cast<std::ptrdiff_t>(before), folders.end(), is_folder))
            continue;
        if (const std::string found = folder_elsewhere(folder, folder_of_file); !found.empty())
            folders.push_back(found);
    }
    return folders;
}

std::vector<std::string> usual_folders(const std::string& category, const std::string& folder_of_file) {
    static const std::map<std::string, std::vector<const char*>> kNames = {
        {"archive", {"archives", "archive", "ribs", "rib"}},
        {"shader", {"shaders", "shader", "sl"}},
        {"texture", {"textures", "texture", "tex", "maps"}},
    };
    std::vector<std::string> folders;
    const auto names = kNames.find(category);
    if (names == kNames.end()) return folders;
    const std::string folder = folder_of_file.empty() ? "." : folder_of_file;
    for (const std::string& parent : {folder, folder + "/.."})
        for (const char* name : names->second)
            if (is_folder(parent + "/" + name)) folders.push_back(parent + "/" + name);
    return folders;
}

}  // namespace trapeze::rib
