/// Atmospheres in whole frames.
#include <gtest/gtest.h>
#include <unistd.h>

#include <cmath>
#include <fstream>

#include "core/files/temporary_folder_harness.h"
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

/// The surface is shaded before the volume, and knows its parameters all the same.
TEST(Atmosphere, TellsTheSurfaceItsParameters) {
    const TemporaryFolder folder;
    std::ofstream(folder.file("haze.sl"))
        << "volume haze(float density = .6, two = 2 * density;) { Oi = Oi; }";
    std::ofstream(folder.file("asks.sl"))
        << "surface asks() { float d = 0, e = 0, two = 0; float found = atmosphere(\"density\", d) + "
           "incident(\"density\", e) + atmosphere(\"two\", two) + 10 * atmosphere(\"none\", e); "
           "Ci = color(d, two, found / 3); Oi = 1; }";
    std::ofstream(folder.file("a.rib"))
        << "Option \"searchpath\" \"string shader\" [\"" << folder.file("")
        << "\"] Display \"x\" \"exr\" \"rgba\" Format 3 3 1 WorldBegin Atmosphere \"haze\" \"density\" [.25] "
           "Surface \"asks\" Polygon \"P\" [-9 -9 1 9 -9 1 9 9 1 -9 9 1] WorldEnd\n";
    const Image image = render_scene(folder.file("a.rib"), {}, 1).at(0).image;
    EXPECT_NEAR(image.rgba[4 * 4], .25f, 1e-6f);
    EXPECT_NEAR(image.rgba[4 * 4 + 1], .5f, 1e-6f);
    EXPECT_NEAR(image.rgba[4 * 4 + 2], 1, 1e-6f);
}

}  // namespace
}  // namespace trapeze::testing
