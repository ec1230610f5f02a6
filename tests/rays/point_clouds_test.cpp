/// bake3d() and texture3d() in scenes: what is written, bit for bit, and what is read from it.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "tests/rays/clouds_harness.h"

namespace trapeze::testing {
namespace {

constexpr const char* kSquare = "Patch \"bilinear\" \"P\" [-.9 .9 5 .9 .9 5 -.9 -.9 5 .9 -.9 5] ";

double area_of(const PartioFile& file) {
    double sum = 0;
    for (const PartioParticle& p : file.particles)
        sum += std::numbers::pi * static_cast<double>(p.radius) * static_cast<double>(p.radius);
    return sum;
}

float channel(const PartioParticle& p, const std::string& name, size_t k = 0) {
    return p.attributes.at(name).at(k);
}

/// Each vertex has a point of its own, or each micropolygon with "interpolate"; channels hold what the shader
/// said, in the order of the list, under their types; what is not in the list is left out.
TEST(PointClouds, HoldWhatIsBaked) {
    for (const bool interpolate : {false, true}) {
        Clouds clouds;
        clouds.shader("bakes",
                      "point where = transform(\"world\", P); float twice = 2 * xcomp(where);"
                      "bake3d(file, \"_twice, _rgb,_at\", P, Nn, \"interpolate\", " +
                          std::to_string(interpolate) +
                          ", \"_at\", P, \"_left\", 1, \"_twice\", twice,"
                          "\"_rgb\", color(twice, 3 * ycomp(where), 1)); Ci = 1;");
        clouds.render({"Translate 0 0 2 " + clouds.surface("bakes") + kSquare});
        clouds.expect_nothing_said();
        const PartioFile file = clouds.baked();
        EXPECT_EQ(file.specs, (std::vector<std::string>{"float _twice", "color _rgb", "point _at"}));
        ASSERT_GT(file.particles.size(), 57u * 57u);
        const float facing = file.particles.front().normal[2];
        EXPECT_EQ(std::abs(facing), 1);
        for (const PartioParticle& p : file.particles) {
            // World space is what transform() says that it is; P is moved to it.
            EXPECT_NEAR(p.position[2], 7, 1e-5f);
            for (size_t k = 0; k < 3; ++k) EXPECT_NEAR(channel(p, "_at", k), p.position[k], 1e-5f);
            EXPECT_NEAR(channel(p, "_twice"), 2 * p.position[0], 1e-5f);
            EXPECT_NEAR(channel(p, "_rgb", 0), 2 * p.position[0], 1e-5f);
            EXPECT_NEAR(channel(p, "_rgb", 1), 3 * p.position[1], 1e-5f);
            EXPECT_EQ(channel(p, "_rgb", 2), 1);
            EXPECT_NEAR(p.normal[2], facing, 0);
        }
        const bool on_border = std::ranges::any_of(
            file.particles, [](const PartioParticle& p) { return std::abs(p.position[0]) > .8999f; });
        EXPECT_EQ(on_border, !interpolate);
    }
}

/// Discs are together as large as the micropolygons: on a flat square as the square.
TEST(PointClouds, DiscsAreAsLargeAsASquare) {
    for (const char* const interpolate : {"0", "1"}) {
        Clouds clouds;
        clouds.shader("bakes",
                      std::string("bake3d(file, \"\", P, Nn, \"interpolate\", ") + interpolate + ");");
        clouds.render({clouds.surface("bakes") + kSquare});
        // Some 3500 radii, each rounded to a float.
        EXPECT_NEAR(area_of(clouds.baked()), 1.8 * 1.8, 1.8 * 1.8 * 1e-6);
        clouds.expect_nothing_said();
    }
}

/// A point of a micropolygon with corners on a sphere of radius R is no nearer to the sphere's middle than
/// sqrt(R^2 - d^2), where d is the farthest that a corner is from the corners' mean m; and d^2 is at most the
/// sum over the corners, 4 (R^2 - m^2). Seen from the middle, a part of the sphere is larger than the flat
/// one by no more than R^2 / (R^2 - d^2), and smaller by no more than R / sqrt(R^2 - d^2).
TEST(PointClouds, DiscsAreAsLargeAsASphere) {
    const double R2 = .8 * .8, whole = 4 * std::numbers::pi * R2;
    double d2 = 0;
    for (const char* const interpolate : {"1", "0"}) {
        Clouds clouds;
        clouds.shader("bakes", std::string("bake3d(file, \"\", P, Nn, \"coordsystem\", \"shader\","
                                           "\"interpolate\", ") +
                                   interpolate + ");");
        clouds.render({"Translate 0 0 3 " + clouds.surface("bakes") + "Sphere .8 -.8 .8 360"});
        const PartioFile file = clouds.baked();
        for (const PartioParticle& p : file.particles) {
            const V3f m(p.position[0], p.position[1], p.position[2]);
            d2 = std::max(d2, 4 * (R2 - static_cast<double>(m.length2())));
        }
        ASSERT_LT(d2, .01);
        EXPECT_GE(area_of(file), whole * (R2 - d2) / R2);
        EXPECT_LE(area_of(file), whole * std::sqrt(R2 / (R2 - d2)));
        clouds.expect_nothing_said();
    }
}

/// area(P, "dicing"), which shaders bake, is of micropolygons, however thin they are seen: what the point of
/// a vertex stands for is as large inside of a grid, and a half or a quarter at its borders. On a flat square
/// all are of one size.
TEST(PointClouds, AreasOfDicingAreThoseOfDiscs) {
    Clouds clouds;
    clouds.shader("bakes", "bake3d(file, \"\", P, Nn, \"_area\", area(P, \"dicing\"));");
    clouds.render({"Translate 0 0 5 Rotate 88 1 0 0 " + clouds.surface("bakes") +
                   "Patch \"bilinear\" \"P\" [-.9 .9 0 .9 .9 0 -.9 -.9 0 .9 -.9 0]"});
    const PartioFile file = clouds.baked();
    int inside = 0;
    for (const PartioParticle& p : file.particles) {
        const float parts = 4 * std::numbers::pi_v<float> * p.radius * p.radius / channel(p, "_area");
        EXPECT_NEAR(parts, std::round(parts), 2e-3f);
        EXPECT_TRUE(std::round(parts) == 1 || std::round(parts) == 2 || std::round(parts) == 4) << parts;
        inside += std::round(parts) == 4;
    }
    EXPECT_GT(inside, 50);
}

/// What no sample sees bakes, though all else that is hidden is left out before it is shaded.
TEST(PointClouds, HiddenSurfacesBake) {
    Clouds clouds;
    clouds.settings.cull_hidden = CullHidden::On;
    clouds.shader("bakes", "bake3d(file, \"\", P, Nn);");
    clouds.render({"Surface \"constant\" Patch \"bilinear\" \"P\" [-1 1 4 1 1 4 -1 -1 4 1 -1 4] " +
                   clouds.surface("bakes") + kSquare});
    EXPECT_NEAR(area_of(clouds.baked()), 1.8 * 1.8, 1.8 * 1.8 * 1e-6);
}

TEST(PointClouds, RadiiMayBeGivenAndScaled) {
    Clouds clouds;
    clouds.shader("bakes", "bake3d(file, \"\", P, Nn, \"radius\", .25 + xcomp(P), \"radiusscale\", 2);");
    clouds.render({clouds.surface("bakes") + kSquare});
    for (const PartioParticle& p : clouds.baked().particles)
        EXPECT_NEAR(p.radius, 2 * (.25f + p.position[0]), 1e-6f);
}

TEST(PointClouds, CoordinateSystemsMoveWhatIsBaked) {
    Clouds clouds;
    clouds.shader("bakes",
                  "bake3d(file, \"\", P, Nn, \"coordsystem\", \"here\", \"_n\", Nn, \"_v\","
                  "vector(0, 0, 1), \"_c\", color(0, 0, 1));");
    clouds.render({"TransformBegin Translate 0 0 5 Scale 2 2 4 CoordinateSystem \"here\" TransformEnd " +
                   clouds.surface("bakes") + kSquare});
    const PartioFile file = clouds.baked();
    EXPECT_NEAR(area_of(file), .9 * .9, 1e-5);
    for (const PartioParticle& p : file.particles) {
        EXPECT_NEAR(p.position[2], 0, 1e-6f);
        EXPECT_LE(std::abs(p.position[0]), .45001f);
        EXPECT_EQ(channel(p, "_v", 2), .25f);
        EXPECT_EQ(std::abs(channel(p, "_n", 2)), 4);
        EXPECT_EQ(channel(p, "_c", 2), 1);
    }
}

/// Where only some vertices run, these bake, and with "interpolate" the micropolygons of which all corners
/// run; in loops as often as they run.
TEST(PointClouds, BakeWhereTheyRun) {
    const std::string condition = "if (xcomp(P) > 0) { ", call = "bake3d(file, \"\", P, Nn";
    const std::vector<std::pair<std::string, double>> cases{
        {condition + call + "); }", 1},
        {condition + call + ", \"interpolate\", 1); }", 1},
        {"float i; for (i = 0; i < 3; i += 1) { if (xcomp(P) > 0) " + call + "); }", 3}};
    for (const auto& [text, times] : cases) {
        Clouds clouds;
        clouds.shader("bakes", text);
        clouds.render({clouds.surface("bakes") + kSquare});
        const PartioFile file = clouds.baked();
        for (const PartioParticle& p : file.particles) EXPECT_GT(p.position[0], 0);
        // Half of the square, but for a row of micropolygons of side 1/32 or less.
        EXPECT_NEAR(area_of(file), times * 1.8 * .9, times * 1.8 / 32 * 1.01);
        clouds.expect_nothing_said();
    }
}

/// Two surfaces, a displaced one among them, that bake into two files; rays meet them, too.
std::string scene_of_files(const Clouds& clouds) {
    return "Attribute \"displacementbound\" \"float sphere\" .1 " + kSeen + clouds.surface("bakes", "a.ptc") +
           "AttributeBegin Displacement \"bumps\" Translate -.4 0 3 Sphere .5 -.5 .5 360 AttributeEnd " +
           "AttributeBegin Translate .4 .2 4 Sphere .5 -.5 .5 360 AttributeEnd " +
           clouds.surface("bakes", "b.ptc") + kAsker;
}

std::vector<std::string> files_of(int threads, int regions, size_t memory) {
    Clouds clouds;
    clouds.threads = threads;
    clouds.settings.regions_at_least = regions;
    clouds.settings.memory_bytes = memory;
    clouds.shader("bakes",
                  "color seen = trace(P, reflect(normalize(I), Nn)); float i;"
                  "for (i = 0; i < 2 + mod(floor(8 * xcomp(P)), 2); i += 1)"
                  "  bake3d(file, \"\", P, Nn, \"_seen\", seen, \"_i\", i);"
                  "if (ycomp(P) > 0) bake3d(file, \"\", P, Nn, \"interpolate\", 1, \"_seen\", seen,"
                  "\"_i\", 9); Ci = seen + .1;");
    clouds.shader("unused", "");
    std::ofstream(clouds.file("bumps.sl")) << "displacement bumps() { P += .05 * sin(20 * u) * normalize(N);"
                                              "N = calculatenormal(P); }";
    clouds.render({scene_of_files(clouds)});
    for (const Diagnostic& d : clouds.said) EXPECT_EQ(d.kind, "memory-budget") << to_string(d);
    return {file_text(clouds.file("a.ptc")), file_text(clouds.file("b.ptc"))};
}

TEST(PointClouds, AreTheSameBitsForAnyThreadsRegionsAndMemory) {
    const std::vector<std::string> first = files_of(1, 1, 0);
    ASSERT_GT(read_as_partio(first[0]).particles.size(), 3000u);
    EXPECT_EQ(first, files_of(2, 1, 0));
    EXPECT_EQ(first, files_of(7, 1, 0));
    EXPECT_EQ(first, files_of(2, 16, 0));
    EXPECT_EQ(first, files_of(3, 1, size_t{1} << 18));
}

/// A function of known slope comes back at other points, from a frame that dices otherwise, wherever points
/// are. All points that count lie within four times the largest radius, so that it is off by no more than its
/// slope over that. Points of micropolygons are alike everywhere: of these a linear function is off by less
/// than a 270th of that in the middle of a plane (cloud_tree_test.cpp), but for the rounding of numbers of
/// about 1.
TEST(PointClouds, AreReadBackByALaterFrame) {
    for (const std::string name : {"a.ptc", "a.ply"})
        for (const bool interpolate : {false, true}) {
            Clouds clouds;
            clouds.shader("bakes",
                          "bake3d(file, \"_x,_wave\", P, Nn, \"_x\", xcomp(P), \"_wave\","
                          "color(sin(6 * xcomp(P)), 1, 0), \"interpolate\", " +
                              std::to_string(interpolate) + "); Ci = 1;");
            clouds.shader("reads",
                          "float x = -9; color wave = 0;"
                          "float found = texture3d(file, P, Nn, \"_x\", x, \"_wave\", wave);"
                          "float far = abs(sin(6 * xcomp(P)) - comp(wave, 0));"
                          "Ci = color(abs(x - xcomp(P)), far, found * comp(wave, 1));");
            const std::vector<Image> images =
                clouds.render({clouds.surface("bakes", name) + kAsker,
                               "ShadingRate .6 " + clouds.surface("reads", name) + kSquare});
            clouds.expect_nothing_said();
            ASSERT_EQ(images.size(), 2u);
            // Sides are 1/32 at most; the radius of a square of that side.
            const float reach = 4 / 32.0f / std::sqrt(std::numbers::pi_v<float>);
            int read = 0;
            for (const Pixel& p : pixels(images[1])) {
                if (p.alpha == 0) continue;
                ++read;
                EXPECT_NEAR(p.blue, 1, 1e-6f) << "a hole";
                EXPECT_LE(p.red, interpolate ? 3.7e-3f * reach + 1e-6f : reach);
                EXPECT_LE(p.green, 6 * reach);
            }
            EXPECT_GT(read, 3000);
        }
}

TEST(PointClouds, OnSpheresOneSideIsRead) {
    Clouds clouds;
    // Two shells, hardly apart, that face each other.
    clouds.shader("bakes", "bake3d(file, \"\", P, Nn, \"_radius\", length(vector(P - point(0, 0, 3))));");
    clouds.shader("reads",
                  "float radius = -1; float found = texture3d(file, P, Nn, \"_radius\", radius);"
                  "Ci = color(found, radius, length(vector(P - point(0, 0, 3))));");
    const std::string shells =
        "AttributeBegin Translate 0 0 3 Sphere .8 -.8 .8 360 ReverseOrientation "
        "Sphere .79 -.79 .79 360 AttributeEnd";
    const std::vector<Image> images = clouds.render(
        {clouds.surface("bakes") + shells, "ShadingRate 2 " + clouds.surface("reads") + shells});
    ASSERT_EQ(images.size(), 2u);
    clouds.expect_nothing_said();
    int read = 0;
    for (const Pixel& p : pixels(images[1])) {
        if (p.alpha == 0) continue;
        ++read;
        EXPECT_EQ(p.red, 1);
        EXPECT_NEAR(p.green, p.blue, 1e-5f);
    }
    EXPECT_GT(read, 1500);
}

TEST(PointClouds, NothingIsFoundWhereNothingWasBaked) {
    Clouds clouds;
    clouds.shader("bakes", "bake3d(file, \"\", P, Nn, \"_one\", 1);");
    clouds.shader("reads",
                  "float one = 7; Ci = color(texture3d(file, P, Nn, \"_one\", one), one,"
                  "texture3d(file, P + vector(0, 0, 1), Nn, \"filterradius\", 1.1));");
    const std::vector<Image> images = clouds.render(
        {clouds.surface("bakes") + kSquare, "Translate 0 0 -1 " + clouds.surface("reads") + kSquare});
    ASSERT_EQ(images.size(), 2u);
    for (const Pixel& p : pixels(images[1])) {
        if (p.alpha == 0) continue;
        EXPECT_EQ(p.red, 0);
        EXPECT_EQ(p.green, 7) << "variables stay as they are";
        EXPECT_EQ(p.blue, 1);
    }
}

/// Says what went wrong, once, at the call, and renders on.
void expect_said(const std::string& bakes, const std::string& cloud, const std::string& expected,
                 size_t points = 0) {
    Clouds clouds;
    clouds.shader("bakes", bakes);
    clouds.render({clouds.surface("bakes", cloud) + kSquare});
    ASSERT_EQ(clouds.said.size(), 1u) << bakes;
    EXPECT_NE(clouds.said[0].text.find(expected), std::string::npos) << to_string(clouds.said[0]);
    EXPECT_NE(clouds.said[0].place.find("bakes.sl:1:"), std::string::npos) << to_string(clouds.said[0]);
    EXPECT_TRUE(!points || clouds.baked(cloud).particles.size() == points);
}

TEST(PointClouds, MistakesAreSaidOnce) {
    expect_said("bake3d(\"\", \"\", P, Nn);", "", "the name of the file is empty");
    expect_said("bake3d(file, \"\", P, Nn);", "", "cannot be written: it");
    expect_said("bake3d(file, \"\", P, Nn, \"two words\", 1);", "a.ptc", "\"two words\" is no channel");
    expect_said("bake3d(file, \"\", P, Nn, \"_text\", \"a\");", "a.ptc", "\"_text\" is no channel");
    expect_said("bake3d(file, \"_a,_b\", P, Nn, \"_a\", 1);", "a.ptc", "no value for the channel \"_b\"");
    expect_said("bake3d(file, \"\", P, Nn, \"coordsystem\", \"nowhere\");", "a.ptc",
                "no coordinate system \"nowhere\"");
    expect_said("bake3d(file, \"\", P, Nn, \"_x\", xcomp(P) > 0 ? 1 / (xcomp(P) - xcomp(P)) : 1);", "a.ptc",
                "are left out: they have numbers that are not finite");
    expect_said("bake3d(file, \"\", P, Nn, \"_x\", 1); if (xcomp(P) > 0) bake3d(file, \"\", P, Nn);", "a.ptc",
                "has other channels from another call");
    expect_said("float x; Ci = texture3d(file, P, Nn, \"_x\", x);", "missing.ptc", "there is no such file");
    expect_said("float x; Ci = texture3d(file, P, Nn, \"_x\", x);", "bakes.sl", "it is no point cloud");
}

TEST(PointClouds, CallsThatDoNotRunSayNothing) {
    Clouds clouds;
    clouds.shader("bakes", "if (xcomp(P) > 9) bake3d(\"\", \"\", P, Nn, \"two words\", 1);");
    clouds.render({clouds.surface("bakes") + kSquare});
    clouds.expect_nothing_said();
}

/// What a scene must not overwrite stays, and what it did not finish does not appear.
TEST(PointClouds, OtherFilesStay) {
    Clouds clouds;
    clouds.shader("bakes", "bake3d(file, \"\", P, Nn);");
    std::ofstream(clouds.file("notes.txt")) << "notes";
    clouds.render({clouds.surface("bakes", "notes.txt") + kSquare});
    ASSERT_EQ(clouds.said.size(), 1u);
    EXPECT_NE(clouds.said[0].text.find("is not a picture"), std::string::npos);
    EXPECT_EQ(file_text(clouds.file("notes.txt")), "notes");
}

TEST(PointClouds, OlderOnesAreReplaced) {
    for (const std::string name : {"a.ptc", "a.ply"}) {
        Clouds clouds;
        clouds.shader("bakes", "bake3d(file, \"\", P, Nn);");
        clouds.render({clouds.surface("bakes", name) + kSquare});
        const std::string first = file_text(clouds.file(name));
        clouds.shader("bakes", "bake3d(file, \"\", P, Nn, \"_x\", 1);");
        clouds.render({clouds.surface("bakes", name) + kSquare});
        EXPECT_GT(file_text(clouds.file(name)).size(), first.size());
        clouds.expect_nothing_said();
    }
}

TEST(PointClouds, AreToldOfByInfo) {
    Clouds clouds;
    clouds.shader("bakes", "bake3d(file, \"\", P, Nn, \"radius\", .5, \"_one\", 1, \"_c\", color(.25));");
    clouds.render({clouds.surface("bakes") + kSquare});
    const size_t points = clouds.baked().particles.size();
    const Outcome told = run_program(clouds.folder(), "info a.ptc");
    EXPECT_EQ(told.exit_code, 0) << told.err;
    EXPECT_EQ(told.out, "a.ptc: " + std::to_string(points) + " points\n" +
                            "    bounds -0.9 -0.9 5 to 0.9 0.9 5\n    radii 0.5 to 0.5, area " +
                            told.out.substr(std::min(told.out.size(), told.out.find("area ") + 5)));
    EXPECT_TRUE(told.out.ends_with("\n    float _one, mean 1\n    color _c, mean 0.25\n")) << told.out;
    clouds.folder().write("bad.ply", "ply\nformat ascii 1.0\nend_header\n");
    const Outcome bad = run_program(clouds.folder(), "info a.ptc bad.ply");
    EXPECT_EQ(bad.exit_code, 1);
    EXPECT_TRUE(bad.err.find("point cloud \"bad.ply\": it has no vertices") != std::string::npos) << bad.err;
}

TEST(PointClouds, LightsDoNotBakeButLook) {
    Clouds clouds;
    clouds.shader("bakes", "bake3d(file, \"\", P, Nn, \"_l\", color(.5, .25, 1));");
    clouds.shader("lit", "Ci = ambient() + diffuse(Nn);");
    std::ofstream(clouds.file("cloudlight.sl"))
        << "light cloudlight(string file = \"\";) { color l = 0; bake3d(file, \"\", Ps, N);"
           "texture3d(file, Ps, N, \"_l\", l); Cl = l; }";
    const std::vector<Image> images =
        clouds.render({clouds.surface("bakes") + kSquare, "LightSource \"cloudlight\" 1 \"string file\" [\"" +
                                                              clouds.file("a.ptc") + "\"] " +
                                                              "Surface \"lit\" " + kSquare});
    ASSERT_EQ(images.size(), 2u);
    ASSERT_EQ(clouds.said.size(), 1u);
    EXPECT_NE(clouds.said[0].text.find("light shaders bake nothing"), std::string::npos);
    const Pixel middle = pixels(images[1])[32 * 64 + 32];
    EXPECT_EQ(middle.red, .5f);
    EXPECT_EQ(middle.green, .25f);
    EXPECT_EQ(middle.blue, 1);
}

}  // namespace
}  // namespace trapeze::testing
