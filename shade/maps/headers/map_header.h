/// What the header of a picture's file says, read without OpenImageIO, whose libraries take longer to load
/// than a scene takes to check.
#pragma once

#include <optional>
#include <string>

namespace trapeze {

struct MapHeader {
    bool is_one_float = false;  ///< one channel of 32-bit floats, as depths are
    bool has_matrices = false;  ///< of the map's camera, as shadow maps have them
};

/// The header of a file in one of the plain forms of PNG, JPEG, TIFF and OpenEXR, whose maps OpenImageIO is
/// certain to open. Nothing for every other file, which may be as good: only OpenImageIO can say.
std::optional<MapHeader> plain_map_header(const std::string& path);

}  // namespace trapeze
