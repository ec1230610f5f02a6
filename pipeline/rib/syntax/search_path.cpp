#include "pipeline/rib/syntax/search_path.h"

#include <algorithm>
#include <cctype>
#include <cstdlib>
#include <filesystem>
#include <iterator>
#include <map>

#include "core/files/foreign_paths.h"

namespace trapeze::rib {
namespace {

namespace fs = std::filesystem;

/// As shells have it for names of variables.
bool is_name(char c) {
    return std::isalnum(static_cast<unsigned char>(c)) || c == '_';
}

/// Empty when it is not set.
std::string environment(const std::string& name) {
    const char* value = std::getenv(name.c_str());
    return value ? value : "";
}

/// Whether the entry asks for the environment, which confined scenes must not see.
bool has_variables(const std::string& text) {
    return text[0] == '~' || text.find_first_of("$%") != std::string::npos;
}

/// $NAME ends at the first other character; %NAME% is the form of Windows. A mark without its end stands for
/// itself.
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

/// False also where the scene may not look.
bool is_folder(const std::string& path, const Access& access) {
    std::error_code ignored;
    return access.may_read(path) && fs::is_directory(path, ignored);
}

/// A folder that is not where it is said to be: without its leading folders, or seen from the folders above
/// the file.
std::string folder_elsewhere(const std::string& folder, const std::string& folder_of_file,
                             const Access& access) {
    std::vector<std::string> names = other_names(folder);
    if (fs::path(folder).is_relative()) names.insert(names.begin(), folder);
    fs::path from = folder_of_file.empty() ? "." : folder_of_file;
    for (int level = 0; level <= kMostFoldersAbove; ++level, from /= "..")
        for (const std::string& name : names)
            if (const std::string candidate = (from / name).string();
                !name.empty() && is_folder(candidate, access))
                return candidate;
    return {};
}

}  // namespace

/// Colons separate, as in RISpec; a drive's letter of other systems is taken for a folder, which is not
/// there.
std::vector<std::string> expand_search_path(const std::string& path, const std::vector<std::string>& previous,
                                            const std::string& folder_of_file, const Access& access,
                                            std::vector<std::string>* closed) {
    std::vector<std::string> folders;
    const auto leave_out = [&](const std::string& entry) {
        if (closed) closed->push_back(entry);
    };
    for (size_t begin = 0; begin <= path.size();) {
        const size_t end = std::min(path.find(':', begin), path.size());
        const std::string entry = path.substr(begin, end - begin);
        begin = end + 1;
        if (entry == "&") folders.insert(folders.end(), previous.begin(), previous.end());
        if (entry.empty() || entry == "@" || entry == "&") continue;
        if (!access.may_see_environment() && has_variables(entry)) {
            leave_out(entry);
            continue;
        }
        const std::string folder = expand_variables(entry);
        if (folder.empty()) continue;
        std::vector<std::string> places;
        // Folders that do not exist yet are kept: maps may be made in them.
        if (fs::path(folder).is_absolute()) {
            places = {folder};
        } else {
            places = {(fs::path(folder_of_file) / folder).string()};
            if (!folder_of_file.empty()) places.push_back(folder);
        }
        const auto is_open = [&](const std::string& place) { return access.may_read(place); };
        const bool all_closed = std::none_of(places.begin(), places.end(), is_open);
        std::copy_if(places.begin(), places.end(), std::back_inserter(folders), is_open);
        if (std::any_of(places.begin(), places.end(),
                        [&](const std::string& place) { return is_folder(place, access); }))
            continue;
        if (const std::string found = folder_elsewhere(folder, folder_of_file, access); !found.empty())
            folders.push_back(found);
        else if (all_closed)
            leave_out(entry);
    }
    return folders;
}

/// Names are those that projects have; they are searched in the order of the list, beside the file first.
std::vector<std::string> usual_folders(const std::string& category, const std::string& folder_of_file,
                                       const Access& access) {
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
            if (is_folder(parent + "/" + name, access)) folders.push_back(parent + "/" + name);
    return folders;
}

}  // namespace trapeze::rib
