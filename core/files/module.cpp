#include "core/files/module.h"

#include <dlfcn.h>
#include <link.h>
#include <sys/auxv.h>

#include <filesystem>

namespace trapeze {
namespace {

namespace fs = std::filesystem;

/// The folder of what this function is linked into. The loader has no name for the program itself.
fs::path own_folder() {
    Dl_info info{};
    link_map* map = nullptr;
    const void* own = reinterpret_cast<const void*>(&own_folder);
    const bool known = dladdr1(own, &info, reinterpret_cast<void**>(&map), RTLD_DL_LINKMAP) != 0;
    const fs::path file = known && map && map->l_name && *map->l_name ? map->l_name : "/proc/self/exe";
    std::error_code problem;
    fs::path place = fs::canonical(file, problem);
    // What was executed, as the kernel says, where /proc is not mounted.
    const auto* const executed = reinterpret_cast<const char*>(getauxval(AT_EXECFN));
    if (problem && executed) place = fs::canonical(executed, problem);
    return problem ? fs::path() : place.parent_path();
}

/// "/a", "/b" and "/c".
std::string listed(const std::vector<std::string>& folders) {
    std::string text;
    for (size_t i = 0; i < folders.size(); ++i)
        text += (i == 0 ? "\"" : i + 1 < folders.size() ? ", \"" : " and \"") + folders[i] + "\"";
    return text.empty() ? "no folder" : text;
}

OpenedModule open_file(const std::string& path, std::string_view name) {
    void* const handle = dlopen(path.c_str(), RTLD_LAZY | RTLD_LOCAL);
    if (!handle) {
        const char* const reason = dlerror();
        return {nullptr, "cannot load " + std::string(reason ? reason : path)};
    }
    const std::string symbol = "trapeze_" + std::string(name) + "_module";
    const auto* const entry = static_cast<const ModuleEntry*>(dlsym(handle, symbol.c_str()));
    if (!entry) return {nullptr, "\"" + path + "\" is no module of Trapeze"};
    if (std::string_view(entry->version) != TRAPEZE_VERSION)
        return {nullptr, "\"" + path + "\" is of Trapeze " + entry->version + ", this is " TRAPEZE_VERSION};
    return {entry->offered, {}};
}

}  // namespace

std::string module_file(std::string_view name) {
    return "trapeze-" + std::string(name) + ".so";
}

std::vector<std::string> module_folders() {
    const fs::path own = own_folder();
    if (own.empty()) return {};
    std::vector<std::string> folders;
    for (const char* const folder :
         {"", "../lib/trapeze", "../lib/" TRAPEZE_LIBRARY_ARCHITECTURE "/trapeze", "trapeze"})
        folders.push_back((own / folder).lexically_normal().string());
    if (folders.front().ends_with('/') && folders.front().size() > 1) folders.front().pop_back();
    return folders;
}

OpenedModule open_module(std::string_view name, const std::vector<std::string>& folders) {
    std::error_code ignored;
    for (const std::string& folder : folders)
        if (const fs::path path = fs::path(folder) / module_file(name); fs::exists(path, ignored))
            return open_file(path.string(), name);
    return {nullptr, module_file(name) + " is not in " + listed(folders)};
}

}  // namespace trapeze
