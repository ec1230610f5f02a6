/// Area lights in pictures next to closed forms: what surfaces get of each shape, shadows, and what must not
/// change it [decision 0030]. A face of radiosity 1 all around it has diffuse() 1.
#include <OpenImageIO/imageio.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "tests/area_lights_harness.h"

namespace trapeze::testing {
namespace {

TEST(AreaLights, ARectangleGivesLambertsFormula) {
    expect_lit(lit_by(ris("PxrRectLight", "Translate 0 0 3")).render(asks(kUnitSquare)), 0.001, 0.02);
    // Exposure 1 doubles it; a normalized one has its area taken from it.
    expect_lit(
        lit_by(ris("PxrRectLight", "Translate 0 0 3", "\"float intensity\" [3] \"float exposure\" [1]"))
            .render(asks(kUnitSquare + "expected *= 6;")),
        0.001, 0.02);
    expect_lit(lit_by(ris("PxrRectLight", "Translate 0 0 3 Scale 2 .5 1", "\"int areaNormalize\" [1]"))
                   .render(asks("float expected = polygon(P, point(-1, -.25, 3), point(1, -.25, 3), "
                                "point(1, .25, 3), point(-1, .25, 3));")),
               0.002, 0.03);
}

TEST(AreaLights, ADiskGivesItsFormFactor) {
    expect_lit(lit_by(ris("PxrDiskLight", "Translate 0 0 3 Scale 2 2 1"))
                   .render(asks("float a2 = xcomp(P) * xcomp(P) + ycomp(P) * ycomp(P), sum = 4 + a2 + 1;"
                                "float expected = (1 - (4 + a2 - 1) / sqrt(sum * sum - 4 * a2)) / 2;")),
               0.002, 0.1);
}

TEST(AreaLights, ASphereGivesItsSquaredSine) {
    expect_lit(lit_by(ris("PxrSphereLight", "Translate 0 0 2"))
                   .render(asks("vector m = point(0, 0, 2) - P;"
                                "float expected = .25 / (m . m) * 3 / length(m);")),
               0.001, 0.01);
}

/// From afar, of a radius of .1 and 2 long: its radiance by what it hides of the sky, over pi.
TEST(AreaLights, ACylinderGivesItsOutline) {
    expect_lit(lit_by(ris("PxrCylinderLight", "Translate 0 0 -95 Rotate 30 0 0 1 Scale 2 .2 .2"))
                   .render("Ci = color(1e4 * comp(diffuse(normal(0, 0, -1)), 0), .4 / PI, 1);"),
               0.002, 0.02);
}

TEST(AreaLights, ADisksInTheSkyAndADomeLightAsTheirColoursSay) {
    expect_lit(lit_by(ris("PxrDistantLight", "Rotate 60 1 0 0",
                          "\"float intensity\" [2] \"float angleExtent\" [40] \"int areaNormalize\" [1] "))
                   .render(asks("float s = sin(radians(.265)); float expected = 2 * s * s * .5;")),
               0.002, 0.02);
    expect_lit(lit_by(ris("PxrDomeLight", "", "\"color lightColor\" [.25 1 1]"))
                   .render(asks("float expected = .25;")),
               0.002, 0.03);
}

/// A half of the sky is ten times as bright, and one of its pixels a thousand times. (In the rows at the
/// poles lookups blend all longitudes; these are small.)
TEST(AreaLights, ADomesMapGivesItsQuadrature) {
    const WorkFolder folder;
    const std::string file = (folder / "sky.exr").string();
    constexpr int kWidth = 64, kHeight = 32;
    std::vector<float> sky;
    double expected = 0;
    for (int y = 0; y < kHeight; ++y)
        for (int x = 0; x < kWidth; ++x) {
            const float value = x == 9 && y == 23 ? 2000.0f : x < 32 ? 5.0f : 0.5f;
            sky.insert(sky.end(), 3, value);
            // The cosine to -z over the pixel: (sin^2 from .. to) / 2 of the angle from there.
            const double from = std::sin(M_PI * y / kHeight), to = std::sin(M_PI * (y + 1) / kHeight);
            if (y >= kHeight / 2)
                expected +=
                    static_cast<double>(value) * (from * from - to * to) / 2 * (2 * M_PI / kWidth) / M_PI;
        }
    OIIO::ImageSpec spec(kWidth, kHeight, 3, OIIO::TypeDesc::FLOAT);
    const auto out = OIIO::ImageOutput::create(file);
    ASSERT_TRUE(out && out->open(file, spec) && out->write_image(OIIO::TypeDesc::FLOAT, sky.data()) &&
                out->close());
    const Image image = lit_by(ris("PxrDomeLight", "", "\"string lightColorMap\" [\"" + file + "\"]"))
                            .render(asks("float expected = " + std::to_string(expected) + ";"));
    expect_lit(image, 0.005, 0.25);
}

TEST(AreaLights, ShapesOfRslAreThoseOfTheirPrimitives) {
    const std::string square = kUnitSquare + "expected *= PI;";
    for (
        const std::string shape :
        {"Polygon \"P\" [-.5 -.5 0 .5 -.5 0 .5 .5 0 -.5 .5 0] ",
         "Polygon \"P\" [-.5 -.5 0 -.5 .5 0 .5 .5 0 .5 -.5 0] ",
         "Patch \"bilinear\" \"P\" [-.5 -.5 0 .5 -.5 0 -.5 .5 0 .5 .5 0] ",
         "SubdivisionMesh \"bilinear\" [4] [0 1 2 3] [] [] [] [] \"P\" [-.5 -.5 0 .5 -.5 0 .5 .5 0 -.5 .5 0] ",
         "Polygon \"P\" [-.5 -.5 0 0 -.5 0 0 .5 0 -.5 .5 0] Polygon \"P\" [0 -.5 0 .5 -.5 0 .5 .5 0 0 .5 0] "}) {
        SCOPED_TRACE(shape);
        expect_lit(lit_by(arealight(shape)).render(asks(square)), 0.002, 0.02);
    }
    expect_lit(lit_by(arealight("Disk 0 1 360 "))
                   .render(asks("float a2 = xcomp(P) * xcomp(P) + ycomp(P) * ycomp(P), sum = 4 + a2 + 1;"
                                "float expected = (1 - (4 + a2 - 1) / sqrt(sum * sum - 4 * a2)) / 2;")),
               0.003, 0.03);
    // Of one side a sphere shines outwards: pi over its area is 1.
    expect_lit(lit_by("Sides 1 " + arealight("Sphere .5 -.5 .5 360 ") + " Sides 2 ")
                   .render(asks("vector m = point(0, 0, 3) - P;"
                                "float expected = .25 / (m . m) * 2 / length(m);")),
               0.01, 0.08);
}

/// Particles are balls of their widths, on whatever side their disks are drawn. Of three the mean over their
/// areas.
TEST(AreaLights, ParticlesAreBalls) {
    expect_lit(lit_by(arealight("Points \"P\" [0 0 0] \"constantwidth\" [1] "))
                   .render(asks("vector m = point(0, 0, 3) - P;"
                                "float expected = .25 / (m . m) * 2 / length(m);")),
               0.003, 0.03);
    // By their form factors over their areas, together.
    Case three = lit_by(arealight("Scale .5 .5 .5 Points \"P\" [-1 0 0 0 .5 0 1 -1 1] \"width\" [1 2 .5] "));
    three.functions =
        "float ball(point at; float r) { extern point P; vector m = at - P;"
        "  return r * r / (m . m) * -zcomp(m) / length(m); } ";
    expect_lit(three.render(asks("float sum = ball(point(-.5, 0, 3), .25) + ball(point(0, .25, 3), .5) +"
                                 "  ball(point(.5, -.5, 3.5), .125);"
                                 "float expected = sum / (4 * (.0625 + .25 + .015625));")),
               0.005, 0.1);
}

/// From afar a curve is a tube, which hides its length by its width of the sky, by the sine of the angle
/// between its way and the light's; the ribbon that the camera sees is not asked. In the last two the camera
/// looks along it, and the receiver does not.
TEST(AreaLights, CurvesAreTubes) {
    const std::pair<std::string, std::string> cases[] = {
        {"Curves \"linear\" [2] \"nonperiodic\" \"P\" [-1 0 0 1 0 0] \"constantwidth\" [.04] ", "1, 0, 0"},
        {"Curves \"linear\" [2] \"nonperiodic\" \"P\" [0 -1 0 0 1 0] \"constantwidth\" [.04] ", "0, 1, 0"},
        {"Curves \"cubic\" [4] \"nonperiodic\" \"P\" [-1 0 -1 -.5 0 -.5 .5 0 .5 1 0 1] "
         "\"constantwidth\" [.04] ",
         "1, 0, 1"},
        {"Curves \"linear\" [2] \"nonperiodic\" \"P\" [-1 0 0 1 0 0] \"constantwidth\" [.3] ", "1, 0, 0"},
        {"Curves \"linear\" [2] \"nonperiodic\" \"P\" [0 -1 -1 0 1 1] \"constantwidth\" [.02] ", "0, 1, 1"},
    };
    for (const auto& [shape, way] : cases) {
        SCOPED_TRACE(shape);
        expect_lit(lit_by(arealight("Translate 0 0 -98 " + shape))
                       .render("vector to = point(0, 0, -95) - P, n = normalize(to);"
                               "float sine = length(normalize(vector(" +
                               way +
                               ")) ^ n);"
                               "Ci = 1e4 * color(comp(diffuse(normal(0, 0, -1)), 0),"
                               "  sine / PI * -zcomp(n) / (to . to), 1);"),
                   0.005, 0.02);
    }
    // Ribbons across normals are ribbons, and shine to both sides.
    expect_lit(
        lit_by(arealight("Translate 0 0 -98 Curves \"linear\" [2] \"nonperiodic\" \"P\" [-1 0 0 1 0 0] "
                         "\"N\" [0 .6 .8 0 .6 .8] \"constantwidth\" [.04] "))
            .render("vector to = point(0, 0, -95) - P, n = normalize(to);"
                    "Ci = 1e4 * color(comp(diffuse(normal(0, 0, -1)), 0),"
                    "  abs(vector(0, .6, .8) . n) * -zcomp(n) / (to . to), 1);"),
        0.005, 0.02);
}

/// Every other primitive that has a surface.
TEST(AreaLights, ShineFromEveryKindOfPrimitive) {
    const std::string disk =
        "float a2 = xcomp(P) * xcomp(P) + ycomp(P) * ycomp(P), sum = 4 + a2 + .16;"
        "float expected = (1 - (4 + a2 - .16) / sqrt(sum * sum - .64 * a2)) / 2 / .16;";
    const std::string nurbs =
        "NuPatch 2 2 [0 0 1 1] 0 1 2 2 [0 0 1 1] 0 1 \"P\" [-.5 -.5 0 .5 -.5 0 -.5 .5 0 .5 .5 0] ";
    const std::string square = kUnitSquare + "expected *= PI;";
    expect_lit(lit_by(arealight(nurbs)).render(asks(square)), 0.002, 0.02);
    // A circle of radius .4 is left of it.
    expect_lit(lit_by(arealight("TrimCurve [1] [3] [0 0 0 .25 .25 .5 .5 .75 .75 1 1 1] [0] [1] [9] "
                                "[.9 .6364 .5 .0707 .1 .0707 .5 .6364 .9] "
                                "[.5 .6364 .9 .6364 .5 .0707 .1 .0707 .5] "
                                "[1 .7071 1 .7071 1 .7071 1 .7071 1] " +
                                nurbs))
                   .render(asks(disk)),
               0.01, 0.06);
    expect_lit(lit_by(arealight("PatchMesh \"bilinear\" 2 \"nonperiodic\" 2 \"nonperiodic\" \"P\" "
                                "[-.5 -.5 0 .5 -.5 0 -.5 .5 0 .5 .5 0] "))
                   .render(asks(square)),
               0.002, 0.02);
    expect_lit(lit_by(arealight("PointsGeneralPolygons [1] [4] [0 1 2 3] \"P\" "
                                "[-.5 -.5 0 .5 -.5 0 .5 .5 0 -.5 .5 0] "))
                   .render(asks(square)),
               0.002, 0.02);
    // Of a ball half is seen, in the mean over its two sides.
    expect_lit(lit_by(arealight("Translate 0 0 -98 Blobby 1 [1001 0] [1 0 0 0 0 1 0 0 0 0 1 0 0 0 0 1] [] "))
                   .render("Ci = color(1e4 * comp(diffuse(normal(0, 0, -1)), 0), .5, 1);"),
               0.01, 0.05);
}

/// From afar a shape counts by the mean of its cosines, which is what it hides of the sky there over its
/// area. Thin ones have fine micropolygons, however long they are; and places where shapes stand do not
/// count.
TEST(AreaLights, CurvedShapesGiveWhatTheyHide) {
    constexpr double kTube = 2 / M_PI;
    const double bowl = (M_PI / 4) / (M_PI / 24 * (5 * std::sqrt(5.0) - 1));
    const std::pair<std::string, double> cases[] = {
        {"Rotate 90 0 1 0 Cylinder .02 -1 1 360 ", kTube},
        {"Rotate 90 0 1 0 Rotate 90 0 0 1 Cylinder .02 -1 1 360 ", kTube},
        {"Rotate 90 0 1 0 Cylinder .1 -1 1 360 ", kTube},
        {"Torus .4 .1 0 360 360 ", kTube},
        {"Torus 1 .03 0 360 360 ", kTube},
        {"Translate 0 0 -.25 Paraboloid .5 0 .5 360 ", bowl},
        {"Rotate 90 0 1 0 Translate 0 0 -50 Cylinder .1 49 51 360 ", kTube},
    };
    for (const auto& [shape, expected] : cases) {
        SCOPED_TRACE(shape);
        expect_lit(lit_by(arealight("Translate 0 0 -98 " + shape))
                       .render("Ci = color(1e4 * comp(diffuse(normal(0, 0, -1)), 0), " +
                               std::to_string(expected) + ", 1);"),
                   0.01, 0.05);
    }
    // A disk is round wherever it is.
    expect_lit(lit_by(arealight("Translate 0 0 -40 Disk 40 1 360 "))
                   .render(asks("float a2 = xcomp(P) * xcomp(P) + ycomp(P) * ycomp(P), sum = 4 + a2 + 1;"
                                "float expected = (1 - (4 + a2 - 1) / sqrt(sum * sum - 4 * a2)) / 2;")),
               0.003, 0.03);
}

/// Sides 1: the square shines where its outside is. Of two orders of its corners one is turned to us.
TEST(AreaLights, SidesSayWhereAShapeShines) {
    int lit = 0;
    for (const std::string corners :
         {"[-.5 -.5 0 .5 -.5 0 .5 .5 0 -.5 .5 0]", "[-.5 -.5 0 -.5 .5 0 .5 .5 0 .5 -.5 0]"})
        lit += mean_red(lit_by("Sides 1 " + arealight("Polygon \"P\" " + corners) + " Sides 2 ")
                            .render(asks("float expected = 0;"))) > 0;
    EXPECT_EQ(lit, 1);
}

/// A RIS light of a mesh is as bright as a rectangle's.
TEST(AreaLights, AMeshLightGivesLambertsFormula) {
    expect_lit(lit_by("AttributeBegin Attribute \"visibility\" \"int camera\" [0] Translate 0 0 3 "
                      "Light \"PxrMeshLight\" \"m\" \"int fixedSampleCount\" [256] "
                      "Patch \"bilinear\" \"P\" [-.5 -.5 0 .5 -.5 0 -.5 .5 0 .5 .5 0] AttributeEnd ")
                   .render(asks(kUnitSquare)),
               0.002, 0.02);
}

/// Of objects each instance shines from where it is; and so does an object behind an AreaLightSource.
TEST(AreaLights, InstancesShine) {
    const std::string square = "Patch \"bilinear\" \"P\" [-.5 -.5 0 .5 -.5 0 -.5 .5 0 .5 .5 0] ";
    const std::string object = "AttributeBegin Attribute \"visibility\" \"int camera\" [0] ObjectBegin 1 ";
    const std::string places =
        "AttributeBegin Translate -.6 .2 3 ObjectInstance 1 AttributeEnd "
        "AttributeBegin Translate 1 0 2 Scale 1 .5 1 Rotate 90 0 1 0 ObjectInstance 1 AttributeEnd ";
    const std::string two =
        "float expected = polygon(P, point(-1.1, -.3, 3), point(-.1, -.3, 3), point(-.1, .7, 3), "
        "point(-1.1, .7, 3)) + polygon(P, point(1, -.25, 1.5), point(1, -.25, 2.5), point(1, .25, 2.5), "
        "point(1, .25, 1.5));";
    expect_lit(lit_by(object + "Light \"PxrMeshLight\" \"m\" \"int fixedSampleCount\" [256] " + square +
                      "ObjectEnd " + places + "AttributeEnd ")
                   .render(asks(two)),
               0.003, 0.05);
    // Of both the mean by their areas, 1 and .5.
    expect_lit(lit_by(object + square +
                      "ObjectEnd Attribute \"light\" \"int nsamples\" [256] "
                      "AreaLightSource \"arealight\" \"a\" " +
                      places + "AttributeEnd Illuminate \"a\" 1 ")
                   .render(asks(two + "expected *= PI / 1.5;")),
               0.003, 0.05);
}

/// A sphere that is displaced to a larger one lights as that, where rays meet it displaced.
TEST(AreaLights, DisplacedShapesShineFromWhereTheyAre) {
    for (const auto& [displaces, expected] : {std::pair("0", "1 / 16"), {"1", "1"}}) {
        Case c = lit_by(std::string("AttributeBegin Attribute \"visibility\" \"int camera\" [0] Sides 1 "
                                    "Attribute \"displacementbound\" \"sphere\" [.75] Displacement \"grows\" "
                                    "Attribute \"trace\" \"int displacements\" [") +
                        displaces +
                        "] Light \"PxrMeshLight\" \"m\" \"int fixedSampleCount\" [256] "
                        "Translate 0 0 2 Sphere .25 -.25 .25 360 AttributeEnd ");
        c.shaders["grows"] = "displacement grows() { P += .75 * normalize(N); N = calculatenormal(P); }";
        expect_lit(c.render(asks("vector m = point(0, 0, 2) - P; float expected = " + std::string(expected) +
                                 " / (m . m) * 3 / length(m);")),
                   0.01, 0.1);
    }
}

/// Of the middle of a patch the mean is .5 of u and v; s and t are as TextureCoordinates has them.
TEST(AreaLights, TheirShadersKnowWhereOnThemThePointIs) {
    const auto mean_of = [](const std::string& value) {
        Case c = lit_by(
            "AttributeBegin Attribute \"visibility\" \"int camera\" [0] "
            "Attribute \"light\" \"int nsamples\" [64] AreaLightSource \"tells\" \"a\" "
            "TextureCoordinates 0 0 2 0 0 3 2 3 "
            "Patch \"bilinear\" \"P\" [-1 1 3 1 1 3 -1 -1 3 1 -1 3] AttributeEnd Illuminate \"a\" 1 ");
        c.shaders["tells"] = "light tells() { illuminate(P, N, PI / 2) Cl = " + value + "; }";
        return mean_red(
            c.render("float sum = 0, n = 0;"
                     "illuminance(P, normal(0, 0, -1), PI / 2) { sum += comp(Cl, 0); n += 1; }"
                     "Ci = 64 * sum / n;"));
    };
    EXPECT_NEAR(mean_of("u"), .5, .01);
    EXPECT_NEAR(mean_of("v * v"), 1 / 3.0, .01);
    EXPECT_NEAR(mean_of("s"), 1, .02);
    EXPECT_NEAR(mean_of("t"), 1.5, .03);
    EXPECT_NEAR(mean_of("length(dPdu)"), 2, 1e-3);
    EXPECT_NEAR(mean_of("ycomp(dPdv)"), -2, 1e-3);
    EXPECT_NEAR(mean_of("Ng . N"), 1, 1e-3);
    // The place is that of the point: u runs with x.
    EXPECT_NEAR(mean_of("abs(xcomp(transform(\"world\", P)) - (2 * u - 1))"), 0, 1e-3);
}

TEST(AreaLights, WhatIsBehindASurfaceOrTurnedAwayGivesNothing) {
    for (const std::string& lights :
         {ris("PxrRectLight", "Translate 0 0 7 Scale 1 1 -1"), ris("PxrSphereLight", "Translate 0 0 7"),
          ris("PxrRectLight", "Translate 0 0 3 Scale 1 1 -1"), ris("PxrDistantLight", "Scale 1 1 -1"),
          arealight("Translate 0 0 4 Disk 0 1 360 ")})
        EXPECT_EQ(mean_red(lit_by(lights).render(asks("float expected = 0;"))), 0) << lights;
}

/// A disk of radius 3, 100 away: all its points count alike within a thousandth. Half of the plane z = -10 is
/// in the way, whose edge moves over the disk.
TEST(AreaLightShadows, ThePenumbraOfADiskIsThatOfItsSegments) {
    Case c = lit_by(ris("PxrDiskLight", "Translate 0 0 -95 Scale 6 6 1"));
    const std::string edge = "Patch \"bilinear\" \"P\" [-3 3 -10 0 3 -10 -3 -3 -10 0 -3 -10] ";
    c.things = edge;
    // A point of the disk is hidden where its way to P crosses the plane left of the edge.
    const Image image = c.render(
        "float t = clamp(-xcomp(P) * 85 / 15 / 3, -1, 1);"
        "float shown = (acos(t) - t * sqrt(1 - t * t)) / PI;"
        "Ci = color(comp(diffuse(normal(0, 0, -1)), 0) * 10009 / 9, shown, 1);");
    double error = 0, dark = 0, bright = 0;
    for (const Pixel& p : pixels(image)) {
        EXPECT_NEAR(p.red, p.green, 0.05f);
        error += static_cast<double>(p.red - p.green) / 4096;
        dark += p.green == 0, bright += p.green == 1;
    }
    EXPECT_NEAR(error, 0, 0.003);
    EXPECT_GT(dark, 200);
    EXPECT_GT(bright, 200);
}

/// The same edge, which moves by 1 while the shutter is open: the mean of what it shows.
TEST(AreaLightShadows, ThePenumbraOfWhatMovesIsItsMeanOverTheShutter) {
    Case c = lit_by(ris("PxrDiskLight", "Translate 0 0 -95 Scale 6 6 1"));
    c.options = "Shutter 0 1 ";
    c.asker += "Attribute \"trace\" \"int samplemotion\" [1] ";
    c.things =
        "MotionBegin [0 1] Translate -.5 0 0 Translate .5 0 0 MotionEnd "
        "Patch \"bilinear\" \"P\" [-3 3 -10 0 3 -10 -3 -3 -10 0 -3 -10] ";
    expect_moving_penumbra(c);
}

/// The light goes the other way in place of the edge, so far that the edge's shadow goes as it did.
TEST(AreaLightShadows, ThePenumbraOfALightThatMovesIsItsMeanOverTheShutter) {
    Case c = lit_by(ris("PxrDiskLight",
                        "MotionBegin [0 1] Translate 3.33333 0 -95 Translate -3.33333 0 -95 MotionEnd "
                        "Scale 6 6 1"));
    c.options = "Shutter 0 1 ";
    c.asker += "Attribute \"trace\" \"int samplemotion\" [1] ";
    c.things = "Patch \"bilinear\" \"P\" [-3 3 -10 0 3 -10 -3 -3 -10 0 -3 -10] ";
    expect_moving_penumbra(c);
}

TEST(AreaLightShadows, AreCastOnlyWhereTheyAreWanted) {
    const auto mean_behind_a_wall = [](const std::string& parameters, const std::string& of_wall = "") {
        Case c = lit_by(ris("PxrRectLight", "Translate 0 0 3", parameters, 9));
        c.things = of_wall + wall("4");
        return mean_red(c.render(asks("float expected = 0;")));
    };
    const double open = mean_behind_a_wall("\"int enableShadows\" [0]");
    EXPECT_GT(open, 0.05);
    EXPECT_EQ(mean_behind_a_wall(""), 0);
    EXPECT_EQ(mean_behind_a_wall("\"int traceShadows\" [0]"), open);
    EXPECT_EQ(mean_behind_a_wall("", "Attribute \"visibility\" \"int transmission\" [0] "), open);
    EXPECT_NEAR(mean_behind_a_wall("", "Opacity .25 .25 .25 "), 0.75 * open, 1e-3 * open);
    EXPECT_NEAR(mean_behind_a_wall("\"color shadowColor\" [.5 .5 .5]"), 0.5 * open, 1e-3 * open);
}

/// Screens whose shaders look at lights before they say how much they let through: area lights do not shine
/// on what shadows ask, which would have no end.
TEST(AreaLightShadows, LookThroughShadersThatAreLitThemselves) {
    Case c = lit_by(ris("PxrRectLight", "Translate 0 0 2", "", 16));
    c.shaders["screen"] = "surface screen() { Ci = diffuse(normalize(N)); Oi = Os * .5; }";
    // Of the world's lights, all shine on the screens.
    for (const char* z : {"3", "3.3", "3.6", "4"}) c.things += "Surface \"screen\" " + wall(z);
    const Image open = lit_by(ris("PxrRectLight", "Translate 0 0 2", "\"int enableShadows\" [0]", 16))
                           .render(asks("float expected = 0;"));
    EXPECT_NEAR(mean_red(c.render(asks("float expected = 0;"))), mean_red(open) / 16, 1e-3 * mean_red(open));
}

/// Threads, regions and the order of grids leave every bit as it is; the seed does not.
TEST(AreaLights, PicturesAreTheSameForAnyThreadsAndRegions) {
    const auto render = [](int threads, int regions, uint32_t seed) {
        Case c = lit_by(arealight("Sphere .5 -.5 .5 360 ") + ris("PxrDomeLight", "") +
                        ris("PxrRectLight", "Translate 1 0 3"));
        c.things = sphere("0 0 4.5", ".3");
        c.options = "ShadingRate 9 ";
        c.threads = threads, c.settings.regions_at_least = regions, c.settings.seed = seed;
        return c.render(asks("float expected = 0;")).rgba;
    };
    const auto one = render(1, 1, 0);
    EXPECT_EQ(one, render(3, 1, 0));
    EXPECT_EQ(one, render(2, 5, 0));
    EXPECT_NE(one, render(1, 1, 1));
}

/// Loops over lights see each sample; specular() does, too.
TEST(AreaLights, LoopsSeeASampleATurn) {
    const Image image = lit_by(ris("PxrRectLight", "Translate 0 0 3"))
                            .render(
                                "float turns = 0; color sum = 0;"
                                "illuminance(P, normal(0, 0, -1), PI / 2) {"
                                "  turns += 1; sum += Cl * (normalize(L) . vector(0, 0, -1)); }"
                                "Ci = color(comp(sum, 0), comp(diffuse(normal(0, 0, -1)), 0), turns);");
    for (const Pixel& p : pixels(image)) {
        ASSERT_EQ(p.blue, 256);
        ASSERT_NEAR(p.red, p.green, 1e-6f);
    }
}

TEST(AreaLights, OddOnesAreReportedAndDark) {
    const auto said_of = [](const std::string& lights, const std::string& kind) {
        Case c = lit_by(lights);
        c.may_say = kind;
        for (const Pixel& p : pixels(c.render(asks("float expected = 0;")))) EXPECT_EQ(p.red, 0);
        return std::ranges::any_of(c.said, [&](const Diagnostic& d) { return d.kind == kind; });
    };
    EXPECT_TRUE(said_of(arealight(""), "dark-area-light a"));
    EXPECT_TRUE(said_of(arealight("Curves \"linear\" [2] \"nonperiodic\" \"P\" [0 0 0 1 0 0] "
                                  "\"constantwidth\" [0] "),
                        "dark-area-light a"));
}

}  // namespace
}  // namespace trapeze::testing
