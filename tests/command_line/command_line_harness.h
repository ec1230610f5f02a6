/// What tests of the command line share.
#pragma once

#include "tests/program_harness.h"

namespace trapeze::testing {

namespace fs = std::filesystem;

inline constexpr const char* kSphereScene = R"(Format 64 48 1
PixelSamples 2 2
Projection "perspective" "fov" 40
Display "sphere.exr" "openexr" "rgbaz"
Translate 0 0 5
WorldBegin
LightSource "distantlight" 1
Surface "plastic"
Sphere 1 -1 1 360
WorldEnd
)";

/// What a command has left in its folder.
inline std::string files_in(const WorkFolder& folder) {
    std::string names;
    for (const auto& entry : fs::directory_iterator(folder.path()))
        if (const std::string name = entry.path().filename(); name != ".stdout" && name != ".stderr")
            names += name + " ";
    return names;
}

}  // namespace trapeze::testing
