/// Makes files that shaders look up from pictures: RISpec 3.2's MakeTexture, MakeLatLongEnvironment,
/// MakeCubeFaceEnvironment and MakeShadow (section 7), and MakeBump of version 3.1.
///
/// These functions never throw. Files appear whole or not at all: written beside the target, then renamed.
/// Names are used as they are.
///
/// What is made are OpenImageIO's textures: tiled, with smaller and smaller pictures in linear light.
#pragma once

#include <array>
#include <string>
#include <string_view>

#include "core/colors/transfer.h"

namespace trapeze {

/// Why nothing was made; empty when it was.
struct MapProblem {
    std::string text;
    bool is_of_output = false;  ///< the map's file cannot be written; else it is the pictures

    bool operator==(std::string_view other) const { return text == other; }
};

/// How a map is made from a picture.
struct MapMaking {
    std::string swrap = "periodic", twrap = "periodic";  ///< or "clamp", "black", "mirror"
    /// Name of the filter that makes the smaller pictures, RISpec's or OpenImageIO's. Each filter has a width
    /// of its own; RISpec's widths are not used.
    std::string filter = "box";
    Transfer transfer = Transfer::Linear;  ///< of the pictures' numbers; maps are floats in linear light
};

/// MakeTexture: a map of `picture`, written to `texture`.
MapProblem make_texture_map(const std::string& picture, const std::string& texture, const MapMaking& making);

/// MakeBump: a map of heights. They are numbers even under Transfer::Auto.
MapProblem make_bump_map(const std::string& picture, const std::string& texture, const MapMaking& making);

/// MakeLatLongEnvironment: a map of a picture by longitude and latitude, as textures.h has it.
MapProblem make_lat_long_environment(const std::string& picture, const std::string& texture,
                                     const MapMaking& making);

/// MakeCubeFaceEnvironment: a map of six views along +x, -x, +y, -y, +z, -z, each `fov` degrees wide and high
/// (at least 90). As RISpec has them, seen in the left-handed camera space: up is +y but for +y, where it is
/// -z, and -y, where it is +z; to the right are -z, +z, +x, +x, +x, -x. The map that is made is one by
/// longitude and latitude.
MapProblem make_cube_face_environment(const std::array<std::string, 6>& pictures, const std::string& texture,
                                      float fov, const MapMaking& making);

/// MakeShadow: a map of a depth picture that has its camera's matrices, as Display "zfile" writes it. The
/// target may be the picture itself.
MapProblem make_shadow_map(const std::string& picture, const std::string& shadow);

}  // namespace trapeze
