/// How wide rays are where they meet a surface, next to closed forms: what textures are filtered over there.
#include <gtest/gtest.h>

#include "tests/rays/rays_harness.h"

namespace trapeze::testing {
namespace {

/// How far a point goes over what a vertex stands for, along an axis.
const std::string kWidth = "float over(float x) { return abs(Du(x) * du) + abs(Dv(x) * dv); } ";
/// Tells its width in red, green and blue.
const std::string kWidthShader =
    kWidth + "surface width() { Ci = color(over(xcomp(P)), over(ycomp(P)), over(zcomp(P))); Oi = 1; }";
const std::string kMirror =
    "surface mirror() { Ci = trace(P, reflect(normalize(I), normalize(N))); Oi = 1; }";

/// Rays that go apart by `apart` on each unit of z: the width after `far` units.
Image image_of(Case& c, const std::string& apart, const std::string& far, const std::string& component = "0",
               const std::string& stretched = "1") {
    c.functions = kWidth;
    c.shaders["width"] = kWidthShader, c.shaders["mirror"] = kMirror;
    return c.render("float k = " + apart + ", w = over(" + (component == "1" ? "ycomp" : "xcomp") +
                    "(P)) * abs(1 + k * " + far + ") * " + stretched +
                    "; color c = trace(P, vector(k * xcomp(P), k * ycomp(P), -1));"
                    "Ci = told(comp(c, " +
                    component + ") / w, 1, 1);");
}

/// What is told from rays a pixel apart is right within how much directions bend over that: a 32nd of how
/// fast they turn.
TEST(RayFootprints, GrowAsRaysGoApart) {
    for (const auto& [apart, tolerance] :
         {std::pair<std::string, float>{"0", 1e-3f}, {".5", .5f / 64}, {"2", 2.f / 64}})
        for (const std::string component : {"0", "1"}) {
            Case c;
            c.things = "Surface \"width\" Scale 4 4 1 " + wall("1");
            expect_told(image_of(c, apart, "4", component), tolerance);
        }
}

/// Rays that come together see less than what is as large as a pixel from the eye.
TEST(RayFootprints, ShrinkAsRaysComeTogether) {
    Case c;
    c.things = "Surface \"width\" " + wall("1");
    expect_told(image_of(c, "-.2", "4"), 1e-2f);
}

TEST(RayFootprints, AreLongWhereTheSurfaceLiesAslant) {
    Case c;
    c.things = "Surface \"width\" Patch \"bilinear\" \"P\" [-3 6 -12 3 6 12 -3 -6 -12 3 -6 12] ";  // z = 4 x
    expect_told(image_of(c, "0", "0", "0"), 2e-3f);
    expect_told(image_of(c, "0", "0", "2", "4"), 2e-3f);
}

/// The rays beside it go on from what a ray has hit.
TEST(RayFootprints, GoOnBehindMirrors) {
    for (const std::string apart : {"0", ".5", "-.05"}) {
        Case c;
        c.things = "Surface \"mirror\" " + wall("1") + "Surface \"width\" Scale 3 3 1 " + wall("7");
        expect_told(image_of(c, apart, "10"), .5f / 32);
    }
}

/// A ball's normals turn: rays go apart by twice that, for which this is the formula near its middle. Its
/// poles, where surfaces have no directions, are not in view.
TEST(RayFootprints, GrowBehindCurvedMirrors) {
    Case c;
    c.shaders["mirror"] = kMirror;
    c.things =
        "Surface \"mirror\" AttributeBegin Translate 0 0 -19 Rotate 90 1 0 0 Sphere 20 -20 20 360 AttributeEnd "
        "Surface \"width\" " +
        wall("9");
    // From z = 5 down to 1 side by side, then 8 up: 1 + 2 * 8 / 20.
    expect_told(image_of(c, "0", "0", "0", "1.8"), 5e-2f);
}

/// Each of 64 rays over half a sphere has its share of it.
TEST(RayFootprints, AreConesWhereRaysFillASky) {
    Case c;
    c.shaders["width"] = kWidthShader;
    c.things = "Surface \"width\" " + wall("1");
    const Image image = c.render(
        "float length = 0, most = 0, n = 0; color seen = 0; vector way = 0;"
        "gather(\"illuminance\", P, vector(0, 0, -1), PI / 2, 64, \"surface:Ci\", seen, \"ray:length\", length,"
        "       \"ray:direction\", way) {"
        "  float w = (1 / 32 + sqrt(2 * PI / 64) * length) * sqrt(1 + pow(xcomp(way) / zcomp(way), 2));"
        "  most = max(most, abs(comp(seen, 0) / w - 1)); n += 1; }"
        "Ci = told(1 + most, 1, n > 20 ? 1 : 0);");
    expect_told(image, 1e-2f, 3500);
}

/// A fine pattern far behind a mirror is grey: a pixel of it holds many lines.
TEST(RayFootprints, HoldPatternsThatAreTooFineToBeSeen) {
    Case c;
    c.shaders["lines"] =
        kWidth +
        "surface lines() { float x = xcomp(P) * 40;"
        "  Ci = mix(color(mod(x, 1) > .5 ? 1 : 0), color(.5), smoothstep(.5, 1.5, over(x))); Oi = 1; }";
    c.things = "Surface \"lines\" Scale 100 100 1 " + wall("-60");
    const Image image = c.render("Ci = trace(P, vector(xcomp(P), ycomp(P), -1));");
    for (const Pixel& p : pixels(image)) {
        ASSERT_EQ(p.alpha, 1);
        ASSERT_NEAR(p.red, .5f, 1e-3f);
    }
}

}  // namespace
}  // namespace trapeze::testing
