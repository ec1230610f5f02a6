#include "shade/imager.h"

#include "shade/materials/shader_folder_harness.h"
#include "shade/shading_harness.h"

namespace trapeze {
namespace {

using testing::color;
using testing::number;
using testing::shader;
using testing::ShaderFolder;
using testing::ShadingScene;
using Pixels = std::vector<float>;

/// A row of one pixel, or some, after the imager.
Pixels imaged(const ShadingScene& scene, Pixels rgba, int x0 = 0, int y = 0) {
    const Imager imager(scene.context);
    EXPECT_TRUE(imager.is_there());
    imager.run(x0, y, static_cast<int>(rgba.size() / 4), rgba.data());
    return rgba;
}

void set_imager(ShadingScene& scene, std::string name, std::vector<Parameter> parameters = {}) {
    scene.scene.options.imager =
        std::make_shared<ShaderInstance>(shader(std::move(name), std::move(parameters)));
}

TEST(Imager, ClampToAlphaBoundsColoursByAlpha) {
    ShadingScene scene;
    set_imager(scene, "clamptoalpha");
    EXPECT_EQ(imaged(scene, {2, 0.25f, -1, 0.5f, 0.5f, 3, 1, 1.5f}),
              (Pixels{0.5f, 0.25f, 0, 0.5f, 0.5f, 1, 1, 1}));
}

TEST(Imager, BackgroundFillsWhatIsTransparent) {
    ShadingScene scene;
    set_imager(scene, "background", {color("bgcolor", {1, 0.5f, 0.25f})});
    EXPECT_EQ(imaged(scene, {0, 0, 0, 0, 0.25f, 0.25f, 0.25f, 0.5f, 1, 0, 0, 1}),
              (Pixels{1, 0.5f, 0.25f, 1, 0.75f, 0.5f, 0.375f, 1, 1, 0, 0, 1}));
}

TEST(Imager, ABackgroundMayLeaveAlphaAsItIs) {
    ShadingScene scene;
    set_imager(scene, "background", {color("bgcolor", {1, 0.5f, 0.25f}), number("bgalpha", 0)});
    EXPECT_EQ(imaged(scene, {0, 0, 0, 0, 0.25f, 0.25f, 0.25f, 0.5f}),
              (Pixels{1, 0.5f, 0.25f, 0, 0.75f, 0.5f, 0.375f, 0.5f}));
}

/// MOSAICbackground of Blender's exporter, for one.
TEST(Imager, AMissingOneWithABackgroundsColourIsABackground) {
    ShadingScene scene;
    set_imager(scene, "MOSAICbackground", {color("bgcolor", {1, 0.5f, 0.25f}), number("CompositeBlend", 1)});
    EXPECT_EQ(imaged(scene, {0, 0, 0, 0}), (Pixels{1, 0.5f, 0.25f, 1}));
    ASSERT_EQ(scene.reported.size(), 1u);
    EXPECT_EQ(scene.reported[0].text, "Imager: there is no shader \"MOSAICbackground\"; background is used");
}

TEST(Imager, LongRowsAreRunInPartsAlike) {
    ShadingScene scene;
    set_imager(scene, "clamptoalpha");
    Pixels row;
    for (int i = 0; i < 3000; ++i) row.insert(row.end(), {static_cast<float>(i), 0.25f, 0, 0.5f});
    const Pixels result = imaged(scene, row);
    for (size_t i = 0; i < 3000; ++i) ASSERT_EQ(result[4 * i], i == 0 ? 0 : 0.5f) << i;
}

TEST(Imager, SeesItsPixelsPlacesAndTime) {
    ShadingScene scene;
    const ShaderFolder folder;
    folder.write("show",
                 "imager show() { Ci = color(xcomp(P), ycomp(P), time + 10 * "
                 "dtime + 100 * ncomps); alpha = random(); }");
    scene.scene.options.search_paths["shader"] = {folder.path()};
    scene.scene.options.shutter_open = 0.25f, scene.scene.options.shutter_close = 0.75f;
    set_imager(scene, "show");
    const Pixels row = imaged(scene, Pixels(8), 5, 7);
    EXPECT_EQ(row[0], 5.5f);
    EXPECT_EQ(row[1], 7.5f);
    EXPECT_FLOAT_EQ(row[2], 0.25f + 5 + 300);
    EXPECT_EQ(row[4], 6.5f);
    EXPECT_NE(row[3], row[7]);
    // A pixel is the same in whatever row it is run: crops show it as the whole picture does.
    const Pixels alone = imaged(scene, Pixels(4), 6, 7);
    EXPECT_TRUE(std::equal(alone.begin(), alone.end(), row.begin() + 4));
}

TEST(Imager, TextureCoordinatesRunOverTheWholePicture) {
    ShadingScene scene;
    const ShaderFolder folder;
    folder.write("show", "imager show() { Ci = color(s, t, u - v); alpha = u; }");
    scene.scene.options.search_paths["shader"] = {folder.path()};
    scene.context.camera.width = 8, scene.context.camera.height = 4;
    scene.context.camera.crop = {4, 2, 8, 4};
    set_imager(scene, "show");
    EXPECT_EQ(imaged(scene, Pixels(8), 4, 3),
              (Pixels{0.5625f, 0.875f, -0.3125f, 0.5625f, 0.6875f, 0.875f, -0.1875f, 0.6875f}));
}

TEST(Imager, WhatIsNotFiniteBecomesZero) {
    ShadingScene scene;
    const ShaderFolder folder;
    folder.write("bad", "imager bad() { Ci = Ci * 1e38 * 1e38; }");
    scene.scene.options.search_paths["shader"] = {folder.path()};
    set_imager(scene, "bad");
    EXPECT_EQ(imaged(scene, {1, 0, 1, 0.5f}), (Pixels{0, 0, 0, 0.5f}));
}

TEST(Imager, SendsNoRays) {
    for (const char* asks :
         {"Ci = trace(P, vector(0, 0, 1));", "Ci = 1 - transmission(P, P + vector(0, 0, 1));",
          "Ci = occlusion(P, normal(0, 0, 1), 4);",
          "Ci = 0; gather(\"\", P, vector(0, 0, 1), 0, 4) Ci = 1;"}) {
        ShadingScene scene;
        const ShaderFolder folder;
        folder.write("sees", std::string("imager sees() { ") + asks + " }");
        scene.scene.options.search_paths["shader"] = {folder.path()};
        set_imager(scene, "sees");
        EXPECT_EQ(imaged(scene, {1, 0, 1, 0.5f, 1, 0, 1, 1}), (Pixels{0, 0, 0, 0.5f, 0, 0, 0, 1}));
        ASSERT_EQ(scene.reported.size(), 1u) << asks;
        EXPECT_EQ(scene.reported[0].kind, "rsl-imager-rays");
    }
}

TEST(Imager, OneThatIsNotThereIsAnErrorAndOneOfAnotherKindToo) {
    ShadingScene scene;
    EXPECT_FALSE(Imager(scene.context).is_there());
    EXPECT_TRUE(scene.reported.empty());
    set_imager(scene, "nosuch");
    EXPECT_FALSE(Imager(scene.context).is_there());
    ASSERT_EQ(scene.reported.size(), 1u);
    EXPECT_EQ(scene.reported[0].severity, Severity::Error);
    set_imager(scene, "plastic");
    EXPECT_FALSE(Imager(scene.context).is_there());
    EXPECT_GE(scene.reported.size(), 2u);
}

}  // namespace
}  // namespace trapeze
