/// Atmospheres in whole frames.
#include <gtest/gtest.h>
#include <unistd.h>

#include <cmath>
#include <fstream>

#include "tests/scene_harness.h"

namespace trapeze::testing {
namespace {

/// Red light that comes from a black wall through fog: fog(distance 10) of RISpec.
float red_of_wall(float depth, const std::string& projection) {
    const std::string path = ::testing::TempDir() + "fog" + std::to_string(getpid()) + ".rib";
    std::ofstream(path) << "Display \"x\" \"exr\" \"rgba\" Format 3 3 1 " << projection
                        << " WorldBegin Atmosphere \"fog\" \"float distance\" [10] \"color background\" [1 0 "
                           "0] Surface \"constant\" Color [0 0 0] Translate 0 0 "
                        << depth << " Polygon \"P\" [-99 -99 0 99 -99 0 99 99 0 -99 99 0] WorldEnd\n";
    return render_scene(path, {}, 1).at(0).image.rgba.at(4 * 4);
}

TEST(Atmosphere, FogGrowsWithDistanceInAnyProjection) {
    for (const char* projection : {"Projection \"orthographic\"", "Projection \"perspective\" \"fov\" [1]"})
        for (const float depth : {3.0f, 6.0f, 30.0f})
            EXPECT_NEAR(red_of_wall(depth, projection), 1 - std::exp(-depth / 10), 2e-3f) << projection;
}

}  // namespace
}  // namespace trapeze::testing
