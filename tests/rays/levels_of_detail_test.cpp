/// Levels of detail that pass into each other: a ray sees one of them, and as often as samples of the camera
/// do.
#include "tests/rays/rays_harness.h"

namespace trapeze::testing {
namespace {

/// The bound is 4096 pixels large. A part of it is of the second level.
std::string first_level(const std::string& from, const std::string& to) {
    return "Detail [-1 1 -1 1 2 4] DetailRange [0 0 " + from + " " + to + "] ";
}
std::string second_level(const std::string& from, const std::string& to) {
    return "Detail [-1 1 -1 1 2 4] DetailRange [" + from + " " + to + " 1e9 1e9] ";
}

TEST(RaysAndLevelsOfDetail, ARayMeetsOneOfTwo) {
    const std::string clear = "Surface \"constant\" Opacity .5 .5 .5 Color 1 1 1 ";
    for (const auto& [from, to] : {std::pair("2048", "6144"), {"4000", "8000"}, {"100", "4200"}}) {
        Case c;
        c.things = clear + first_level(from, to) + wall("3") + second_level(from, to) + wall("2.5");
        expect_told(c.render("Ci = told(comp(transmission(P, P - vector(0, 0, 5)), 0), .5, 1);"), 1e-6f,
                    64 * 64);
        expect_told(c.render("Ci = told(comp(color trace(P, vector(0, 0, -1)), 0), .5, 1);"), 1e-6f, 64 * 64);
        expect_told(c.render("Ci = told(1 - comp(transmission(P, P - vector(0, 0, 5)), 1), .5, 1);"), 1e-6f,
                    64 * 64);
    }
}

TEST(RaysAndLevelsOfDetail, AsOftenAsItCovers) {
    Case c;
    c.things = "Surface \"constant\" " + first_level("2048", "6144") + wall("3");
    EXPECT_NEAR(mean_red(c.render("Ci = transmission(P, P - vector(0, 0, 5));")), .5, .03);
    c.things = "Surface \"constant\" " + first_level("3072", "7168") + wall("3");
    EXPECT_NEAR(mean_red(c.render("Ci = 1 - occlusion(P, normal(0, 0, -1), 16, \"coneangle\", .5);")), .25,
                .02);
    c.things = "Surface \"constant\" Color .5 0 0 " + first_level("2048", "6144") + wall("3") +
               "Color 0 1 0 " + second_level("2048", "6144") + wall("2");
    const Image seen = c.render("Ci = trace(P, vector(0, 0, -1));");
    EXPECT_NEAR(mean_red(seen), .25, .02);
    EXPECT_NEAR(mean_found(seen), .5, .03);
}

/// Instances that could share what rays meet are not seen alike where one is in transition.
TEST(RaysAndLevelsOfDetail, OfInstances) {
    Case c;
    std::string things = "ObjectBegin 1 Patch \"bilinear\" \"P\" [-1 1 0 1 1 0 -1 -1 0 1 -1 0] ObjectEnd ";
    for (int i = 0; i < 4; ++i) {
        if (i == 3) things += first_level("2048", "6144");
        things +=
            "AttributeBegin Translate " + std::to_string(3 * (3 - i)) + " 0 3 ObjectInstance 1 AttributeEnd ";
    }
    c.things = "Surface \"constant\" " + things;
    EXPECT_NEAR(mean_red(c.render("Ci = transmission(P, P - vector(0, 0, 5));")), .5, .05);
}

/// A level does not see the other one, which stands in its place: balls within balls see nothing of each
/// other.
TEST(RaysAndLevelsOfDetail, SeeTheirOwnLevelAlone) {
    const WorkFolder folder;
    folder.write("open.sl", "surface open() { Oi = 1; Ci = 1 - occlusion(P, normalize(N), 16); }");
    folder.write("a.rib",
                 "Format 32 32 1 PixelSamples 2 2 Projection \"orthographic\" WorldBegin\n"
                 "Attribute \"visibility\" \"int diffuse\" 1 Surface \"open\" Detail [-1 1 -1 1 -1 1]\n"
                 "Translate 0 0 3 DetailRange [0 0 512 1536] Sphere .6 -.6 .6 360\n"
                 "DetailRange [512 1536 1e9 1e9] Sphere .9 -.9 .9 360\nWorldEnd\n");
    const auto frames = render_scene((folder / "a.rib").string(), RenderSettings());
    ASSERT_EQ(frames.size(), 1u);
    const std::vector<Pixel> all = pixels(frames.front().image);
    const Pixel middle = all[16 * 32 + 16];
    EXPECT_EQ(middle.alpha, 1);
    EXPECT_NEAR(middle.red, 1, 1e-3f);
}

}  // namespace
}  // namespace trapeze::testing
