#include "sample/load_plugin.h"

#include <dlfcn.h>

#include <filesystem>

#include "sample/plugin.h"

namespace trapeze {
namespace {

/// An address in a loaded file, as what it is.
template <class T>
T* symbol_of(void* handle, const char* name) {
    return reinterpret_cast<T*>(dlsym(handle, name));
}

/// dlerror() is null where nothing has failed since it was last asked.
std::string loader_message() {
    const char* const message = dlerror();
    return message ? message : "the loader does not say why";
}

/// What is wrong with a loaded file, before anything of it is called; empty: nothing. Symbols are looked up
/// by name first and none is called, since code of another version may do anything; the version is compared
/// before the layout, for its message says more.
std::string problem_of(void* handle) {
    const char* const version = symbol_of<const char>(handle, "trapeze_plugin_version");
    if (!version || !symbol_of<void>(handle, "trapeze_plugin_method"))
        return "it is no plugin of Trapeze: it has no TRAPEZE_PLUGIN(...)";
    if (std::string_view(version) != TRAPEZE_VERSION)
        return "it was built for Trapeze " + std::string(version) + ", this is " TRAPEZE_VERSION;
    const uint64_t* const layout = symbol_of<const uint64_t>(handle, "trapeze_plugin_layout");
    if (!layout || *layout != plugin_layout())
        return "it was built with other headers than this Trapeze " TRAPEZE_VERSION;
    return {};
}

}  // namespace

/// RTLD_NOW makes missing symbols an error here and not in the midst of a frame; RTLD_LOCAL keeps plugins
/// from seeing each other. A file that is refused is closed again, one that is taken stays open to the end of
/// the process, for the table points into it.
bool load_plugin(const std::string& file, std::string* error) {
    const auto fail = [&](const std::string& problem) {
        *error = "\"" + file + "\": " + problem;
        return false;
    };
    namespace fs = std::filesystem;
    std::error_code ignored;
    if (!fs::exists(file, ignored)) return fail("there is no such file");
    if (!fs::is_regular_file(file, ignored)) return fail("it is no file");
    // With a slash in it the loader takes it as a path, and does not search.
    const std::string path = fs::absolute(file, ignored).string();
    if (void* const loaded = dlopen(path.c_str(), RTLD_LAZY | RTLD_LOCAL | RTLD_NOLOAD)) {
        dlclose(loaded);  // counts as one less
        return true;
    }
    void* const handle = dlopen(path.c_str(), RTLD_NOW | RTLD_LOCAL);
    if (!handle) return fail("it cannot be loaded: " + loader_message());
    std::string problem = problem_of(handle);
    if (problem.empty()) {
        VisibilityMethod method;
        symbol_of<void(VisibilityMethod*)>(handle, "trapeze_plugin_method")(&method);
        if (add_visibility_method(method, &problem)) return true;
    }
    dlclose(handle);
    return fail(problem);
}

}  // namespace trapeze
