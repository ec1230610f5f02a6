#include "pipeline/frame/make_map.h"

#include <fmt/format.h>

#include <filesystem>

#include "core/foreign_paths.h"
#include "core/output_file.h"
#include "shade/make_maps.h"

namespace trapeze {
namespace {

namespace fs = std::filesystem;

/// Empty: there is none.
std::string found_picture(const std::string& name, const std::vector<std::string>& folders) {
    std::error_code ignored;
    std::vector<std::string> names = other_names(name);
    names.insert(names.begin(), name);
    for (const std::string& candidate : names) {
        if (fs::is_regular_file(candidate, ignored)) return candidate;
        for (const std::string& folder : folders) {
            const fs::path path = fs::path(folder) / candidate;
            if (fs::is_regular_file(path, ignored)) return path.string();
        }
    }
    return {};
}

MapProblem made(const MapRequest& request, const std::string& map, const std::vector<std::string>& pictures) {
    const MapMaking making{request.swrap, request.twrap, request.filter,
                           request.colorspace.value_or(request.transfer)};
    switch (request.kind) {
        case MapRequest::Kind::Texture:
            return make_texture_map(pictures[0], map, making);
        case MapRequest::Kind::Bump:
            return make_bump_map(pictures[0], map, making);
        case MapRequest::Kind::LatLongEnvironment:
            return make_lat_long_environment(pictures[0], map, making);
        case MapRequest::Kind::CubeFaceEnvironment:
            return make_cube_face_environment(
                {pictures[0], pictures[1], pictures[2], pictures[3], pictures[4], pictures[5]}, map,
                request.fov, making);
        case MapRequest::Kind::Shadow:
            return make_shadow_map(pictures[0], map);
    }
    return {};
}

}  // namespace

std::vector<std::string> missing_pictures(const MapRequest& request) {
    std::vector<std::string> missing;
    for (const std::string& name : request.pictures)
        if (found_picture(name, request.folders).empty()) missing.push_back(name);
    return missing;
}

bool make_map(const MapRequest& request, Diagnostics& diagnostics) {
    std::vector<std::string> pictures;
    for (const std::string& name : request.pictures) {
        pictures.push_back(found_picture(name, request.folders));
        if (pictures.back().empty()) pictures.back() = name;
    }
    std::error_code ignored;
    const std::string map =
        fs::is_regular_file(pictures[0], ignored) ? place_to_write(request.map) : request.map;
    const MapProblem problem = made(request, map, pictures);
    if (problem.text.empty() && map != request.map)
        diagnostics.warning(
            request.location,
            fmt::format("there is no folder for \"{}\"; it is made as \"{}\"", request.map, map),
            "no-folder");
    if (problem.text.empty()) return true;
    diagnostics.error(request.location, fmt::format("cannot make \"{}\" from \"{}\": {}", request.map,
                                                    request.pictures[0], problem.text));
    return !problem.is_of_output;
}

}  // namespace trapeze
