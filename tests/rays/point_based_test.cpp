/// occlusion() and indirectdiffuse() by point clouds, in scenes.
#include <gtest/gtest.h>

#include "shade/clouds/clouds_harness.h"
#include "shade/clouds/surfels_harness.h"
#include "tests/rays/clouds_harness.h"

namespace trapeze::testing {
namespace {

/// Towards the camera from the square that asks, which is at z = 5.
const std::string kAsks = "normal up = normal(0, 0, -1); ";
/// A place is asked for 16 pixels.
const std::string kCoarse = "ShadingRate 16 ";
const std::string kBall = kHidden + kSeen + "Translate 0 0 3 Sphere .5 -.5 .5 360 ";

PointCloud cloud_of(const Surfels& surfels, bool radiosity = false) {
    PointCloud cloud;
    cloud.positions = surfels.positions, cloud.normals = surfels.normals;
    for (const float area : surfels.areas)
        cloud.radii.push_back(std::sqrt(area / static_cast<float>(kHalfTurn64)));
    if (!radiosity) return cloud;
    cloud.channels = {{"_radiosity", ChannelType::Color}};
    for (const V3f& color : surfels.radiosities)
        cloud.values.insert(cloud.values.end(), {color.x, color.y, color.z});
    return cloud;
}

/// A ball of radius 1 / 2, 2 above the square.
PointCloud ball(int discs = 4000) {
    return cloud_of(sphere(discs, {0, 0, 3}, .5));
}

/// A scene with a cloud, whose shader leaves what it finds.
struct PointBased : Clouds {
    explicit PointBased(const PointCloud& cloud) { folder().write("a.ptc", ptc_of(cloud)); }

    /// Red of all pixels; `found`: what is in Ci, where `file` is the cloud's.
    std::vector<Pixel> asks(const std::string& found, const std::string& things = "",
                            const std::string& before = "") {
        shader("asks", kAsks + before + "Ci = " + found + ";");
        return pixels(
            render({"AttributeBegin " + things + "\nAttributeEnd " + surface("asks") + kCoarse + kAsker})[0]);
    }
};

const std::string kCall = "occlusion(P, up, 0, \"pointbased\", 1, \"filename\", file";

/// (R / d)^2 cos(theta) of a ball, at all places of a plane.
TEST(PointBased, BallsHideTheirFormFactor) {
    PointBased scene(ball());
    const auto seen = scene.asks("color(" + kCall + "), expected, 1)", "",
                                 "vector way = P - point(0, 0, 3); float d = length(way);"
                                 "float expected = .25 * 2 / (d * d * d);");
    scene.expect_nothing_said();
    for (const Pixel& pixel : seen) EXPECT_NEAR(pixel.red, pixel.green, .12f * pixel.green);
    // The smaller clusters are, the nearer.
    for (const Pixel& pixel : scene.asks("color(" + kCall + ", \"maxsolidangle\", .01), expected, 1)", "",
                                         "vector way = P - point(0, 0, 3); float d = length(way);"
                                         "float expected = .25 * 2 / (d * d * d);"))
        EXPECT_NEAR(pixel.red, pixel.green, .05f * pixel.green);
}

/// A disc of radius 2 at a height of 1 sends 4 / 5 of its colour to below its middle.
TEST(PointBased, DiscsSendTheirFormFactor) {
    Surfels surfels;
    add_sheet(surfels, 60, {-2, -2, 4}, {4, 0, 0}, {0, 4, 0});
    for (size_t i = 0; i < surfels.size(); ++i) {
        const V3f& p = surfels.positions[i];
        if (p.x * p.x + p.y * p.y > 4) surfels.areas[i] = 0;
        surfels.radiosities.emplace_back(.2f, .5f, .8f);
    }
    PointBased scene(cloud_of(surfels, true));
    const auto seen = scene.asks(
        "indirectdiffuse(P, up, 0, \"pointbased\", 1, \"filename\", file, \"maxsolidangle\", .03)");
    scene.expect_nothing_said();
    const Pixel& middle = seen[32 * 64 + 32];
    EXPECT_NEAR(middle.red, .2f * .8f, .05f * .16f);
    EXPECT_NEAR(middle.green, .5f * .8f, .05f * .4f);
    EXPECT_NEAR(middle.blue, .8f * .8f, .05f * .64f);
}

/// What is baked by a frame hides in the next one, as rays see it there.
TEST(PointBased, BakedCloudsHideAsRaysSee) {
    Clouds clouds;
    clouds.shader("bakes", "bake3d(file, \"\", P, Nn, \"interpolate\", 1); Ci = 1;");
    clouds.shader("asks", kAsks + "float points = " + kCall +
                              ", \"maxsolidangle\", .03, \"hitsides\", \"front\");"
                              "float rays = occlusion(P, up, 1024); Ci = color(points, rays, 1);");
    const std::string things = "Translate 0 0 3.5 Rotate 30 1 0 0 Scale .7 .7 .7 Sphere 1 -1 1 360 ";
    const std::vector<Image> images = clouds.render(
        {clouds.surface("bakes") + things, "AttributeBegin " + kHidden + kSeen + things + "AttributeEnd " +
                                               clouds.surface("asks") + kCoarse + kAsker});
    clouds.expect_nothing_said();
    // The camera sees no back, but shades it, so that it bakes.
    float most = 0;
    for (const Pixel& pixel : pixels(images[1])) {
        EXPECT_NEAR(pixel.red, pixel.green, .02f + .05f * pixel.green);
        most = std::max(most, pixel.green);
    }
    EXPECT_GT(most, .2f);
}

/// Of a sheet that faces the place one side hides, of one that is turned away the other.
TEST(PointBased, SidesAreChosen) {
    for (const bool turned : {false, true}) {
        Surfels surfels;
        const V3f x(0, 2, 0), y(2, 0, 0);
        add_sheet(surfels, 40, {-1, -1, 4}, turned ? y : x, turned ? x : y);
        PointBased scene(cloud_of(surfels));
        const auto seen = scene.asks("color(" + kCall + ", \"hitsides\", \"front\"), " + kCall +
                                     ", \"hitsides\", \"back\"), " + kCall + ", \"hitsides\", \"both\"))");
        const Pixel& middle = seen[32 * 64 + 32];
        EXPECT_GT(middle.blue, .4f);
        EXPECT_EQ(turned ? middle.red : middle.green, middle.blue);
        EXPECT_EQ(turned ? middle.green : middle.red, 0);
    }
}

/// As rays have them: nothing counts beyond "maxdist", and less with its distance by "falloff".
TEST(PointBased, DistancesCount) {
    PointBased scene(ball());
    const Pixel near = scene.asks("color(" + kCall + ", \"maxdist\", 1.4), " + kCall + ", \"maxdist\", 9), " +
                                  kCall + "))")[32 * 64 + 32];
    EXPECT_EQ(near.red, 0);
    EXPECT_EQ(near.green, near.blue);
    for (const char* const mode : {"0", "1"}) {
        const std::string falloff =
            std::string("\"falloff\", .7, \"falloffmode\", ") + mode + ", \"maxdist\", 6";
        const Pixel far = scene.asks(
            "color(" + kCall + "), " + kCall + ", " + falloff + "), occlusion(P, up, 4096, " + falloff + "))",
            kBall)[32 * 64 + 32];
        EXPECT_LT(far.green, .8f * far.red);
        EXPECT_NEAR(far.green, far.blue, .1f * far.blue);
        // Colours likewise.
        const std::string of_scene = "indirectdiffuse(P, up, 4096, \"pointbased\", ";
        const Pixel seen = scene.asks("color(comp(" + of_scene + "1), 1), comp(" + of_scene + "1, " +
                                          falloff + "), 1), comp(" + of_scene + "0, " + falloff + "), 1))",
                                      "Surface \"constant\" " + kBall)[32 * 64 + 32];
        EXPECT_LT(seen.green, .8f * seen.red);
        EXPECT_NEAR(seen.green, seen.blue, .1f * seen.blue);
    }
}

/// The cloud is in a space of its own, and lengths are in the current one.
TEST(PointBased, CoordinateSystemsMoveClouds) {
    PointBased scene(cloud_of(sphere(4000, {0, 0, 1}, .25)));
    const std::string space = ", \"coordsystem\", \"cloud\"";
    const auto seen = scene.asks("color(" + kCall + space + "), " + kCall + space + ", \"maxdist\", 1.4), " +
                                     kCall + space + ", \"maxdist\", 2.6))",
                                 "TransformBegin Translate 0 0 1 Rotate 20 0 0 1 Scale 2 2 2 "
                                 "CoordinateSystem \"cloud\" TransformEnd");
    scene.expect_nothing_said();
    const Pixel& middle = seen[32 * 64 + 32];
    EXPECT_NEAR(middle.red, .25f / 4, .08f / 16);
    EXPECT_EQ(middle.green, 0);
    EXPECT_NEAR(middle.blue, middle.red, 1e-3f);
}

/// A cone of half angle 1 / 4 about the normal is all that counts, and so holds the ball alone.
TEST(PointBased, ConesAndOutputs) {
    PointBased scene(ball());
    const auto seen = scene.asks("color(cone, found, ycomp(way))", "",
                                 "float found = 0; vector way = 0;"
                                 "float cone = " +
                                     kCall +
                                     ", \"coneangle\", .15);"
                                     "color light = indirectdiffuse(P, up, 0, \"pointbased\", 1,"
                                     "  \"filename\", file, \"occlusion\", found, \"environmentdir\", way);");
    EXPECT_GT(seen[32 * 64 + 32].red, .9f);
    EXPECT_EQ(seen[0].red, 0);
}

/// Each of these says why, at its place, and sends rays instead: every pixel is as with rays alone.
TEST(PointBased, WithoutACloudRaysAreSent) {
    struct Wrong {
        std::string call, says;
    };
    Surfels surfels = sphere(100, {0, 0, 3}, .5);
    PointCloud flat = cloud_of(surfels);
    std::ranges::fill(flat.radii, 0.0f);
    const std::string of_rays = "occlusion(P, up, 16";
    for (
        const Wrong& wrong :
        {Wrong{
             of_rays + ", \"pointbased\", 1, \"filename\", \"none.ptc\")",
             "occlusion: point cloud \"none.ptc\" cannot be read: there is no such file; rays are sent instead"},
         Wrong{of_rays + ", \"pointbased\", 1, \"filename\", file)", "has no areas; rays are sent instead"},
         Wrong{of_rays + ", \"pointbased\", 1, \"filename\", file, \"coordsystem\", \"nowhere\")",
               "has no areas"}}) {
        PointBased scene(flat);
        const auto rays = scene.asks(of_rays + ")", kBall);
        scene.expect_nothing_said();
        const auto seen = scene.asks(wrong.call, kBall);
        ASSERT_EQ(scene.said.size(), 1u);
        EXPECT_EQ(scene.said[0].severity, Severity::Warning);
        EXPECT_NE(scene.said[0].text.find(wrong.says), std::string::npos) << to_string(scene.said[0]);
        EXPECT_NE(to_string(scene.said[0]).find("asks.sl:1:"), std::string::npos);
        for (size_t i = 0; i < rays.size(); ++i) EXPECT_EQ(rays[i].red, seen[i].red);
        EXPECT_GT(seen[32 * 64 + 32].red, 0);
    }
    PointBased scene(ball());
    scene.asks("indirectdiffuse(P, up, 4, \"pointbased\", 1, \"filename\", file)", kBall);
    ASSERT_EQ(scene.said.size(), 1u);
    EXPECT_NE(scene.said[0].text.find("has no channel color \"_radiosity\""), std::string::npos);
}

const std::string kOfScene = "occlusion(P, up, 0, \"pointbased\", 1";

/// Without a file, discs are made of what diffuse rays see, in the right number for its opacity.
TEST(PointBased, ScenesAreMadeDiscsOf) {
    PointBased scene(ball());
    const std::string both = "color(" + kOfScene + ", \"maxsolidangle\", .03), expected, 1)";
    const std::string expects =
        "vector way = P - point(0, 0, 3); float d = length(way);"
        "float expected = .25 * 2 / (d * d * d);";
    for (const Pixel& pixel : scene.asks(both, kBall, expects))
        EXPECT_NEAR(pixel.red, pixel.green, .06f * pixel.green);
    // A disc of half of the sky's opacity.
    const Pixel half =
        scene.asks("color(" + kOfScene + "), 0, 0)",
                   "Opacity .5 .5 .5 " + kHidden + kSeen + "Translate 0 0 4 Disk 0 2 360")[32 * 64 + 32];
    EXPECT_NEAR(half.red, .4f, .03f);
    const Pixel unseen = scene.asks("color(" + kOfScene + "), 0, 0)",
                                    kHidden +
                                        "Attribute \"visibility\" \"int specular\" 1 "
                                        "Translate 0 0 3 Sphere .5 -.5 .5 360")[32 * 64 + 32];
    EXPECT_EQ(unseen.red, 0);
    scene.expect_nothing_said();
}

/// Layers let through what the product of their transparencies is, be they sheets or both sides of a ball.
TEST(PointBased, LightPassesLayers) {
    PointBased scene(ball());
    const auto sheets = [](int count, float opacity) {
        const std::string o = std::to_string(opacity) + " ";
        std::string text = kHidden + kSeen + "Opacity " + o + o + o;
        for (int i = 0; i < count; ++i) text += "Disk " + std::to_string(4 - .2 * i) + " 20 360 ";
        return text;
    };
    for (const auto& [count, opacity] : {std::pair{1, .5f}, {2, .5f}, {8, .2f}, {3, .9f}, {2, 1.0f}}) {
        const Pixel middle =
            scene.asks("color(" + kOfScene + "), 0, 0)", sheets(count, opacity))[32 * 64 + 32];
        EXPECT_NEAR(middle.red, 1 - std::pow(1 - opacity, count), .015f) << count << " of " << opacity;
    }
    // What is opaque hides all, behind others and before them.
    for (const char* const depth : {"3.5", "4.3"}) {
        const auto hidden_with = [&](const std::string& things) {
            const std::string disk = things + "Opacity 1 1 1 Disk " + depth + " 20 360";
            return scene.asks("color(" + kOfScene + "), 0, 0)", disk)[32 * 64 + 32].red;
        };
        const float alone = hidden_with(kHidden + kSeen);
        EXPECT_GT(alone, .95f) << depth;
        EXPECT_GT(hidden_with(sheets(2, .5f)), alone) << depth;
    }
    const std::string expects =
        "vector way = P - point(0, 0, 3); float d = length(way);"
        "float expected = .75 * .25 * 2 / (d * d * d);";
    for (const Pixel& pixel : scene.asks("color(" + kOfScene + ", \"maxsolidangle\", .03), expected, 1)",
                                         "Opacity .5 .5 .5 " + kBall, expects))
        EXPECT_NEAR(pixel.red, pixel.green, .06f * pixel.green);
    scene.expect_nothing_said();
}

/// Outsides are fronts, whichever way a surface is parametrised.
TEST(PointBased, OutsidesAreFronts) {
    for (const char* const turned : {"", "ReverseOrientation ", "Scale -1 1 1 "}) {
        PointBased scene(ball());
        const Pixel middle =
            scene.asks("color(" + kOfScene +
                           ", \"hitsides\", \"front\"), occlusion(P, up, 64, "
                           "\"hitsides\", \"front\"), " +
                           kOfScene + "))",
                       kHidden + kSeen + turned + "Translate 0 0 4 Disk 0 2 360")[32 * 64 + 32];
        EXPECT_GT(middle.blue, .7f);
        EXPECT_NEAR(middle.red, middle.green, .05f);
    }
}

/// A floor that ends at x = 0, and what stands or hangs there: a wall upwards, or the sides of a block.
const std::string kFloor = "Patch \"bilinear\" \"P\" [0 1 5 1 1 5 0 -1 5 1 -1 5] ";
const std::string kWall = "Patch \"bilinear\" \"P\" [0 8 2 0 8 5 0 -8 2 0 -8 5] ";
const std::string kSides =
    "Patch \"bilinear\" \"P\" [0 1 5 0 -1 5 0 1 7 0 -1 7] "
    "Patch \"bilinear\" \"P\" [1 -1 5 1 1 5 1 -1 7 1 1 7] ";

/// What is hidden of the sky over the floor, as the scene's discs say in red and a cloud's in green;
/// `expected` in blue. The cloud is baked of the same things in a frame before.
std::vector<Pixel> on_floor(Clouds& clouds, const std::string& things, const std::string& expected) {
    clouds.shader("bakes", "bake3d(file, \"\", P, normalize(N), \"interpolate\", 1); Ci = 1;");
    clouds.shader("asks", kAsks + expected + "Ci = color(" + kOfScene + "), " + kCall + "), expected);");
    const std::string all = kCoarse + "Attribute \"dice\" \"int rasterorient\" 0 " + kSeen;
    const std::vector<Image> images = clouds.render(
        {all + clouds.surface("bakes") + "Sides 2 " + kFloor + things,
         all + clouds.surface("asks") + kFloor + "AttributeBegin " + kHidden + things + "AttributeEnd"});
    clouds.expect_nothing_said();
    return pixels(images[1]);
}

/// Of a wall of height h, as far to both sides as b, a point at a distance d from it sees
/// (atan(b / d) - d / sqrt(d^2 + h^2) atan(b / sqrt(d^2 + h^2))) / pi: at the wall itself a half.
TEST(PointBased, CreasesAreHalfHidden) {
    for (const bool turned : {false, true}) {
        Clouds clouds;
        const auto seen = on_floor(clouds, (turned ? "ReverseOrientation " : "") + kWall,
                                   "float d = max(xcomp(P), .03), s = sqrt(d * d + 9);"
                                   "float b = 8 - abs(ycomp(P)), c = 8 + abs(ycomp(P));"
                                   "float expected = (atan(b / d) + atan(c / d) - d / s * (atan(b / s) +"
                                   "  atan(c / s))) / (2 * PI);");
        for (size_t i = 0; i < 64; ++i) {
            const Pixel& pixel = seen[32 * 64 + i];
            if (pixel.blue == 0) continue;
            EXPECT_NEAR(pixel.red, pixel.blue, .02f) << i;
            EXPECT_NEAR(pixel.green, pixel.blue, .05f) << i;
        }
        EXPECT_GT(seen[32 * 64 + 33].blue, .48f);
    }
}

/// Of walls that lean, as rays see it that leave from beside the crease.
TEST(PointBased, CreasesAreAsRaysSeeThem) {
    for (const char* const top : {"-1.7", "1.7"}) {
        Clouds clouds;
        const std::string x(top);
        const auto seen =
            on_floor(clouds, "Patch \"bilinear\" \"P\" [" + x + " 8 2 0 8 5 " + x + " -8 2 0 -8 5] ",
                     "float expected = occlusion(P + vector(.03, 0, 0), up, 1024, \"bias\", 1e-4);");
        EXPECT_GT(seen[32 * 64 + 33].blue, .2f);
        for (size_t i = 33; i < 64; ++i)
            EXPECT_NEAR(seen[32 * 64 + i].red, seen[32 * 64 + i].blue, .03f) << i;
    }
}

/// The top of a block is flat up to its edges, which nothing hides.
TEST(PointBased, EdgesOfBlocksDoNotHideThemselves) {
    Clouds clouds;
    for (const Pixel& pixel : on_floor(clouds, kSides, "float expected = 0;")) {
        EXPECT_LT(pixel.red, 1e-3f);
        EXPECT_LT(pixel.green, .02f);
    }
}

const std::string kLight = "indirectdiffuse(P, up, 0, \"pointbased\", 1";

/// Within a closed box whose walls all send one colour that colour comes from everywhere, but for what
/// clusters leave open between them.
TEST(PointBased, BoxesThatShineAreFullOfTheirLight) {
    PointBased scene(ball());
    scene.shader("shines", "Ci = color(.2, .5, .8);");
    const std::string box = "Surface \"shines\" " + kHidden + kSeen +
                            "Translate 0 0 3.1 Scale 2 2 2 "
                            "Patch \"bilinear\" \"P\" [-1 -1 1 1 -1 1 -1 1 1 1 1 1] "
                            "Patch \"bilinear\" \"P\" [-1 -1 -1 1 -1 -1 -1 1 -1 1 1 -1]"
                            "Patch \"bilinear\" \"P\" [-1 -1 -1 1 -1 -1 -1 -1 1 1 -1 1] "
                            "Patch \"bilinear\" \"P\" [-1 1 -1 1 1 -1 -1 1 1 1 1 1]"
                            "Patch \"bilinear\" \"P\" [-1 -1 -1 -1 1 -1 -1 -1 1 -1 1 1] "
                            "Patch \"bilinear\" \"P\" [1 -1 -1 1 1 -1 1 -1 1 1 1 1] ";
    for (const auto& [angle, covered] : {std::pair(".1", .88f), std::pair(".01", .92f)}) {
        const std::string most = std::string(", \"maxsolidangle\", ") + angle + ")";
        for (const Pixel& pixel :
             scene.asks("color(comp(light, 0) / hidden, comp(light, 2) / hidden, hidden)", box,
                        "float hidden = " + kOfScene + most + "; color light = " + kLight + most + ";")) {
            EXPECT_NEAR(pixel.red, .2f, 1e-3f);
            EXPECT_NEAR(pixel.green, .8f, 1e-3f);
            EXPECT_GT(pixel.blue, covered);
        }
    }
    scene.expect_nothing_said();
}

/// Each side of a sheet sends what its own shading makes of it: the shader knows it by I.
TEST(PointBased, SidesOfTheSceneHaveColoursOfTheirOwn) {
    for (const bool turned : {false, true}) {
        PointBased scene(ball());
        scene.shader("sides", "Ci = normalize(I).N < 0 ? color(1, 0, .25) : color(0, 1, .25);");
        const Pixel middle = scene.asks(kLight + ")", "Surface \"sides\" " + kHidden + kSeen +
                                                          (turned ? "ReverseOrientation " : "") +
                                                          "Translate 0 0 4 Disk 0 2 360")[32 * 64 + 32];
        EXPECT_NEAR(turned ? middle.green : middle.red, .8f, .03f);
        EXPECT_EQ(turned ? middle.red : middle.green, 0);
        EXPECT_NEAR(middle.blue, .2f, .01f);
    }
}

/// The square of a picture's differences between two of its colours, in the mean, of the second one's own.
float relative_error(const std::vector<Pixel>& seen) {
    float sum = 0, all = 0;
    for (const Pixel& pixel : seen)
        sum += (pixel.red - pixel.green) * (pixel.red - pixel.green), all += pixel.green * pixel.green;
    return std::sqrt(sum / all);
}

/// What a wall that a light shines on sends to a floor, and a ball that hides some of it, as by rays; also in
/// each colour.
TEST(PointBased, ColoursOfTheSceneBleedAsRaysSay) {
    for (int channel = 0; channel < 3; ++channel) {
        PointBased scene(ball());
        const std::string comp = ", up, 1024), " + std::to_string(channel) + ")";
        const auto seen =
            scene.asks("color(comp(" + kLight + "), " + std::to_string(channel) +
                           "), comp(indirectdiffuse(P" + comp + ", 0)",
                       "LightSource \"pointlight\" 1 \"from\" [1 .5 2] \"intensity\" [6] Surface \"matte\" " +
                           kHidden + kSeen +
                           "AttributeBegin Color .9 .3 .1 "
                           "Patch \"bilinear\" \"P\" [-1.2 -2 1 -1.2 2 1 -1.2 -2 5.2 -1.2 2 5.2] "
                           "AttributeEnd Color .2 .3 .9 Translate .3 0 4.3 Sphere .4 -.4 .4 360");
        scene.expect_nothing_said();
        EXPECT_LT(relative_error(seen), .06f);
        EXPECT_GT(seen[32 * 64 + 4].green, .01f);
    }
}

/// Light bounces once: shaders of discs that ask for the light of others are told of none, as by rays.
/// Shadows and occlusion are theirs as everywhere.
TEST(PointBased, LightBouncesOnce) {
    for (const char* const pointbased : {"0", "1"}) {
        PointBased scene(ball());
        scene.shader("bounces", std::string("Ci = 1 + indirectdiffuse(P, Nn, 4, \"pointbased\", ") +
                                    pointbased +
                                    ") - .5 * occlusion(P, faceforward(Nn, I), 4, \"pointbased\", " +
                                    pointbased + ", \"maxdist\", .1);");
        const Pixel middle = scene.asks(kLight + ")", "Surface \"bounces\" " + kHidden + kSeen +
                                                          "Translate 0 0 4 Disk 0 2 360")[32 * 64 + 32];
        EXPECT_NEAR(middle.red, .8f, .03f);
        scene.expect_nothing_said();
    }
}

/// With 0 the name says nothing.
TEST(PointBased, ZeroSendsRays) {
    PointBased scene(ball());
    const auto seen =
        scene.asks("color(occlusion(P, up, 16, \"pointbased\", 0, \"filename\", file), 0, 0)", kBall);
    EXPECT_GT(seen[32 * 64 + 32].red, 0);
    scene.expect_nothing_said();
}

/// Of files and of the scene; with an order of discs and without; also at hits of rays.
TEST(PointBased, AreTheSameBitsForAnyThreadsAndRegions) {
    std::vector<std::vector<float>> pictures;
    for (const int threads : {1, 2, 5})
        for (const int regions : {1, 7}) {
            PointBased scene(ball());
            scene.threads = threads, scene.settings.regions_at_least = regions;
            scene.shader("asks", kAsks + "float falls = " + kCall + ", \"falloff\", 1); Ci = color(" + kCall +
                                     "), falls, comp(trace(P, normalize(vector(xcomp(P), .3, -1))), 1) + " +
                                     kOfScene + ")) + " + kLight + ");");
            pictures.push_back(scene
                                   .render({scene.surface("asks") + kCoarse +
                                            "Attribute \"visibility\" \"int specular\" 1 \"int diffuse\" 1 "
                                            "Translate 0 0 1.1 Sphere .3 -.3 .3 360 Translate 0 0 -1.1 " +
                                            kAsker})[0]
                                   .rgba);
            scene.expect_nothing_said();
            EXPECT_EQ(pictures.back(), pictures.front());
        }
    EXPECT_GT(*std::ranges::max_element(pictures[0]), .01f);
}

}  // namespace
}  // namespace trapeze::testing
