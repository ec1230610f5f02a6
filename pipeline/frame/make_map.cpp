#include "pipeline/frame/make_map.h"

#include <fmt/format.h>

#include <filesystem>

#include "composite/output_file.h"
#include "shade/make_maps.h"

namespace trapeze {
namespace {

namespace fs = std::filesystem;

std::string found_picture(const std::string& name, const std::vector<std::string>& folders) {
    std::error_code ignored;
    if (fs::path(name).is_absolute() || fs::is_regular_file(name, ignored)) return name;
    for (const std::string& folder : folders) {
        const fs::path path = fs::path(folder) / name;
        if (fs::is_regular_file(path, ignored)) return path.string();
    }
    return name;
}

/// Empty, or what went wrong.
std::string made(const MapRequest& request, const std::vector<std::string>& pictures) {
    const MapMaking making{request.swrap, request.twrap, request.filter};
    switch (request.kind) {
        case MapRequest::Kind::Texture:
            return make_texture_map(pictures[0], request.map, making);
        case MapRequest::Kind::Bump:
            return make_bump_map(pictures[0], request.map, making);
        case MapRequest::Kind::LatLongEnvironment:
            return make_lat_long_environment(pictures[0], request.map, making);
        case MapRequest::Kind::CubeFaceEnvironment:
            return make_cube_face_environment(
                {pictures[0], pictures[1], pictures[2], pictures[3], pictures[4], pictures[5]}, request.map,
                request.fov, making);
        case MapRequest::Kind::Shadow:
            return make_shadow_map(pictures[0], request.map);
    }
    return {};
}

}  // namespace

void make_map(const MapRequest& request, Diagnostics& diagnostics) {
    std::vector<std::string> pictures;
    for (const std::string& name : request.pictures) pictures.push_back(found_picture(name, request.folders));
    std::error_code ignored;
    if (fs::is_regular_file(pictures[0], ignored)) make_folder_of(request.map);
    const std::string problem = made(request, pictures);
    if (problem.empty()) return;
    diagnostics.error(request.location, fmt::format("cannot make \"{}\" from \"{}\": {}", request.map,
                                                    request.pictures[0], problem));
}

}  // namespace trapeze
