/// Pictures in colour spaces of colour management: a lookup's "colorspace", and rules for names of files.
#include <gmock/gmock.h>

#include "shade/maps/map_files_harness.h"
#include "shade/materials/shader_folder_harness.h"
#include "shade/shading_harness.h"

namespace trapeze {
namespace {

using OIIO::ImageSpec;
using OIIO::TypeDesc;
using testing::expect_near_triple;
using ::testing::HasSubstr;
using testing::ShaderFolder;
using testing::ShadingScene;
using ::testing::SizeIs;

/// Colours squared, with red and green exchanged.
class SquaredAndSwapped final : public ColorTransform {
  public:
    void apply(float* rgba, size_t pixels) const override {
        for (float* pixel = rgba; pixel != rgba + 4 * pixels; pixel += 4) {
            std::swap(pixel[0], pixel[1]);
            for (int c = 0; c < 3; ++c) pixel[c] *= pixel[c];
        }
    }
};

/// A config with the spaces "work", "paint" and "broken"; files called *.paint.* are in "paint".
class FakeColors final : public ColorManagement {
  public:
    const ColorNames& names() const override { return names_; }
    const ColorTransform& view() const override { return transform_; }
    bool view_is_srgb() const override { return false; }
    std::string space_named(std::string_view name) const override {
        return name == "work" || name == "paint" || name == "broken" ? std::string(name) : "";
    }
    std::string spaces_listed() const override { return "\"work\", \"paint\", \"broken\""; }
    std::string space_of_file(const std::string& path) const override {
        return path.find(".paint.") == std::string::npos ? "" : "paint";
    }
    std::shared_ptr<const ColorTransform> from_space(const std::string& space,
                                                     std::string* problem) const override {
        if (space == "work") return nullptr;
        if (space == "paint") return std::make_shared<const SquaredAndSwapped>();
        *problem = "a table is missing";
        return nullptr;
    }

  private:
    ColorNames names_{"work", "screen", "plain", ""};
    SquaredAndSwapped transform_;
};

constexpr float kChannels[] = {0.8f, 0.4f, 0.2f, 0.5f};

class TextureSpacesTest : public MapFilesTest {
  protected:
    /// A picture of one colour.
    void even(const std::string& name, int channels, TypeDesc format, bool unassociated = false) const {
        ImageSpec spec(8, 8, channels, format);
        if (unassociated) spec.attribute("oiio:UnassociatedAlpha", 1);
        write(name, spec, [](int, int, int c) { return kChannels[c]; });
    }
    V3f seen(const std::string& call, bool managed = true) {
        shaders_.write("look", "surface look() { Ci = " + call + "; Oi = 1; }");
        ShadingScene scene;
        if (managed) scene.context.colors = std::make_shared<const FakeColors>();
        scene.scene.options.search_paths["shader"] = {shaders_.path()};
        scene.scene.options.search_paths["texture"] = {folder_.string()};
        scene.surface("look");
        const ShadingGrid grid = scene.shaded();
        reported_ = scene.reported;
        return {grid.Ci.at(0).x, grid.Ci.at(0).y, grid.Ci.at(0).z};
    }
    static std::string look_up(const std::string& file, const std::string& space = "") {
        return "color texture(\"" + file + "\", 0.3, 0.6" +
               (space.empty() ? "" : ", \"colorspace\", \"" + space + "\"") + ")";
    }
    static void expect_near_triple(const V3f& is, const V3f& wanted, float most = 0.004f) {
        for (int c = 0; c < 3; ++c) EXPECT_NEAR(is[c], wanted[c], most) << c;
    }

    const V3f kAsStored{0.8f, 0.4f, 0.2f}, kConverted{0.16f, 0.64f, 0.04f};
    ShaderFolder shaders_;
    std::vector<Diagnostic> reported_;
};

TEST_F(TextureSpacesTest, LookupsNameThem) {
    even("a.png", 3, TypeDesc::UINT8), even("a.tif", 3, TypeDesc::UINT16), even("a.exr", 3, TypeDesc::HALF);
    even("b.exr", 3, TypeDesc::FLOAT);
    for (const char* file : {"a.png", "a.tif", "a.exr", "b.exr"}) {
        SCOPED_TRACE(file);
        expect_near_triple(seen(look_up(file)), kAsStored);
        expect_near_triple(seen(look_up(file, "paint")), kConverted);
        expect_near_triple(seen(look_up(file, "work")), kAsStored);
        expect_near_triple(seen(look_up(file, "linear")), kAsStored);
        expect_near_triple(seen(look_up(file) + " * 0.5 + 0.5 * " + look_up(file, "paint")),
                           (kAsStored + kConverted) / 2);
        EXPECT_TRUE(reported_.empty());
    }
    EXPECT_NEAR(seen("float texture(\"a.png\"[1], 0.3, 0.6, \"colorspace\", \"paint\")").x, 0.64f, 0.004f);
    expect_near_triple(seen("color environment(\"a.png\", N, \"colorspace\", \"paint\")"), kConverted);
}

TEST_F(TextureSpacesTest, RulesAreForColoursThatNobodySpeaksOf) {
    even("a.paint.png", 3, TypeDesc::UINT8), even("grey.paint.png", 1, TypeDesc::UINT8);
    expect_near_triple(seen(look_up("a.paint.png")), kConverted);
    expect_near_triple(seen(look_up("a.paint.png"), false), kAsStored);
    expect_near_triple(seen(look_up("a.paint.png", "linear")), kAsStored);
    expect_near_triple(seen(look_up("a.paint.png", "work")), kAsStored);
    EXPECT_NEAR(seen("float texture(\"a.paint.png\", 0.3, 0.6)").x, 0.8f, 0.004f) << "a mask";
    EXPECT_NEAR(seen(look_up("grey.paint.png")).x, 0.8f, 0.004f);
    EXPECT_NEAR(seen(look_up("grey.paint.png", "paint")).x, 0.64f, 0.004f) << "it is asked for";
}

TEST_F(TextureSpacesTest, AlphaIsLeftAloneAndColoursAreConvertedWithoutIt) {
    // Stored as they are, and multiplied after they are converted.
    even("apart.png", 4, TypeDesc::UINT8, true), even("apart.tif", 4, TypeDesc::UINT16, true);
    // Stored multiplied: divided for it.
    even("together.exr", 4, TypeDesc::FLOAT);
    for (const char* file : {"apart.png", "apart.tif"}) {
        expect_near_triple(seen(look_up(file, "paint")), kConverted / 2);
        EXPECT_NEAR(
            seen("float texture(\"" + std::string(file) + "\"[3], 0.3, 0.6, \"colorspace\", \"paint\")").x,
            0.5f, 0.004f);
    }
    expect_near_triple(seen(look_up("together.exr", "paint")), V3f(0.32f, 1.28f, 0.08f));
}

TEST_F(TextureSpacesTest, LevelsAreFilteredAfterColoursAreConverted) {
    // Rows of 1 and 0, which squares leave as they are: only the mean's square would differ from the mean.
    write("rows.png", ImageSpec(64, 64, 3, TypeDesc::UINT8),
          [](int, int y, int) { return y % 2 ? 1.0f : 0.0f; });
    const auto mean = [&](const std::string& more) {
        return seen("color texture(\"rows.png\", 0.5, 0.5, \"blur\", 0.5" + more + ")").x;
    };
    EXPECT_NEAR(mean(""), 0.5f, 0.1f);
    EXPECT_NEAR(mean(", \"colorspace\", \"paint\""), mean(""), 0.002f);
}

TEST_F(TextureSpacesTest, ThatCannotBeUsedAreReported) {
    even("a.png", 3, TypeDesc::UINT8);
    seen(look_up("a.png", "broken"));
    ASSERT_THAT(reported_, SizeIs(1));
    EXPECT_EQ(reported_[0].severity, Severity::Error);
    EXPECT_THAT(reported_[0].text,
                HasSubstr("texture \"a.png\": colour space \"broken\": a table is missing"));
    expect_near_triple(seen(look_up("a.png", "acescg")), kAsStored);
    ASSERT_THAT(reported_, SizeIs(1));
    EXPECT_EQ(reported_[0].severity, Severity::Warning);
    EXPECT_THAT(
        reported_[0].text,
        HasSubstr("\"acescg\" is not known, there are \"work\", \"paint\", \"broken\", and \"linear\""));
}

}  // namespace
}  // namespace trapeze
