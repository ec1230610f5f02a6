/// What shaders are given by the scene: matrices in their spaces, how fast points move, times in lights,
/// derivatives in lights and beside parameters of any name. Each is a colour over the whole picture, which
/// the text tells.
#include <gtest/gtest.h>

#include <string>

#include "tests/program_harness.h"
#include "tests/scene_harness.h"

namespace trapeze::testing {
namespace {

/// The colour in the middle of a square that fills the picture, 2 by 2 at z = 5, u and s to the right.
/// `source` declares surface s(), and light l() if `requests` ask for it.
V3f shown(const std::string& source, const std::string& requests, const std::string& shape = "") {
    const WorkFolder folder;
    const size_t light = source.find("light l(");
    folder.write("s.sl", source.substr(0, light));
    if (light != source.npos) folder.write("l.sl", source.substr(light));
    const std::string square = "Patch \"bilinear\" \"P\" [-1 -1 0 1 -1 0 -1 1 0 1 1 0] ";
    folder.write(
        "a.rib",
        "Format 16 16 1 PixelSamples 1 1 PixelFilter \"box\" 1 1 Projection \"orthographic\" Shutter .25 .75\n"
        "WorldBegin ShadingInterpolation \"smooth\" Translate 0 0 5\n" +
            requests + (shape.empty() ? square : shape) + "\nWorldEnd\n");
    const auto frames = render_scene((folder / "a.rib").string(), RenderSettings());
    if (frames.empty()) return V3f(-1);
    const float* const p = &frames.front().image.rgba[4 * (8 * 16 + 8)];
    return {p[0], p[1], p[2]};
}

void expect_near(const V3f& seen, const V3f& right, float tolerance = 1e-4f) {
    for (int k = 0; k < 3; ++k) EXPECT_NEAR(seen[k], right[k], tolerance) << "component " << k;
}

const std::string kIdentity = "[1 0 0 0 0 1 0 0 0 0 1 0 0 0 0 1] ";

/// An identity says where its space is: shader space for a parameter, as the default does by name, and object
/// space for a variable of the primitive.
TEST(ShaderValues, MatricesAreInTheSpaceWhereTheyAreSaid) {
    const std::string source =
        "surface s(varying matrix m = matrix \"shader\" 1;) { Ci = color (transform(m, point (0, 0, 0))); Oi = 1; }";
    const std::string elsewhere = "Translate .5 .25 -1 ", back = "Translate -.5 -.25 1 ";
    expect_near(shown(source, elsewhere + "Surface \"s\" " + back), {.5f, .25f, 4});
    expect_near(shown(source, elsewhere + "Surface \"s\" \"varying matrix m\" " + kIdentity + back),
                {.5f, .25f, 4});
    const std::string square = "Patch \"bilinear\" \"P\" [-1 -1 0 1 -1 0 -1 1 0 1 1 0] ";
    expect_near(
        shown(source, "Surface \"s\" Translate .25 0 1 ", square + "\"constant matrix m\" " + kIdentity),
        {.25f, 0, 6});
    // A matrix that does something does it first.
    expect_near(
        shown(source,
              elsewhere + "Surface \"s\" \"varying matrix m\" [1 0 0 0 0 1 0 0 0 0 1 0 .125 0 0 1] " + back),
        {.625f, .25f, 4});
}

/// Half of the shutter's second.
TEST(ShaderValues, PointsTellHowFastTheyMove) {
    const std::string source = "surface s() { Ci = color (dPdtime); Oi = 1; }", at = "MotionBegin [.25 .75] ";
    expect_near(shown(source, "Surface \"s\" "), V3f(0));
    expect_near(shown(source, "Surface \"s\" " + at + "Translate 0 0 0 Translate .1 .2 -.05 MotionEnd "),
                {.2f, .4f, -.1f});
    expect_near(shown(source, "Surface \"s\" ",
                      at + "Patch \"bilinear\" \"P\" [-1 -1 0 1 -1 0 -1 1 0 1 1 0] "
                           "Patch \"bilinear\" \"P\" [-1 -1 1 1 -1 1 -1 1 1 1 1 1] MotionEnd "),
                {0, 0, 2});
}

/// What a light sends that shines on all of the square, `x` being how far to the right a point lies.
V3f sent(const std::string& Cl) {
    return shown(
        "surface s() { Ci = 0; Oi = 1; illuminance(P) Ci += Cl; }\n"
        "light l() { float x = xcomp(Ps); solar(vector (0, 0, 1), 0) Cl = " +
            Cl + "; }",
        "LightSource \"l\" 1 Surface \"s\" ");
}

TEST(ShaderValues, LightsKnowTimesAndTheirNames) {
    expect_near(sent("color (time, dtime, ncomps)"), {.25f, .5f, 3});
    expect_near(sent("shadername() == \"l\" ? color (1, 0, 0) : color 0"), {1, 0, 0});
    expect_near(sent("shadername(\"surface\") == \"s\" ? color (1, 0, 0) : color 0"), {1, 0, 0});
}

/// The square is 2 wide, so that x changes by 2 as u goes from 0 to 1.
TEST(ShaderValues, LightsKnowHowTheyChangeOverWhatTheyShineOn) {
    expect_near(sent("color (Deriv(3 * x, x), Du(x), Dv(x))"), {3, 2, 0});
    // As wide as the surface's own filters.
    const std::string widths = "color (du, dv, abs(Du(x) * du) + abs(Dv(x) * dv))";
    const V3f own =
        shown("surface s() { float x = xcomp(P); Oi = 1; Ci = " + widths + "; }", "Surface \"s\" ");
    EXPECT_GT(own.x, 0);
    expect_near(sent(widths), own);
}

TEST(ShaderValues, ParametersMayBeCalledAsDerivativesAreBy) {
    expect_near(shown("surface s(float u = 7, v = 8;) { Oi = 1; Ci = color (Du(s * 2), Dv(t * 3), u); }",
                      "Surface \"s\" "),
                {2, 3, 7}, 1e-3f);
}

/// Colours are halves. RISpec: about the middle of the range, as of the width that is found where there is
/// one value alone.
TEST(ShaderValues, StepsOverARangeHaveAWidth) {
    const auto step = [](const std::string& arguments) {
        return shown("surface s() { Oi = 1; Ci = filterstep(.5, " + arguments + "); }", "Surface \"s\" ").x;
    };
    EXPECT_NEAR(step(".2, .7"), .4f, 3e-4f);
    EXPECT_NEAR(step(".2, .7, \"width\", 1"), .4f, 3e-4f);
    EXPECT_NEAR(step(".2, .7, \"width\", 2"), .45f, 3e-4f);
    EXPECT_NEAR(step(".2, .7 + 0 * s, \"filter\", \"box\", \"width\", 2"), .45f, 3e-4f);
}

}  // namespace
}  // namespace trapeze::testing
