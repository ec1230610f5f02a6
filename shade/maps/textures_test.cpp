#include "shade/maps/textures.h"

#include <OpenImageIO/imageio.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <cmath>
#include <filesystem>
#include <string>

#include "shade/shading_harness.h"

namespace trapeze {
namespace {

using testing::expect_near_triple;
using testing::finite;
using testing::number;
using testing::ShadingScene;
using testing::text;

namespace fs = std::filesystem;

/// Top row red, green; bottom row blue, grey 188 (0.5029 in linear light).
class TexturesTest : public ::testing::Test {
  protected:
    TexturesTest() {
        OIIO::attribute("threads", 1);  // its own threads are not known to sanitizers
        folder_ =
            fs::temp_directory_path() / ("trapeze_textures_" + std::to_string(::getpid()) + "_" +
                                         ::testing::UnitTest::GetInstance()->current_test_info()->name());
        fs::create_directories(folder_);
    }
    ~TexturesTest() override { fs::remove_all(folder_); }

    /// Each quarter is `side` pixels wide.
    std::string write(const std::string& name, int side, OIIO::TypeDesc format = OIIO::TypeDesc::UINT8,
                      const char* wrap = nullptr) const {
        static constexpr float kQuarters[4][3] = {
            {1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {188 / 255.0f, 188 / 255.0f, 188 / 255.0f}};
        std::vector<float> pixels;
        for (int y = 0; y < 2 * side; ++y)
            for (int x = 0; x < 2 * side; ++x) {
                const float* quarter = kQuarters[(y / side) * 2 + x / side];
                pixels.insert(pixels.end(), quarter, quarter + 3);
            }
        const std::string path = (folder_ / name).string();
        OIIO::ImageSpec spec(2 * side, 2 * side, 3, format);
        if (wrap) spec.attribute("wrapmodes", wrap);
        const auto out = OIIO::ImageOutput::create(path);
        EXPECT_TRUE(out && out->open(path, spec) && out->write_image(OIIO::TypeDesc::FLOAT, pixels.data()) &&
                    out->close());
        return path;
    }

    static V3f look(Textures& textures, const Textures::Picture* picture, float s, float t,
                    float width = 0.001f) {
        if (!picture) return V3f(-1);
        PlanePool pool;
        pool.start(1);
        const auto plane = [&](float value) {
            const Plane made = pool.take();
            fill(value, made);
            return made;
        };
        const Plane3 out = pool.take3();
        textures.lookup(*picture, {plane(s), plane(t), plane(width), plane(0), plane(0), plane(width)}, 1,
                        out);
        return {out.x[0], out.y[0], out.z[0]};
    }

    fs::path folder_;
    Options options_;
    std::vector<Diagnostic> reported_;
    Diagnostics diagnostics_{[this](const Diagnostic& d) { reported_.push_back(d); }};
};

const float kGrey = std::pow((188 / 255.0f + 0.055f) / 1.055f, 2.4f);

TEST_F(TexturesTest, TRunsDownFromTheTopRow) {
    Textures textures(options_, &diagnostics_);
    const Textures::Picture* picture = textures.find(write("quarters.png", 16), {}, Transfer::Auto);
    expect_near_triple(look(textures, picture, 0.25f, 0.25f), V3f(1, 0, 0), 1e-4f, "top left");
    expect_near_triple(look(textures, picture, 0.75f, 0.25f), V3f(0, 1, 0), 1e-4f, "top right");
    expect_near_triple(look(textures, picture, 0.25f, 0.75f), V3f(0, 0, 1), 1e-4f, "bottom left");
    expect_near_triple(look(textures, picture, 0.75f, 0.75f), V3f(kGrey), 1e-3f, "bottom right");
    EXPECT_TRUE(reported_.empty());
}

/// The average of a 2x2 picture, wrapped around, is the same for linear filters wherever it is centred.
TEST_F(TexturesTest, FilteringIsInLinearLight) {
    Textures textures(options_, &diagnostics_);
    const Textures::Picture* picture = textures.find(write("two.png", 1), {}, Transfer::Auto);
    const float blue_red = (1 + kGrey) / 4;
    expect_near_triple(look(textures, picture, 0.5f, 0.5f, 1), V3f(blue_red), 2e-3f);
}

TEST_F(TexturesTest, FloatsAreTakenAsTheyAre) {
    Textures textures(options_, &diagnostics_);
    const Textures::Picture* picture = textures.find(write("quarters.exr", 16, OIIO::TypeDesc::HALF), {});
    expect_near_triple(look(textures, picture, 0.75f, 0.75f), V3f(188 / 255.0f), 1e-3f);
    expect_near_triple(look(textures, picture, 0.25f, 0.75f), V3f(0, 0, 1), 1e-3f);
}

TEST_F(TexturesTest, OutsidePicturesIsBlackUnlessTheySayOtherwise) {
    Textures textures(options_, &diagnostics_);
    const Textures::Picture* plain = textures.find(write("plain.exr", 16, OIIO::TypeDesc::HALF), {});
    const Textures::Picture* periodic =
        textures.find(write("periodic.exr", 16, OIIO::TypeDesc::HALF, "periodic,periodic"), {});
    expect_near_triple(look(textures, periodic, 1.25f, -0.75f), V3f(1, 0, 0), 1e-3f);
    expect_near_triple(look(textures, plain, 1.25f, 0.25f), V3f(0), 1e-3f);
    EXPECT_TRUE(reported_.empty());
}

TEST_F(TexturesTest, AreFoundAlongTheSearchPath) {
    write("here.png", 4);
    options_.search_paths["texture"] = {"/nowhere", folder_.string()};
    Textures textures(options_, &diagnostics_);
    EXPECT_NE(textures.find("here.png", {}), nullptr);
    EXPECT_EQ(textures.find("there.png", {}), nullptr);
    EXPECT_EQ(textures.find("", {}), nullptr);
    ASSERT_EQ(reported_.size(), 1u);
    EXPECT_EQ(reported_[0].text, "texture \"there.png\": is not found");
}

TEST_F(TexturesTest, TheirSourcesStandInForThem) {
    write("here.png", 4);
    options_.search_paths["texture"] = {folder_.string()};
    Textures textures(options_, &diagnostics_);
    EXPECT_NE(textures.find("here.tex", {}), nullptr);
    ASSERT_EQ(reported_.size(), 1u);
    EXPECT_EQ(reported_[0].severity, Severity::Warning);
    EXPECT_EQ(textures.find("raytrace", {}), nullptr);
    ASSERT_EQ(reported_.size(), 2u);
    EXPECT_EQ(reported_[1].severity, Severity::Warning);
    EXPECT_EQ(reported_[1].text, "texture \"raytrace\": rays are not traced");
}

TEST_F(TexturesTest, BrokenOnesAreReportedOnceAndWhite) {
    const std::string path = (folder_ / "broken.png").string();
    std::fclose(std::fopen(path.c_str(), "w"));
    ShadingScene scene;
    scene.light("ambientlight");
    scene.surface("paintedplastic", {text("texturename", path)});
    const ShadingGrid grid = scene.shaded();
    ASSERT_EQ(scene.reported.size(), 1u);
    EXPECT_EQ(scene.reported[0].severity, Severity::Error);
    EXPECT_NE(scene.reported[0].text.find("broken.png"), std::string::npos) << scene.reported[0].text;
    EXPECT_GT(grid.Cs.at(0).x, 0);
    expect_near_triple(grid.Ci.at(0), grid.Cs.at(0) * grid.Os.at(0), 1e-6f);
}

TEST_F(TexturesTest, PaintedPlasticIsPainted) {
    ShadingScene scene;
    scene.light("ambientlight");
    scene.surface("paintedplastic", {text("texturename", write("quarters.png", 32))});
    set_transfer(scene.scene.options, "auto");
    const ShadingGrid before = scene.grid(16, 16), grid = scene.shaded(before);
    const auto seen = [&](int i, int j) { return grid.Ci.at(grid.shape.row_index(i, j)); };
    const V3f base = grid.Cs.at(0) * grid.Os.at(0);
    expect_near_triple(seen(4, 4), base * V3f(1, 0, 0), 1e-3f);
    expect_near_triple(seen(12, 4), base * V3f(0, 1, 0), 1e-3f);
    expect_near_triple(seen(4, 12), base * V3f(0, 0, 1), 1e-3f);
    expect_near_triple(seen(12, 12), base * kGrey, 1e-3f);
    EXPECT_TRUE(scene.reported.empty());
}

TEST_F(TexturesTest, RisSurfacesRepeatPicturesAndHaveGreyOfOneChannel) {
    const std::string path = (folder_ / "grey.exr").string();
    const OIIO::ImageSpec spec(4, 4, 1, OIIO::TypeDesc::FLOAT);
    const std::vector<float> pixels(16, 0.5f);
    const auto out = OIIO::ImageOutput::create(path);
    ASSERT_TRUE(out && out->open(path, spec) && out->write_image(OIIO::TypeDesc::FLOAT, pixels.data()) &&
                out->close());
    ShadingScene scene;
    scene.light("ambientlight");
    scene.surface("rissurface", {text("texturename", path), number("scales", 5)});
    const ShadingGrid grid = scene.shaded(scene.grid(8, 8));
    for (size_t i = 0; i < grid.vertex_count(); ++i)
        expect_near_triple(grid.Ci.at(i), grid.Cs.at(i) * grid.Os.at(i) * 0.5f, 1e-3f);
}

TEST_F(TexturesTest, FilterWidthsComeFromTheGrid) {
    ShadingScene scene;
    scene.light("ambientlight");
    const std::string picture = write("quarters.png", 32, OIIO::TypeDesc::UINT8, "periodic,periodic");
    scene.surface("paintedplastic", {text("texturename", picture)});
    set_transfer(scene.scene.options, "srgb");
    ShadingGrid grid = scene.grid(1, 1);
    const V3f average = V3f((1 + kGrey) / 4);
    const V3f base = grid.Cs.at(0) * grid.Os.at(0);
    for (float& s : grid.s) s = s * 4 + 0.25f;  // four pictures in a micropolygon
    for (float& t : grid.t) t = t * 4 + 0.25f;
    const ShadingGrid shaded = scene.shaded(grid);
    for (size_t i = 0; i < 4; ++i) expect_near_triple(shaded.Ci.at(i), base * average, 0.01f);
}

TEST_F(TexturesTest, ANameOnThePrimitiveReplacesTheShaders) {
    ShadingScene scene;
    scene.light("ambientlight");
    scene.surface("paintedplastic");
    ShadingGrid grid = scene.grid(16, 16);
    GridVariable name;
    name.name = "texturename", name.declaration = {StorageClass::Constant, ValueType::String, 1};
    name.uniform = true, name.strings = {write("quarters.png", 32)};
    grid.variables.push_back(name);
    const ShadingGrid shaded = scene.shaded(grid);
    const size_t at = grid.shape.row_index(4, 4);
    expect_near_triple(shaded.Ci.at(at), grid.Cs.at(at) * grid.Os.at(at) * V3f(1, 0, 0), 1e-3f);
}

TEST_F(TexturesTest, CoordinatesThatAreNotNumbersAreHarmless) {
    ShadingScene scene;
    scene.light("ambientlight");
    scene.surface("paintedplastic", {text("texturename", write("quarters.png", 8))});
    ShadingGrid grid = scene.grid();
    grid.s[1] = std::nanf("");
    grid.t[2] = INFINITY;
    EXPECT_TRUE(finite(scene.shaded(grid).Ci));
}

}  // namespace
}  // namespace trapeze
