#include "pipeline/frame/make_map.h"

#include <fmt/format.h>

#include <filesystem>

#include "core/files/foreign_paths.h"
#include "core/files/output_file.h"
#include "core/files/picture_files.h"
#include "shade/maps/make_maps.h"

namespace trapeze {
namespace {

namespace fs = std::filesystem;

/// Where a picture of a request is; empty: in none of the places.
std::string found_picture(const std::string& name, const std::vector<std::string>& folders,
                          const Access& access) {
    std::vector<std::string> names = other_names(name);
    names.insert(names.begin(), name);
    for (const std::string& candidate : names) {
        if (access.has_file(candidate)) return candidate;
        for (const std::string& folder : folders)
            if (const std::string path = (fs::path(folder) / candidate).string(); access.has_file(path))
                return path;
    }
    return {};
}

/// Why a picture cannot be read; empty when it can.
std::string problem_with(const std::string& picture, const Access& access) {
    if (access.is_closed(picture)) return fmt::format("\"{}\" {}", picture, Access::kClosed);
    if (!access.has_file(picture)) return fmt::format("\"{}\" is not found", picture);
    if (access.is_confined() && !is_common_picture(picture))
        return fmt::format("\"{}\" is of a format that is not open to scenes (--safe)", picture);
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

std::vector<std::string> missing_pictures(const MapRequest& request, const Access& access) {
    std::vector<std::string> missing;
    for (const std::string& name : request.pictures)
        if (found_picture(name, request.folders, access).empty()) missing.push_back(name);
    return missing;
}

bool make_map(const MapRequest& request, const Access& access, Diagnostics& diagnostics,
              std::string* written) {
    if (written) written->clear();
    const auto report = [&](const std::string& problem) {
        diagnostics.error(request.location, fmt::format("cannot make \"{}\" from \"{}\": {}", request.map,
                                                        request.pictures[0], problem));
    };
    std::vector<std::string> pictures;
    for (const std::string& name : request.pictures) {
        pictures.push_back(found_picture(name, request.folders, access));
        if (pictures.back().empty()) pictures.back() = name;
        if (const std::string problem = problem_with(pictures.back(), access); !problem.empty()) {
            report(problem);
            return true;
        }
    }
    const OutputPlace place = place_to_write(request.map, access, request.location, diagnostics);
    const MapProblem problem =
        place.problem.empty() ? made(request, place.path, pictures) : MapProblem{place.problem, true};
    if (!problem.text.empty()) report(problem.text);
    if (problem.text.empty() && written) *written = place.path;
    return problem.text.empty() || !problem.is_of_output;
}

}  // namespace trapeze
