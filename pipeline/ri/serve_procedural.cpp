#include "pipeline/ri/serve_procedural.h"

#include <dlfcn.h>
#include <unistd.h>

#include <cstdio>
#include <cstdlib>
#include <iostream>

#include "pipeline/ri/context.h"
#include "pipeline/ri/errors.h"
#include "pipeline/ri/ri.h"

namespace trapeze {
namespace {

/// The three functions of a library (RISpec 5.8.4).
struct Procedural {
    RtPointer (*convert_parameters)(RtString) = nullptr;
    RtVoid (*subdivide)(RtPointer, RtFloat) = nullptr;
    RtVoid (*free)(RtPointer) = nullptr;

    /// False, with the reason on stderr.
    bool load(const std::string& path) {
        void* const library = dlopen(path.c_str(), RTLD_NOW | RTLD_LOCAL);
        if (!library) {
            std::fprintf(stderr, "trapeze: %s\n", dlerror());
            return false;
        }
        const auto find = [&](const char* name, auto& function) {
            function = reinterpret_cast<std::remove_reference_t<decltype(function)>>(dlsym(library, name));
            if (!function) std::fprintf(stderr, "trapeze: %s: there is no %s()\n", path.c_str(), name);
            return function != nullptr;
        };
        return find("ConvertParameters", convert_parameters) && find("Subdivide", subdivide) &&
               find("Free", free);
    }

    /// The RIB of one piece.
    std::string answer(std::string arguments, float detail) const {
        ri::begin_context("", {});
        const RtPointer data = convert_parameters(arguments.data());
        subdivide(data, detail);
        free(data);
        const auto context = ri::take_current_context();
        if (!context) return {};  // the library has called RiEnd itself
        if (context->open_blocks() > 0) std::fputs("trapeze: Subdivide() leaves blocks open\n", stderr);
        return context->output.text();
    }
};

/// Standard output for answers alone: what the library prints goes to stderr.
int take_standard_output() {
    const int answers = dup(STDOUT_FILENO);
    dup2(STDERR_FILENO, STDOUT_FILENO);
    return answers;
}

bool write_all(int file, const std::string& text) {
    for (size_t at = 0; at < text.size();) {
        const ssize_t count = write(file, text.data() + at, text.size() - at);
        if (count <= 0) return false;
        at += static_cast<size_t>(count);
    }
    return true;
}

}  // namespace

int serve_procedural(const std::string& library) {
    const int answers = take_standard_output();
    Procedural procedural;
    if (answers < 0 || !procedural.load(library)) return 1;
    for (std::string line; std::getline(std::cin, line);) {
        char* arguments = nullptr;
        const float detail = std::strtof(line.c_str(), &arguments);
        if (*arguments == ' ') ++arguments;
        if (!write_all(answers, procedural.answer(arguments, detail) + "\377")) return 1;
    }
    return 0;
}

}  // namespace trapeze
