/// Modules: parts of the program that need libraries which take long to load. Each is a shared object of our
/// own, opened when something first needs it, or linked into the program (CMake's TRAPEZE_MODULES); the rooms
/// do not notice.
///
/// A module defines one symbol, a ModuleEntry called trapeze_NAME_module, and offers one object without
/// state, of an interface that its room declares. It is made of nothing but the sources that use the library;
/// what it shares with the program are headers, so that no variable of ours is there twice.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace trapeze {

/// What a module says of itself.
struct ModuleEntry {
    const char* version;  ///< TRAPEZE_VERSION as it was built; that of another program is refused
    const void* offered;  ///< the object, as a pointer to the interface
};

/// The file of a module: "trapeze-maps.so" of "maps".
std::string module_file(std::string_view name);

/// Where modules lie: beside the program, or beside the library of ours that it is linked to; and, seen from
/// there, in an install's folders (a program's ../lib/trapeze, a library's trapeze), which the build has too.
std::vector<std::string> module_folders();

/// What a module offers, or why there is nothing.
struct OpenedModule {
    const void* offered = nullptr;
    std::string problem;
};

/// Opens a module for as long as the process lives, from the first of the folders that has it. Callers keep
/// what it returns in a static, so that one thread opens it, once, and others wait.
OpenedModule open_module(std::string_view name, const std::vector<std::string>& folders = module_folders());

/// What a module offers that is linked into the program.
inline OpenedModule linked_module(const ModuleEntry& entry) {
    return {entry.offered, {}};
}

/// The object of a module as its interface; null, and why, where there is none.
template <class Interface>
const Interface* offered_by(const OpenedModule& module, std::string* problem) {
    *problem = module.problem;
    return static_cast<const Interface*>(module.offered);
}

}  // namespace trapeze

/// An OpenedModule of the module NAME, for the one function by which a room asks for it.
#ifdef TRAPEZE_LINKED_MODULES
#define TRAPEZE_FIND_MODULE(name) ::trapeze::linked_module(trapeze_##name##_module)
#else
#define TRAPEZE_FIND_MODULE(name) ::trapeze::open_module(#name)
#endif
