/// Every map call of the shading language with arguments of every storage: what is the same at all vertices
/// gives what varying arguments of the same values give, in all channels.
#include "shade/maps/map_files_harness.h"
#include "shade/maps/map_service.h"
#include "shade/vm/run_shader_harness.h"

namespace trapeze {
namespace {

using testing::ShaderRun;

/// What a shader's text calls its coordinates.
struct Storage {
    const char* name;
    const char *s, *t, *n;
};
constexpr Storage kVarying{"varying", "vs", "vt", "vn"};
constexpr Storage kStorages[] = {{"constants", ".75", ".6", "normal(.2, .3, -1)"},
                                 {"uniform", "us", "ut", "un"},
                                 {"mixed", "us", "vt", "un"},
                                 {"otherwise mixed", "vs", ".6", "vn"},
                                 kVarying};

class MapCallsTest : public MapFilesTest {
  protected:
    MapCallsTest() {
        picture_ =
            write("picture.exr", OIIO::ImageSpec(32, 32, 3, OIIO::TypeDesc::FLOAT), [](int x, int y, int c) {
                return c == 0 ? static_cast<float>(x) / 32 : c == 1 ? static_cast<float>(y) / 64 : 0.125f;
            });
        sky_ = write("sky.exr", OIIO::ImageSpec(64, 32, 3, OIIO::TypeDesc::FLOAT), [](int x, int y, int c) {
            return c == 0 ? static_cast<float>(x) / 64 : c == 1 ? static_cast<float>(y) / 32 : 0.125f;
        });
        depths_ =
            write_depth_map("depths.tif", 32, false, [](int x, int) { return x < 16 ? 1.0f : 9.0f; }, {});
    }

    /// A shader's text with coordinates and files in the places of $names.
    static std::string with(std::string call, const Storage& storage, const MapCallsTest& files) {
        const auto put = [&](const std::string& what, const std::string& by) {
            for (size_t at; (at = call.find(what)) != std::string::npos;) call.replace(at, what.size(), by);
        };
        put("$corners", "$s, $t, $s + .1, $t, $s, $t + .1, $s + .1, $t + .1");
        put("$vectors",
            "vector($s, $t, .5), vector($s + .1, $t, .5), vector($s, $t + .1, .5), vector($s + .1, $t + .1, "
            ".5)");
        put("$points",
            "point($t - .7, 0, 5), point($t - .6, 0, 5), point($t - .7, .1, 5), point($t - .6, .1, 5)");
        put("$s", storage.s), put("$t", storage.t), put("$n", storage.n);
        put("$picture", "\"" + files.picture_ + "\"");
        put("$Sky", "\"" + files.sky_ + "\"");
        put("$depths", "\"" + files.depths_ + "\"");
        return call;
    }

    std::unique_ptr<ShaderRun> run(const std::string& body, bool optimised = true) {
        auto shader = std::make_unique<ShaderRun>(
            "surface test(uniform float us = .75, ut = .6; uniform normal un = normal(.2, .3, -1);"
            "output varying color c = .5; output varying float f = .5; output varying float numbers[16] = "
            "{0};) {"
            "varying float vs = us + (s - s), vt = ut + (t - t); varying normal vn = un + (N - N);" +
                body + "}",
            optimised, 15, 15);
        MapService service(textures_, scene_);
        vm::Context context;
        context.maps = &service;
        shader->run(context);
        EXPECT_EQ(shader->messages(), "") << body;
        return shader;
    }

    Scene scene_;
    Textures textures_{options_, &diagnostics_};
    std::string picture_, sky_, depths_;
};

TEST_F(MapCallsTest, StorageOfArgumentsDoesNotMatter) {
    const char* const calls[] = {
        "color c1 = texture($picture, $s, $t); c = c1;",
        "c = texture($picture, $corners);",
        "c = texture($picture, $s, $t, \"blur\", .1 * $t);",
        "uniform color k = color(1, 1, 1); c = k * color environment($Sky, vector($s, $t, .5));",
        "c = environment($Sky, $vectors);",
        "c = color(bump($picture, $n, vector(1, $s, 0), vector($t, 1, 0), $s, $t));",
        "c = color(bump($picture, $n, vector(1, $s, 0), vector($t, 1, 0), $corners));",
        "f = texture($picture[1], $s, $t); c = (f, 2 * f, 3 * f);",
        "f = texture($picture, $corners); c = (f, 2 * f, 3 * f);",
        "f = environment($Sky[1], vector($s, $t, .5)); c = (f, 2 * f, 3 * f);",
        "f = environment($Sky, $vectors); c = (f, 2 * f, 3 * f);",
        "f = shadow($depths, point($t - .6, 0, 5)); c = (f, 2 * f, 3 * f);",
        "f = shadow($depths, $points); c = (f, 2 * f, 3 * f);",
        "c = shadow($depths, $points, \"blur\", $s) * (1, 2, 3);",
    };
    for (const char* call : calls) {
        const auto truth = run(with(call, kVarying, *this));
        const V3f expected(truth->at("c", 0, 0), truth->at("c", 0, 1), truth->at("c", 0, 2));
        EXPECT_TRUE(expected.x != expected.y && expected.y != expected.z) << call << expected;
        for (const Storage& storage : kStorages)
            for (const bool optimised : {false, true}) {
                const auto shader = run(with(call, storage, *this), optimised);
                for (size_t i = 0; i < shader->vertices(); ++i)
                    for (int k = 0; k < 3; ++k)
                        ASSERT_NEAR(shader->at("c", i, k), expected[k], 1e-5f)
                            << call << " " << storage.name << " vertex " << i << " channel " << k;
            }
    }
    EXPECT_TRUE(reported_.empty());
}

TEST_F(MapCallsTest, TheColourOfAPlaceIsThePictures) {
    for (const Storage& storage : kStorages) {
        const auto shader = run(with("c = texture($picture, $s, $t);", storage, *this));
        const float expected[] = {23.5f / 32, 18.7f / 64, 0.125f};
        for (int k = 0; k < 3; ++k)
            EXPECT_NEAR(shader->at("c", 200, k), expected[k], 1e-3f) << storage.name << k;
    }
}

TEST_F(MapCallsTest, WhatIsUniformIsLookedUpWhicheverVerticesAreThere) {
    // The first vertex is not.
    const auto shader =
        run(with("if (s > .4) { c = texture($picture, .75, .6); f = shadow($depths, point(-.5, 0, 5)); }",
                 kVarying, *this));
    for (size_t i = 0; i < shader->vertices(); ++i) {
        const bool there = shader->grid().s[i] > 0.4f;
        EXPECT_NEAR(shader->at("c", i, 2), there ? 0.125f : 0.5f, 1e-5f) << i;
        EXPECT_EQ(shader->at("f", i), there ? 1.0f : 0.5f) << i;
    }
}

TEST_F(MapCallsTest, OptionsMayVary) {
    const auto varying =
        run(with("c = texture($picture[2 * step(.5, s)], .75, .6, \"fill\", s);", kVarying, *this));
    for (size_t i = 0; i < varying->vertices(); ++i) {
        const float s = varying->grid().s[i];
        EXPECT_NEAR(varying->at("c", i, 0), s < 0.5f ? 23.5f / 32 : 0.125f, 1e-3f) << s;
        EXPECT_NEAR(varying->at("c", i, 2), s < 0.5f ? 0.125f : s, 1e-3f) << s;
    }
    const auto blurred =
        run(with("f = texture($picture, .75, .6, \"blur\", 2 * s, \"wrap\", \"clamp\");", kVarying, *this));
    EXPECT_NEAR(blurred->at("f", 0), 23.5f / 32, 1e-3f);
    EXPECT_NEAR(blurred->at("f", 15), 0.5f, 0.1f);
}

TEST_F(MapCallsTest, MatricesOfMapsTakePointsOfCurrentSpace) {
    scene_.camera_from_world = M44f(0, 1, 0, 0, -1, 0, 0, 0, 0, 0, 1, 0, 3, 5, 7, 1);
    const auto shader = run(with(
        "uniform matrix view = 1, screen = 1; f = textureinfo($depths, \"viewingmatrix\", view) +"
        " textureinfo($depths, \"projectionmatrix\", screen);"
        "point world = point(.25, .5, 2), here = point(3 - .5, 5 + .25, 7 + 2);"
        "c = color(distance(transform(view, here), world), distance(transform(screen, here), world), 0);",
        kVarying, *this));
    EXPECT_EQ(shader->at("f", 0), 2);
    EXPECT_NEAR(shader->at("c", 0, 0), 0,
                1e-5f);  // the map's camera is the world's, and sees it orthographically
    EXPECT_NEAR(shader->at("c", 0, 1), 0, 1e-5f);
}

TEST_F(MapCallsTest, InfoGoesToVariablesOfEveryKind) {
    for (const char* storage : {"uniform", "varying"}) {
        const std::string var(storage);
        const auto shader = run(
            with(var + " float size[2] = {0, 0}, channels = 0, found[5]; " + var + " matrix m = 0;" + var +
                     " float as_numbers[16]; string type = \"\", wrap = \"none\"; color wrong = .25;"
                     "found[0] = textureinfo($picture, \"resolution\", size);"
                     "found[1] = textureinfo($picture, \"channels\", channels);"
                     "found[2] = textureinfo($depths, \"viewingmatrix\", m);"
                     "found[3] = textureinfo($depths, \"projectionmatrix\", as_numbers);"
                     "found[4] = textureinfo($picture, \"type\", type);"
                     "numbers[0] = size[0]; numbers[1] = size[1]; numbers[2] = channels;"
                     "numbers[3] = comp(m, 0, 0); numbers[4] = comp(m, 0, 1); numbers[5] = as_numbers[5];"
                     "numbers[6] = (type == \"texture\") ? 1 : 0;"
                     "numbers[7] = found[0] + found[1] + found[2] + found[3] + found[4];"
                     "numbers[8] = textureinfo($picture, \"wrapmodes\", wrap) + ((wrap == \"none\") ? 2 : 0);"
                     "numbers[9] = textureinfo($picture, \"viewingmatrix\", m);"
                     "numbers[10] = textureinfo($picture, \"channels\", wrong) + comp(wrong, 1);",
                 kVarying, *this));
        const float expected[] = {32, 32, 3, 1, 0, 1, 1, 5, 2, 0, 0.25f};
        for (size_t e = 0; e < std::size(expected); ++e)
            for (const size_t vertex : {0, 100, 255})
                EXPECT_EQ(shader->at("numbers", vertex, 0, e), expected[e]) << storage << " " << e;
    }
}

}  // namespace
}  // namespace trapeze
