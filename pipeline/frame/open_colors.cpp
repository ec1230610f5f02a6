#include "pipeline/frame/open_colors.h"

#include <fmt/format.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>

#include "composite/colors/color_library.h"
#include "shade/maps/texture_files.h"

namespace trapeze {
namespace {

/// Configs that are not files but part of OpenColorIO are named by this.
constexpr std::string_view kInsideLibrary = "ocio://";

/// The Diagnostic::kind of the note that only the environment has a config.
constexpr const char* kOnlyInEnvironment = "colors-of-environment";

/// What $OCIO names; empty: nothing.
std::string config_of_environment(const Access& access) {
    const char* const file = access.may_see_environment() ? std::getenv("OCIO") : nullptr;
    return file ? file : "";
}

/// The config's file as a scene names it: from the working folder, or where its textures are looked for.
std::string file_of_scene(const std::string& name, const Options& options) {
    std::error_code ignored;
    const auto folders = options.search_paths.find("texture");
    if (folders == options.search_paths.end() || name.starts_with(kInsideLibrary) ||
        std::filesystem::exists(name, ignored))
        return name;
    return map_file(name, folders->second).value_or(name);
}

/// Why a config cannot even be looked into; empty: it can.
std::string problem_of_file(const std::string& file) {
    std::error_code problem;
    if (file.starts_with(kInsideLibrary))
        return "names a config inside OpenColorIO, and 2.1, which Trapeze is made for, has none: a file is "
               "needed";
    const std::filesystem::file_status status = std::filesystem::status(file, problem);
    if (!std::filesystem::exists(status)) return "is not found";
    if (!std::filesystem::is_regular_file(status)) return "is no file";
    return std::ifstream(file) ? "" : "may not be read";
}

}  // namespace

OpenedColors open_colors(const Options& options, const ColorRequest& users, const Access& access,
                         Diagnostics& diagnostics) {
    ColorRequest request = replaced(color_request_of(options), users);
    const std::string usual = config_of_environment(access);
    if (!request.asks()) {
        if (!usual.empty() && !diagnostics.kinds().contains(kOnlyInEnvironment))
            diagnostics.note({},
                             fmt::format("$OCIO names \"{}\", which changes no colours by itself: --ocio, "
                                         "--display, --view or Option \"ocio\" does",
                                         usual),
                             kOnlyInEnvironment);
        return {};
    }
    const bool is_scenes = users.config.empty() && !request.config.empty();
    std::string from, problem;
    if (is_scenes && access.is_confined())
        problem = "is not open to scenes (--safe), as it names further files; --ocio names it for them";
    else if (is_scenes)
        request.config = file_of_scene(request.config, options);
    else if (request.config.empty() && !usual.empty())
        request.config = usual, from = " ($OCIO)";
    if (problem.empty() && !request.config.empty()) problem = problem_of_file(request.config);
    if (problem.empty()) {
        OpenedColors opened;
        const ColorLibrary* const library = color_library(&problem);
        if (library) opened.colors = library->open(request, &problem);
        if (opened.colors && !request.config.empty()) access.note_read(request.config);
        if (opened.colors) return opened;
    }
    const std::string name =
        request.config.empty() ? "the built-in config" : fmt::format("config \"{}\"{}", request.config, from);
    // What the user asks for may be what is wrong.
    const SourceLocation at = users.asks() ? SourceLocation{} : options.colors_location;
    diagnostics.error(at, fmt::format("OpenColorIO, {}: {}", name, problem), kNoColors);
    return {nullptr, true};
}

}  // namespace trapeze
