/// For tests of maps: a folder that goes with the test, pictures written into it, and planes.
#pragma once

#include <OpenImageIO/imageio.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <deque>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "shade/maps/textures.h"

namespace trapeze {

class MapFilesTest : public ::testing::Test {
  protected:
    MapFilesTest() {
        OIIO::attribute("threads", 1);  // its own threads are not known to sanitizers
        folder_ = std::filesystem::temp_directory_path() /
                  ("trapeze_maps_" + std::to_string(::getpid()) + "_" +
                   ::testing::UnitTest::GetInstance()->current_test_info()->name());
        std::filesystem::create_directories(folder_);
    }
    ~MapFilesTest() override { std::filesystem::remove_all(folder_); }

    std::string path(const std::string& name) const { return (folder_ / name).string(); }

    /// pixel(x, y, channel) from the top left.
    std::string write(const std::string& name, OIIO::ImageSpec spec,
                      const std::function<float(int, int, int)>& pixel) const {
        std::vector<float> pixels;
        for (int y = 0; y < spec.height; ++y)
            for (int x = 0; x < spec.width; ++x)
                for (int c = 0; c < spec.nchannels; ++c) pixels.push_back(pixel(x, y, c));
        const auto out = OIIO::ImageOutput::create(path(name));
        EXPECT_TRUE(out && out->open(path(name), spec) &&
                    out->write_image(OIIO::TypeDesc::FLOAT, pixels.data()) && out->close());
        return path(name);
    }

    /// A depth map of side x side pixels whose camera looks along +z from the origin of its own space: x and
    /// y from -1 to 1, or of 90 degrees. depth(x, y) from the top left.
    std::string write_depth_map(const std::string& name, int side, bool perspective,
                                const std::function<float(int, int)>& depth,
                                const M44f& camera_from_world) const {
        OIIO::ImageSpec spec(side, side, 1, OIIO::TypeDesc::FLOAT);
        const M44f screen_from_camera =
            perspective ? M44f(1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 1, 0, 0, -0.1f, 0) : M44f();
        const M44f screen = camera_from_world * screen_from_camera;
        spec.attribute("worldtocamera", OIIO::TypeMatrix, &camera_from_world);
        spec.attribute("worldtoscreen", OIIO::TypeMatrix, &screen);
        return write(name, spec, [&](int x, int y, int) { return depth(x, y); });
    }

    /// Lives as long as the test.
    Plane plane(std::vector<float> values) {
        kept_.push_back(std::move(values));
        return kept_.back();
    }
    Plane plane(size_t size, float value) { return plane(std::vector<float>(size, value)); }

    std::filesystem::path folder_;
    std::deque<std::vector<float>> kept_;
    Options options_;
    std::vector<Diagnostic> reported_;
    Diagnostics diagnostics_{[this](const Diagnostic& d) { reported_.push_back(d); }};
};

}  // namespace trapeze
