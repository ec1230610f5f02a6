/// Interior and Exterior shaders along rays, next to the law of Beer and Lambert.
#include <gtest/gtest.h>

#include "tests/rays/haze_harness.h"

namespace trapeze::testing {
namespace {

/// Of light along the way through a sphere of the radius 1 about (0, 0, 3), for the asker's rays along -z.
const std::string kThrough =
    "float x = xcomp(P), y = ycomp(P); float r2 = x * x + y * y;"
    "float t = r2 < 1 ? exp(-.5 * 2 * sqrt(1 - r2)) : 1; float sure = abs(r2 - 1) < .08 ? 0 : 1;";
const std::string kWhiteWall = "Surface \"constant\" Color 1 1 1 " + wall("0");

TEST(RayVolumes, TheExteriorOfWhatAsksIsBeforeTheHit) {
    Case c = hazy();
    c.things = kWhiteWall;
    c.asker = "Exterior \"haze\" \"k\" [.5] \"own\" [.25 .25 .25] ";
    const std::string expected = "float t = exp(-.5 * 5); float e = .25 + .75 * t; ";
    expect_near(c.render(expected + "Ci = color(comp(trace(P, vector(0, 0, -1)), 0), e, 1);"), 1e-5f);
    expect_near(c.render(expected +
                         "color got = 0; gather(\"illuminance\", P, vector(0, 0, -1), 0, 1, \"surface:Ci\", "
                         "got) { } Ci = color(comp(got, 0), e, 1);"),
                1e-5f);
    for (const char* volume : {"volume", "atmosphere"})
        expect_near(
            c.render(expected +
                     "color got = 0, open = 0; gather(\"illuminance\", P, vector(0, 0, -1), 0, 1, \"" +
                     volume + ":Ci\", got, \"" + volume +
                     ":Oi\", open) { } Ci = color(comp(got, 0), e, comp(open, 1));"),
            1e-5f);
    expect_near(
        c.render("float t = exp(-.5 * sqrt(50)); Ci = color(comp(indirectdiffuse(P, vector(1, 0, -1), 1, "
                 "\"coneangle\", 1e-4), 0), .25 + .75 * t, 1);"),
        1e-3f);
    // On the other side it is the inside that counts: the asker's normal points to the camera.
    c.asker = "Interior \"haze\" \"k\" [.5] ";
    expect_near(c.render("Ci = color(comp(trace(P, vector(0, 0, -1)), 0), 1, 1);"), 0);
    // A distance knows nothing of what lies between.
    c.asker = "Exterior \"haze\" ";
    expect_near(c.render("Ci = color(float trace(P, vector(0, 0, -1)), 5, 1);"), 1e-5f);
}

TEST(RayVolumes, TheInteriorOfASphereIsAlongTheChord) {
    // Its surface sends the ray on, or is so thin that it is looked through.
    for (const char* surface : {"Surface \"on\" ", "Surface \"constant\" Opacity 0 0 0 "})
        for (const char* side : {"Orientation \"outside\" ", "Orientation \"inside\" "}) {
            SCOPED_TRACE(std::string(surface) + side);
            Case c = hazy();
            c.asker = "Attribute \"trace\" \"int maxspeculardepth\" 9 ";
            const bool outside = std::string(side).find("outside") != std::string::npos;
            c.things = kWhiteWall + "Attribute \"trace\" \"int maxspeculardepth\" 9 " +
                       (outside ? "Interior" : "Exterior") + " \"haze\" \"k\" [.5] " + surface + side +
                       sphere("0 0 3", "1");
            expect_near(c.render(kThrough + "Ci = color(comp(trace(P, vector(0, 0, -1)), 0), t, sure);"),
                        kThinChord);
        }
}

/// What begins within a thing, which stands around all or close by, is in its inside.
TEST(RayVolumes, RaysThatBeginInsideAreInside) {
    Case c = hazy();
    c.things = "Interior \"haze\" \"k\" [.2] \"own\" [.5 .5 .5] Surface \"constant\" Color 1 1 1 " +
               sphere("0 0 5", "4");
    expect_near(c.render("float x = xcomp(P), y = ycomp(P); float t = exp(-.2 * sqrt(16 - x * x - y * y));"
                         "Ci = color(comp(trace(P, vector(0, 0, -1)), 0), .5 + .5 * t, 1);"),
                kThinChord);
}

/// Media behind each other, each over its own way: the walls' outsides, too, are towards smaller z.
TEST(RayVolumes, EachMediumIsAlongItsOwnWay) {
    Case c = hazy();
    c.asker = "Exterior \"haze\" \"k\" [.3] ";
    c.things =
        kWhiteWall +
        "Opacity 0 0 0 Surface \"constant\" Interior \"haze\" \"k\" [99] Exterior \"haze\" \"k\" [.7] " +
        wall("2") + "Exterior \"haze\" \"k\" [.2] " + wall("1.5");
    expect_near(c.render("float t = exp(-.3 * 3 - .7 * .5 - .2 * 1.5);"
                         "Ci = color(comp(trace(P, vector(0, 0, -1)), 0), t, 1);"),
                1e-5f);
}

TEST(RayVolumes, ShadowsFallThroughMedia) {
    Case c = hazy();
    c.things = "Interior \"haze\" \"k\" [.5] Surface \"constant\" Opacity 0 0 0 " + sphere("0 0 3", "1");
    expect_near(c.render(kThrough + "Ci = color(comp(transmission(P, P - vector(0, 0, 5)), 0), t, sure);"),
                kThinChord);
    expect_near(c.render(kThrough +
                         "Ci = color(occlusion(P, normal(0, 0, -1), 1, \"coneangle\", 1e-5), 1 - t, sure);"),
                kThinChord);
    // Where hits stand for the primitive's own opacity the medium still counts.
    c.asker = "Attribute \"shade\" \"string transmissionhitmode\" \"primitive\" ";
    c.things = "Attribute \"shade\" \"string transmissionhitmode\" \"primitive\" " + c.things;
    expect_near(c.render(kThrough + "Ci = color(comp(transmission(P, P - vector(0, 0, 5)), 0), t, sure);"),
                kThinChord);
}

/// A medium's shader is in its own object's space, whatever the ray hits behind it.
TEST(RayVolumes, KnowTheirOwnObject) {
    Case c = hazy();
    c.shaders["place"] =
        "volume place() { point p = transform(\"object\", P); Ci = color(zcomp(p)); Oi = 1; }";
    c.asker = "Attribute \"trace\" \"int maxspeculardepth\" 9 ";
    c.things =
        "Surface \"constant\" " + wall("-7") + "Exterior \"place\" Surface \"on\" " + sphere("0 0 3", "1");
    expect_near(
        c.render(
            "float r2 = xcomp(P) * xcomp(P) + ycomp(P) * ycomp(P);"
            "Ci = color(comp(trace(P, vector(0, 0, -1)), 0), r2 < 1 ? -10 : 1, abs(r2 - 1) < .08 ? 0 : 1);"),
        1e-4f);
}

/// What moves is looked through where it is.
TEST(RayVolumes, MoveWithTheirSurfaces) {
    Case c = hazy();
    c.options = "Shutter 0 1 ";
    c.asker = "Attribute \"trace\" \"int maxspeculardepth\" 9 \"int samplemotion\" 1 ";
    c.things = kWhiteWall +
               "Attribute \"trace\" \"int maxspeculardepth\" 9 Interior \"haze\" \"k\" [.5] Surface \"on\" "
               "MotionBegin [0 1] Translate 0 0 1.5 Translate 0 0 3.5 MotionEnd Sphere 1 -1 1 360 ";
    expect_near(c.render(kThrough + "Ci = color(comp(trace(P, vector(0, 0, -1)), 0), t, sure);"), kThinChord);
}

// Atmospheres.

/// What a mirror shows has its Atmosphere from the mirror on, not from the eye.
TEST(RayVolumes, TheAtmosphereOfAHitIsFromWhereItsRayBegins) {
    Case c = hazy();
    c.things =
        "Surface \"constant\" Color 1 1 1 Atmosphere \"haze\" \"k\" [.2] \"own\" [.25 .25 .25] " + wall("2");
    const std::string expected =
        "float t = exp(-.2 * 3 * sqrt(1.25)), e = .25 + .75 * t;"
        "vector w = vector(.5, 0, -1); ";
    expect_near(c.render(expected + "Ci = color(comp(trace(P, w), 0), e, 1);"), 1e-5f);
    expect_near(
        c.render(expected + "color got = 0; gather(\"illuminance\", P, w, 0, 1, \"surface:Ci\", got) { }"
                            "Ci = color(comp(got, 0), e, 1);"),
        1e-5f);
    expect_near(
        c.render(expected + "Ci = color(comp(indirectdiffuse(P, w, 1, \"coneangle\", 1e-4), 0), e, 1);"),
        1e-3f);
    // RISpec's own.
    c.things =
        "Surface \"constant\" Color 1 1 1 Atmosphere \"fog\" \"distance\" [4] "
        "\"background\" [.5 .5 .5] " +
        wall("2");
    expect_near(c.render("float d = 1 - exp(-3 / 4);"
                         "Ci = color(comp(trace(P, vector(0, 0, -1)), 0), 1 - .5 * d, 1);"),
                1e-5f);
}

/// A mirror that leans, in perspective, shows a wall beside the camera.
TEST(RayVolumes, AMirrorShowsFogAlongWhatItReflects) {
    Case c = hazy();
    c.options = "Projection \"perspective\" \"fov\" 20 ";
    c.asker = "Translate 0 0 5 Rotate 15 0 1 0 Translate 0 0 -5 ";
    c.things = "ShadingRate 400 Surface \"constant\" Color 1 1 1 Atmosphere \"haze\" \"k\" [.1] " + wall("1");
    expect_near(c.render("vector r = reflect(normalize(I), faceforward(normalize(N), I));"
                         "point p = transform(\"camera\", P); vector w = vtransform(\"camera\", r);"
                         "float way = (1 - zcomp(p)) / zcomp(w);"
                         "Ci = color(comp(trace(P, r), 0), exp(-.1 * way), way > 0 ? 1 : 0);"),
                1e-4f);
}

/// Of two mirrors each has its own over the way to it.
TEST(RayVolumes, AtmospheresOfMirrorsAreOneBehindTheOther) {
    Case c = hazy();
    c.shaders["mirror"] =
        "surface mirror() { Ci = trace(P, reflect(normalize(I), faceforward(normalize(N), I))); Oi = 1; }";
    c.asker = "Attribute \"trace\" \"int maxspeculardepth\" 9 ";
    c.things =
        "Attribute \"trace\" \"int maxspeculardepth\" 9 Surface \"constant\" Color 1 1 1 "
        "Atmosphere \"haze\" \"k\" [.2] \"own\" [.5 .5 .5] " +
        wall("9") + "Surface \"mirror\" Atmosphere \"haze\" \"k\" [.3] \"own\" [.25 .25 .25] " + wall("2");
    expect_near(c.render("float far = exp(-.2 * 7), near = exp(-.3 * 3); float e = .5 + .5 * far;"
                         "Ci = color(comp(trace(P, vector(0, 0, -1)), 0), .25 + (e - .25) * near, 1);"),
                1e-5f);
    // The ray's medium is there in place of what is hit.
    c.asker += "Exterior \"haze\" \"k\" [.6] ";
    expect_near(c.render("float e = .5 + .5 * exp(-.2 * 7);"
                         "Ci = color(comp(trace(P, vector(0, 0, -1)), 0), e * exp(-.6 * 3), 1);"),
                1e-5f);
}

}  // namespace
}  // namespace trapeze::testing
