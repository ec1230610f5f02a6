/// Quantize and what a Display says of its own, in the levels of a file.
#include <OpenImageIO/imagebuf.h>
#include <gtest/gtest.h>

#include <cmath>
#include <map>

#include "composite/displays/write_displays.h"
#include "composite/film/raster_harness.h"
#include "core/files/temporary_folder_harness.h"

namespace trapeze {
namespace {

using testing::RasterScene;
using testing::TemporaryFolder;

struct Wished {
    float zero = 0, one = 255, min = 0, max = 255, dither = 0;
};

/// The shares of the levels that an even grey has in 12288 numbers of a TIFF.
std::map<int, double> levels_of(float grey, const Wished& wished) {
    const TemporaryFolder folder;
    RasterScene scene(64, 64, 1);
    Display display{folder.file("a.tif"), "tiff", "rgb", {}, {}};
    display.parameters.set({"quantize",
                            {StorageClass::Uniform, ValueType::Float, 4},
                            {wished.zero, wished.one, wished.min, wished.max},
                            {}});
    display.parameters.set({"dither", {StorageClass::Uniform, ValueType::Float, 1}, {wished.dither}, {}});
    scene.scene.options.displays = {display};
    Image image;
    image.width = image.height = 64;
    image.window = scene.context.camera.crop;
    image.rgba.assign(64 * 64 * 4, grey), image.z.resize(64 * 64);
    EXPECT_TRUE(write_displays(image, scene.context, {"Trapeze test", {}}));
    const OIIO::ImageBuf written(display.name);
    EXPECT_EQ(written.spec().format, OIIO::TypeDesc::UINT8);
    std::map<int, double> share;
    for (int y = 0; y < 64; ++y)
        for (int x = 0; x < 64; ++x)
            for (int c = 0; c < 3; ++c)
                share[static_cast<int>(std::lround(255 * written.getchannel(x, y, 0, c)))] += 1.0 / 12288;
    return share;
}

int level_of(float grey, const Wished& wished) {
    const auto levels = levels_of(grey, wished);
    EXPECT_EQ(levels.size(), 1u);
    return levels.begin()->first;
}

TEST(Quantization, DitherKeepsTheMean) {
    double sum = 0;
    for (const auto& [level, share] : levels_of(100.25f / 255, {0, 255, 0, 255, 0.5f})) {
        EXPECT_TRUE(level == 100 || level == 101) << level;
        sum += level * share;
    }
    EXPECT_NEAR(sum, 100.25, 0.02);  // 5 deviations of the mean of 12288 levels
}

/// Even within the amplitude on both sides: halves at the ends.
TEST(Quantization, DitherHasItsAmplitude) {
    const auto wide = levels_of(0.5f, {0, 200, 0, 255, 2});
    ASSERT_EQ(wide.size(), 5u);
    for (const auto& [level, share] : wide)
        EXPECT_NEAR(share, level == 98 || level == 102 ? 0.125 : 0.25, 0.02) << level;
}

TEST(Quantization, ZeroAndOneHaveTheirLevelsWithinTheLimits) {
    EXPECT_EQ(level_of(0.5f, {0, 200, 0, 255, 0}), 100);
    EXPECT_EQ(level_of(0.5f, {40, 60, 0, 255, 0}), 50);
    EXPECT_EQ(level_of(0.25f, {255, 0, 0, 255, 0}), 191);  // turned round
    EXPECT_EQ(level_of(0.5f, {0, 255, 200, 255, 0}), 200);
    EXPECT_EQ(level_of(0.5f, {0, 255, 0, 99, 0}), 99);
}

}  // namespace
}  // namespace trapeze
