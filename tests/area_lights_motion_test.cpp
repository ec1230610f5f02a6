/// Area lights that move while the shutter is open, next to the mean of a formula over their way
/// [decision 0030].
#include "tests/area_lights_harness.h"

namespace trapeze::testing {
namespace {

/// The mean of what a formula gives at many times of the shutter: `at(t)` is a light's way from x = 0 on,
/// which it moves along from -2 to 2.
std::string mean_in_shutter(const std::string& formula) {
    return "float expected = 0, i; for (i = 0; i < 64; i += 1) { float x = -2 + 4 * (i + .5) / 64;"
           "  expected += (" +
           formula + ") / 64; }";
}
const std::string kMovesAcross = "MotionBegin [0 1] Translate -2 0 0 Translate 2 0 0 MotionEnd ";

/// What a unit square of radiance 1, and a ball of width 1, give where they are.
const std::string kSquareAtX =
    "polygon(P, point(x - .5, -.5, 3), point(x + .5, -.5, 3), point(x + .5, .5, 3), point(x - .5, .5, 3))";
const std::string kBallAtX =
    ".25 / (xcomp(vector(point(x, 0, 3) - P)) * xcomp(vector(point(x, 0, 3) - P)) +"
    "  ycomp(P) * ycomp(P) + 4) * 2 / distance(point(x, 0, 3), P)";

/// What shines moves by four of its widths while the shutter is open: a mesh, a ball, a deforming mesh.
TEST(AreaLights, ThatMoveGiveTheirMeanOverTheShutter) {
    const std::string square = mean_in_shutter("PI * " + kSquareAtX), ball = mean_in_shutter(kBallAtX);
    for (
        const auto& [shape, formula] :
        {std::pair{kMovesAcross + "Polygon \"P\" [-.5 -.5 0 .5 -.5 0 .5 .5 0 -.5 .5 0] ", square},
         {std::string("MotionBegin [0 1] Polygon \"P\" [-2.5 -.5 0 -1.5 -.5 0 -1.5 .5 0 -2.5 .5 0] "
                      "Polygon \"P\" [1.5 -.5 0 2.5 -.5 0 2.5 .5 0 1.5 .5 0] MotionEnd "),
          square},
         {kMovesAcross + "Points \"P\" [0 0 0] \"constantwidth\" [1] ", ball},
         {"MotionBegin [0 1] Points \"P\" [-2 0 0] \"constantwidth\" [1] "
          "Points \"P\" [2 0 0] \"constantwidth\" [1] MotionEnd ",
          ball},
         // Half by each, of which one has more keys.
         {"MotionBegin [0 .5 1] Translate 0 0 0 Translate 1 0 0 Translate 2 0 0 MotionEnd MotionBegin [0 1] "
          "Points \"P\" [-2 0 0] \"constantwidth\" [1] Points \"P\" [0 0 0] \"constantwidth\" [1] MotionEnd ",
          ball}}) {
        SCOPED_TRACE(shape);
        Case c = lit_by(arealight(shape));
        c.options = "Shutter 0 1 ";
        c.asker += "Attribute \"trace\" \"int samplemotion\" [1] ";
        expect_lit(c.render(asks(formula)), 0.003, 0.08);
    }
}

/// The path tracer's lights, of which there is no primitive. A disk in the sky that turns across is as bright
/// as the mean of its cosines; a dome that turns is as bright as ever.
TEST(AreaLights, OfThePathTracerThatMoveGiveTheirMeanOverTheShutter) {
    const std::string square = mean_in_shutter(kSquareAtX), ball = mean_in_shutter(kBallAtX);
    const std::string turns = "MotionBegin [0 1] Rotate -60 1 0 0 Rotate 60 1 0 0 MotionEnd ";
    const std::string sun = "float s = sin(radians(.265)), expected = s * s * sin(PI / 3) / (PI / 3);";
    const auto lit = [&](const std::string& light, const std::string& formula, double of_mean,
                         double of_one) {
        SCOPED_TRACE(light);
        Case c = lit_by(light);
        c.options = "Shutter 0 1 ";
        c.asker += "Attribute \"trace\" \"int samplemotion\" [1] ";
        expect_lit(c.render(asks(formula)), of_mean, of_one);
    };
    lit(ris("PxrRectLight", kMovesAcross + "Translate 0 0 3"), square, 0.003, 0.08);
    lit(ris("PxrSphereLight", kMovesAcross + "Translate 0 0 3"), ball, 0.003, 0.08);
    lit("ObjectBegin \"o\" " + ris("PxrRectLight", "Translate 0 0 2") + " ObjectEnd AttributeBegin " +
            kMovesAcross + "Translate 0 0 1 ObjectInstance \"o\" AttributeEnd ",
        square, 0.003, 0.08);
    lit(ris("PxrDistantLight", turns,
            "\"float intensity\" [1] \"float angleExtent\" [40] \"int areaNormalize\" [1] "),
        sun, 0.003, 0.03);
    lit("AttributeBegin Attribute \"light\" \"int nsamples\" [256] " + turns +
            "AreaLightSource \"PxrStdAreaLight\" \"a\" Geometry \"envsphere\" AttributeEnd ",
        "float expected = 1;", 0.002, 0.03);
}

/// Of a power that does not grow with the light, each moment's light has its own area.
TEST(AreaLights, ThatGrowHaveTheirAreaAtEachMoment) {
    Case c =
        lit_by(ris("PxrRectLight", "Translate 0 0 3 MotionBegin [0 1] Scale 1 1 1 Scale 3 3 1 MotionEnd ",
                   "\"int areaNormalize\" [1] "));
    c.options = "Shutter 0 1 ";
    c.asker += "Attribute \"trace\" \"int samplemotion\" [1] ";
    expect_lit(
        c.render(asks("float expected = 0, i; for (i = 0; i < 64; i += 1) { float h = .5 + (i + .5) / 64;"
                      "  expected += polygon(P, point(-h, -h, 3), point(h, -h, 3), point(h, h, 3),"
                      "    point(-h, h, 3)) / (4 * h * h) / 64; }")),
        0.003, 0.05);
}

/// With a camera that moves, and an eye that does not look at its motion: the light stands still in the
/// world.
TEST(AreaLights, StandStillWhereTheCameraMoves) {
    Case c = lit_by(ris("PxrRectLight", "Translate 0 0 3"));
    c.options = "Shutter 0 1 MotionBegin [0 1] Translate 0 0 0 Translate .2 0 0 MotionEnd ";
    c.asker += "Attribute \"trace\" \"int samplemotion\" [1] ";
    expect_lit(c.render(asks(kUnitSquare)), 0.001, 0.02);
}

/// What is lit deforms: a square tilts about its middle. Its points are lit where they are as the shutter
/// opens, as all is shaded there, but as the square lies at each moment; grids of one row, too.
TEST(AreaLights, LightWhatDeformsAsItLiesAtEachMoment) {
    for (const char* rate : {"", "ShadingRate 700 "})
        for (const std::string& light : {arealight("Polygon \"P\" [-.5 -.5 0 .5 -.5 0 .5 .5 0 -.5 .5 0] ",
                                                   "\"float intensity\" [.31830988]"),
                                         ris("PxrRectLight", "Translate 0 0 3")}) {
            SCOPED_TRACE(light + rate);
            Case c = lit_by(light);
            c.options = "Shutter 0 1 ";
            c.asker += std::string(rate) + "Attribute \"trace\" \"int samplemotion\" [1] ";
            c.asks =
                "MotionBegin [0 1] " + kAsker +
                "Patch \"bilinear\" \"P\" [-1.2 1.2 6.8 1.2 1.2 3.2 -1.2 -1.2 6.8 1.2 -1.2 3.2] MotionEnd ";
            c.functions +=
                "float across(point p, a, b; vector n) { vector u = normalize(a - p), v = normalize(b - p);"
                "  return acos(clamp(u . v, -1, 1)) * (normalize(u ^ v) . n); } ";
            expect_lit(
                c.render(asks("float expected = 0, i; for (i = 0; i < 64; i += 1) {"
                              "  float tilt = 1.5 * (i + .5) / 64; vector n = normalize(vector(tilt, 0, 1));"
                              "  point a = point(-.5, -.5, 3), b = point(.5, -.5, 3), c = point(.5, .5, 3),"
                              "    d = point(-.5, .5, 3);"
                              "  expected += abs(across(P, a, b, n) + across(P, b, c, n) +"
                              "    across(P, c, d, n) + across(P, d, a, n)) / (2 * PI) / 64; }")),
                0.003, 0.05);
        }
}

/// Whose rays all leave as the shutter opens sees lights there, too.
TEST(AreaLights, ThatMoveAreAtShutterOpenForWhoDoesNotSampleMotion) {
    Case c = lit_by(arealight(kMovesAcross + "Polygon \"P\" [-.5 -.5 0 .5 -.5 0 .5 .5 0 -.5 .5 0] "));
    c.options = "Shutter 0 1 ";
    expect_lit(c.render(asks("float expected = PI * polygon(P, point(-2.5, -.5, 3), point(-1.5, -.5, 3),"
                             "  point(-1.5, .5, 3), point(-2.5, .5, 3));")),
               0.003, 0.05);
}

/// A screen that moves with its light hides it at all times from all that is far behind the screen; without
/// it there is light. The light, which is seen by rays itself, does not hide itself.
TEST(AreaLightShadows, OfWhatMovesWithItsLightMoveWithIt) {
    const std::string light = "Attribute \"visibility\" \"int transmission\" [1] " + kMovesAcross +
                              "Polygon \"P\" [-.5 -.5 0 .5 -.5 0 .5 .5 0 -.5 .5 0] ";
    const auto mean = [&](const std::string& things) {
        Case c = lit_by(arealight(light));
        c.options = "Shutter 0 1 ";
        c.asker += "Attribute \"trace\" \"int samplemotion\" [1] ";
        c.things = things;
        return mean_red(c.render(asks("float expected = 0;")));
    };
    const double open = mean("");
    EXPECT_GT(open, 0.01);
    const std::string screen = "Polygon \"P\" [-.9 -.9 3.1 .9 -.9 3.1 .9 .9 3.1 -.9 .9 3.1] ";
    EXPECT_EQ(mean(kMovesAcross + screen), 0);
    EXPECT_GT(mean(screen), 0.3 * open);
    EXPECT_LT(mean(screen), 0.9 * open);
}

}  // namespace
}  // namespace trapeze::testing
