/// A file's request to make a texture, environment or shadow map (RISpec 3.2, section 7), as it is read.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "core/colors/transfer.h"
#include "core/diagnostics.h"

namespace trapeze {

/// Names of files are as they stand in the scene; who makes the map looks for them.
struct MapRequest {
    enum class Kind { Texture, Bump, LatLongEnvironment, CubeFaceEnvironment, Shadow };

    Kind kind = Kind::Texture;
    std::vector<std::string> pictures;  ///< one; six for CubeFaceEnvironment: +x, -x, +y, -y, +z, -z
    std::string map;                    ///< what is to be made
    std::string swrap = "periodic", twrap = "periodic";
    std::string filter = "box";
    float fov = 90;                        ///< degrees, of CubeFaceEnvironment
    Transfer transfer = Transfer::Linear;  ///< of the pictures' numbers, by Option "color" "transfer"
    std::optional<Transfer> colorspace;    ///< the same, as the request itself says
    std::vector<std::string> folders;  ///< where pictures are looked for that are not where their name says
    SourceLocation location;
};

}  // namespace trapeze
