/// `--aov`: what a picture's file is to have beside colour, by names that users of other renderers know.
#pragma once

#include <string>
#include <vector>

#include "core/scene/scene.h"

namespace trapeze {

/// Displays that show what a list names, as "albedo,N,z,color foo": of which only mode, variable and layer
/// are set. A name is
/// - albedo, N: filtered as the picture is; P, motion, u, v, and uv, which is both: of the nearest surface;
/// - z, id, alpha; crypto_object, crypto_material, crypto_asset;
/// - lightgroups: a colour for each group of the scene's lights, and what is seen without any;
/// - "float foo", "color foo", "vector foo" and so on, or foo alone, a colour: an output variable of shaders.
/// On an error the result is empty and `*error` says which name is wrong.
std::vector<Display> displays_of_aovs(const std::string& list, std::string* error);

/// Adds them as layers to the file of the first of a scene's displays; where that is no OpenEXR, to a file of
/// its name that is one, and of a deep picture to one whose name ends with .layers.exr. What the file has
/// already is not added. Returns the file's name.
std::string add_aovs(const std::vector<Display>& aovs, const std::vector<std::string>& light_groups,
                     std::vector<Display>& displays);

}  // namespace trapeze
