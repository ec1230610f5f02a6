/// How the numbers of pictures are taken: Option "color" "transfer", and a lookup's own "colorspace".
#include <gmock/gmock.h>

#include <cmath>

#include "shade/maps/map_files_harness.h"
#include "shade/materials/shader_folder_harness.h"
#include "shade/shading_harness.h"

namespace trapeze {
namespace {

using OIIO::ImageSpec;
using OIIO::TypeDesc;
using testing::ShaderFolder;
using testing::ShadingScene;

constexpr float kStored = 188 / 255.0f;
const float kDecoded = std::pow((kStored + 0.055f) / 1.055f, 2.4f);

class TextureTransferTest : public MapFilesTest {
  protected:
    std::string even(const std::string& name, int channels, TypeDesc format) const {
        return write(name, ImageSpec(8, 8, channels, format), [](int, int, int) { return kStored; });
    }
    /// Of all that texture() gives of a picture by that name.
    float seen(const std::string& call, const std::string& transfer) {
        shaders_.write("look", "surface look() { Ci = " + call + "; Oi = 1; }");
        ShadingScene scene;
        scene.scene.options.search_paths["shader"] = {shaders_.path()};
        scene.scene.options.search_paths["texture"] = {folder_.string()};
        if (!transfer.empty()) set_transfer(scene.scene.options, transfer);
        scene.surface("look");
        const ShadingGrid grid = scene.shaded();
        reported_ = scene.reported;
        return grid.Ci.at(0).x;
    }

    ShaderFolder shaders_;
};

TEST_F(TextureTransferTest, TheOptionSaysHowNumbersAreTaken) {
    even("color8.png", 3, TypeDesc::UINT8), even("color16.png", 3, TypeDesc::UINT16);
    even("color8.tif", 3, TypeDesc::UINT8), even("color16.tif", 4, TypeDesc::UINT16);
    even("grey8.png", 1, TypeDesc::UINT8), even("grey16.tif", 1, TypeDesc::UINT16);
    even("color.exr", 3, TypeDesc::FLOAT);
    const struct {
        const char* file;
        float by_srgb, by_auto;
    } cases[] = {{"color8.png", kDecoded, kDecoded}, {"color16.png", kDecoded, kStored},
                 {"color8.tif", kDecoded, kDecoded}, {"grey8.png", kDecoded, kStored},
                 {"grey16.tif", kDecoded, kStored},  {"color.exr", kStored, kStored}};
    for (const auto& c : cases) {
        const std::string call = "color texture(\"" + std::string(c.file) + "\", 0.3, 0.6)";
        EXPECT_NEAR(seen(call, ""), kStored, 1e-3f) << c.file;
        EXPECT_NEAR(seen(call, "linear"), kStored, 1e-3f) << c.file;
        EXPECT_NEAR(seen(call, "srgb"), c.by_srgb, 1e-3f) << c.file;
        EXPECT_NEAR(seen(call, "auto"), c.by_auto, 1e-3f) << c.file;
    }
}

TEST_F(TextureTransferTest, LookupsOfFloatsReadNumbersOfThemselves) {
    even("mask.png", 3, TypeDesc::UINT8);
    EXPECT_NEAR(seen("float texture(\"mask.png\"[1], 0.3, 0.6)", "auto"), kStored, 1e-3f);
    EXPECT_NEAR(seen("float texture(\"mask.png\"[1], 0.3, 0.6)", "srgb"), kDecoded, 1e-3f);
    EXPECT_NEAR(
        seen("color texture(\"mask.png\", 0.3, 0.6) * 0 + float texture(\"mask.png\", 0.3, 0.6)", "auto"),
        kStored, 1e-3f)
        << "both kinds of one file";
}

TEST_F(TextureTransferTest, TheCallsOwnWordCounts) {
    even("a.png", 3, TypeDesc::UINT8);
    const auto own = [](const char* name) {
        return std::string("color texture(\"a.png\", 0.3, 0.6, \"colorspace\", \"") + name + "\")";
    };
    EXPECT_NEAR(seen(own("srgb"), "linear"), kDecoded, 1e-3f);
    EXPECT_NEAR(seen(own("auto"), ""), kDecoded, 1e-3f);
    EXPECT_NEAR(seen(own("linear"), "srgb"), kStored, 1e-3f);
    EXPECT_NEAR(seen("float texture(\"a.png\", 0.3, 0.6, \"colorspace\", \"srgb\")", ""), kDecoded, 1e-3f);
    EXPECT_NEAR(seen("color environment(\"a.png\", N, \"colorspace\", \"srgb\")", ""), kDecoded, 1e-3f);
    EXPECT_TRUE(reported_.empty());
}

TEST_F(TextureTransferTest, UnknownWordsAreSaidOnce) {
    even("a.png", 3, TypeDesc::UINT8);
    EXPECT_NEAR(seen("color texture(\"a.png\", 0.3, 0.6, \"colorspace\", \"gamma\")", "srgb"), kDecoded,
                1e-3f);
    ASSERT_EQ(reported_.size(), 1u);
    EXPECT_EQ(reported_[0].severity, Severity::Warning);
    EXPECT_THAT(reported_[0].text, ::testing::HasSubstr("\"gamma\" is not known"));
}

/// Red of 188 at half alpha, not multiplied by it in the file.
TEST_F(TextureTransferTest, AlphaIsMultipliedInLinearLight) {
    ImageSpec spec(8, 8, 4, TypeDesc::UINT8);
    spec.attribute("oiio:UnassociatedAlpha", 1);
    write("pane.png", spec, [](int, int, int c) { return c == 0 ? kStored : c == 3 ? 0.5f : 0.0f; });
    const float alpha = 128 / 255.0f;
    EXPECT_NEAR(seen("color texture(\"pane.png\", 0.3, 0.6)", "srgb"), kDecoded * alpha, 1e-3f);
    EXPECT_NEAR(seen("float texture(\"pane.png\"[3], 0.3, 0.6)", "srgb"), alpha, 1e-3f);
    EXPECT_NEAR(seen("color texture(\"pane.png\", 0.3, 0.6)", "linear"), kStored * alpha, 2e-3f);
}

TEST_F(TextureTransferTest, FilteringIsInTheLightThatIsRead) {
    write("checker.png", ImageSpec(64, 64, 3, TypeDesc::UINT8),
          [](int x, int y, int) { return (x + y) % 2 ? kStored : 0.0f; });
    const auto wide = [](const char* name) {
        return std::string(
                   "color texture(\"checker.png\", 0.5, 0.5, \"blur\", 0.5, \"wrap\", \"periodic\", \"colorspace\", \"") +
               name + "\")";
    };
    EXPECT_NEAR(seen(wide("srgb"), ""), kDecoded / 2, 5e-3f);
    EXPECT_NEAR(seen(wide("linear"), ""), kStored / 2, 5e-3f);
}

}  // namespace
}  // namespace trapeze
