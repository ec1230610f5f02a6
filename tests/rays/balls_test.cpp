/// Balls of mirror and of glass: where rays that they turn come to, next to the laws of Ibn al-Haytham and
/// Snell. At rest, while they move and grow (next to the mean over the shutter), and blown up by a
/// displacement from balls of half their size. Mirrors that rays graze, too.
#include <gtest/gtest.h>

#include "tests/rays/rays_harness.h"

namespace trapeze::testing {
namespace {

/// What a ball of the radius R does: how its middle goes from `from` to `to` while the shutter is open, and
/// its radius from `grows` R to R.
struct Pose {
    const char* name;
    const char *from = "0 0 3", *to = "0 0 3";
    double grows = 1;
    bool displaced = false;
    double turns = 0;  ///< degrees

    bool moves() const { return std::string(from) != to || grows != 1 || turns != 0; }
};

void PrintTo(const Pose& pose, std::ostream* out) {
    *out << pose.name;
}

std::string number(double value) {
    return std::to_string(value);
}

/// Larger by this, by the formula of its normal, too: neighbours' differences would be those of
/// micropolygons.
constexpr double kBlown = .22;
const std::string kBlow =
    "displacement blow() { vector out = normalize(vector(transform(\"object\", P)));"
    "  P += " +
    number(kBlown) + " * out; N = normal(out); }";

std::string ball(const Pose& pose, double radius, const std::string& surface) {
    std::string text = "AttributeBegin Surface " + surface + " ";
    const double blown = pose.displaced ? kBlown : 0;
    const auto sphere_of = [](double r) {
        return "Sphere " + number(r) + " " + number(-r) + " " + number(r) + " 360 ";
    };
    const std::string from = "Translate " + std::string(pose.from) + " ",
                      to = "Translate " + std::string(pose.to) + " ";
    text += from == to ? from : "MotionBegin [0 1] " + from + to + "MotionEnd ";
    if (pose.turns != 0)
        text += "MotionBegin [0 1] Rotate 0 1 2 3 Rotate " + number(pose.turns) + " 1 2 3 MotionEnd ";
    if (pose.displaced)
        text += "Attribute \"trace\" \"int displacements\" [1] Attribute \"displacementbound\" \"sphere\" [" +
                number(kBlown * 1.2) + "] Displacement \"blow\" ";
    text += pose.grows == 1 ? sphere_of(radius - blown)
                            : "MotionBegin [0 1] " + sphere_of(pose.grows * radius - blown) +
                                  sphere_of(radius - blown) + "MotionEnd ";
    return text + "AttributeEnd ";
}

/// Where a line from `o` along `d` (of unit length) enters a sphere about m (side -1), or leaves it (side 1);
/// how it is bent and reflected there.
const std::string kSphere =
    "point crossed(point o; vector d; point m; float R, side) { vector w = o - m; float b = w . d;"
    "  return o + d * (-b + side * sqrt(max(b * b - w . w + R * R, 0))); }"
    "vector bent(point at; vector d; point m; float side, eta) {"
    "  return normalize(refract(d, -side * normalize(vector(at - m)), eta)); }"
    "point on_plane(point o; vector d; float z) { return o + d * ((z - zcomp(o)) / zcomp(d)); } ";

/// Rays of a point. One goes out in each of so many parts of the shutter, so that their mean is off by less
/// than what the place varies by over two of them.
constexpr int kTimes = 243;

/// How far places may be off, besides by kTimes.
struct Off {
    double of_three_quarters;  ///< of the points
    double of_one;
};

/// The places to which rays straight down come, within `reach` of the middle of the picture: told by the
/// surface "place" of a wall as x + y / 2. The formula is that of comes_to(), a function of the ball's middle
/// m and radius R, averaged over 64 times.
///
/// Balls' micropolygons have sides of 1/32, and lie up to 4.9e-4 beside the sphere; displaced ones have sides
/// twice as long, and lie four times as far beside it. What turns has keys ten degrees apart, between which
/// its points move straight: up to 1.9e-3 inside. The farthest points may be off by twice of what was found.
void expect_places(Case& c, const Pose& pose, const std::string& comes_to, double reach, const Off& off,
                   int at_least) {
    c.shaders["blow"] = kBlow;
    c.shaders["place"] = "surface place() { Oi = 1; Ci = 16 + xcomp(P) + .5 * ycomp(P); }";
    c.options = "Shutter 0 1 ";
    c.asker += pose.moves() ? "Attribute \"trace\" \"int samplemotion\" [1] " : "";
    c.functions = kSphere +
                  "point comes_to(point m; float R) { extern point P; vector d = vector(0, 0, -1); " +
                  comes_to + " } ";
    const auto point = [](std::string text) {
        for (char& letter : text) letter = letter == ' ' ? ',' : letter;
        return "point(" + text + ")";
    };
    const std::string samples = pose.moves() ? ", \"samples\", " + number(kTimes) : "",
                      middle = "mix(" + point(pose.from) + ", " + point(pose.to) + ", i)",
                      radius = ".5 * mix(" + number(pose.grows) + ", 1, i)";
    const Image image =
        c.render("if (xcomp(P) * xcomp(P) + ycomp(P) * ycomp(P) < " + number(reach * reach) + ") {" +
                 "  float found = comp(trace(P, vector(0, 0, -1)" + samples + "), 0) - 16;" +
                 "  float expected = 0, varies = 0, before = 0, i;"
                 "  for (i = 1 / 128; i < 1; i += 1 / 64) {"
                 "    point there = comes_to(" +
                 middle + ", " + radius +
                 "); float now = xcomp(there) + .5 * ycomp(there);"
                 "    expected += now / 64; varies += i > 1 / 64 ? abs(now - before) : 0; before = now; }"
                 "  float by_times = 2 * varies / " +
                 number(kTimes) + ";" +
                 "  Ci = told(found - clamp(found - expected, -by_times, by_times), expected, 1); }");
    expect_told(image,
                static_cast<float>(off.of_three_quarters * (pose.displaced || pose.turns != 0 ? 4 : 1)),
                at_least, static_cast<float>(off.of_one * (pose.displaced ? 2 : 1)));
}

/// Surfaces that turn rays: by reflection, or by the index inside over that outside.
void turn(Case& c) {
    c.shaders["shiny"] =
        "surface shiny() { Oi = 1; Ci = color trace(P, reflect(normalize(I), normalize(N))); }";
    c.shaders["lens"] =
        "surface lens(float eta = 1.5;) { Oi = 1; normal Nn = normalize(N); vector d = normalize(I);"
        "  float enters = d . Nn < 0 ? 1 : 0;"
        "  Ci = color trace(P, refract(d, enters > 0 ? Nn : -Nn, enters > 0 ? 1 / eta : eta)); }";
}

std::string depth(int bounces) {
    return "Attribute \"trace\" \"int maxspeculardepth\" [" + std::to_string(bounces) + "] ";
}

class RayBalls : public ::testing::TestWithParam<Pose> {};

/// A normal turns a ray by twice the angle that it is off, and the wall is some three units away, up to 0.6
/// radians askew.
TEST_P(RayBalls, OfMirrorShowWhatTheLawOfReflectionSays) {
    Case c;
    turn(c);
    c.asker = depth(2);
    c.things = depth(2) + ball(GetParam(), .5, "\"shiny\"") + "Surface \"place\" " + wall("6");
    expect_places(c, GetParam(),
                  "point a = crossed(P, d, m, R, -1);"
                  "return on_plane(a, reflect(d, normalize(vector(a - m))), 6);",
                  .15, {4e-3, .015}, 60);
}

/// Each surface turns a ray by 1/2 of what its normal is off by, or by 1/3, and the wall is three radii
/// behind.
TEST_P(RayBalls, OfGlassShowWhatSnellsLawSays) {
    for (const double eta : {1.5, 1.2, 1 / 1.3}) {
        SCOPED_TRACE(eta);
        Case c;
        turn(c);
        c.asker = depth(4);
        c.things = depth(4) + ball(GetParam(), .5, "\"lens\" \"eta\" " + number(eta)) + "Surface \"place\" " +
                   wall("1.5");
        expect_places(
            c, GetParam(),
            "float eta = " + number(eta) +
                "; point a = crossed(P, d, m, R, -1);"
                "vector d1 = bent(a, d, m, -1, 1 / eta); point b = crossed(a + .1 * d1, d1, m, R, 1);"
                "return on_plane(b, bent(b, d1, m, 1, eta), 1.5);",
            GetParam().moves() ? .22 : .345, {2e-3, .012}, GetParam().moves() ? 150 : 350);
    }
}

/// Whose wall is a tenth of the radius: four surfaces, which together bend rays little, but may add to what
/// each is off.
TEST_P(RayBalls, OfThinGlassShowWhatSnellsLawSays) {
    // Rays that begin on the micropolygons below them are a little beside those that begin at their points.
    const std::pair<std::string, Off> begins[] = {
        {"Attribute \"trace\" \"float bias\" [.01] ", {1.5e-3, .005}}, {"", {2e-3, .01}}};
    for (const auto& [bias, off] : begins) {
        SCOPED_TRACE(bias);
        Case c;
        turn(c);
        const std::string kind = depth(6) + bias;
        c.asker = kind;
        c.things = kind + ball(GetParam(), .5, "\"lens\" \"eta\" 1.5") +
                   ball(GetParam(), .45, "\"lens\" \"eta\" .6666667") + "Surface \"place\" " + wall("1.5");
        expect_places(
            c, GetParam(),
            "point a = crossed(P, d, m, R, -1); vector d1 = bent(a, d, m, -1, 1 / 1.5);"
            "point b = crossed(a, d1, m, .9 * R, -1); vector d2 = bent(b, d1, m, -1, 1.5);"
            "point e = crossed(b + .1 * d2, d2, m, .9 * R, 1); vector d3 = bent(e, d2, m, 1, 1 / 1.5);"
            "point f = crossed(e, d3, m, R, 1); return on_plane(f, bent(f, d3, m, 1, 1.5), 1.5);",
            GetParam().moves() ? .22 : .31, off, GetParam().moves() ? 150 : 280);
    }
}

/// A plane so many degrees from the rays' direction: what is met behind it is as far away as the ray goes.
TEST(RayMirrors, ShowAtGrazingAnglesWhatTheLawOfReflectionSays) {
    for (const double degrees : {20.0, 5.0, 1.0, 0.2}) {
        SCOPED_TRACE(degrees);
        Case c;
        turn(c);
        c.shaders["place"] = "surface place() { Oi = 1; Ci = 16 + xcomp(P) + .5 * ycomp(P); }";
        c.asker = depth(2);
        const double slope = std::tan(degrees * M_PI / 180);  // the plane goes through (0, 0, 4.5)
        const std::string far = number(-19.5 * slope) + " ", near = number(0.0) + " ";
        c.things = depth(2) + "Surface \"shiny\" Patch \"bilinear\" \"P\" [" + near + "-3 4.5 " + near +
                   "3 4.5 " + far + "-3 -15 " + far + "3 -15] Surface \"place\" Patch \"bilinear\" \"P\" [" +
                   "-99 -99 -20 -99 99 -20 99 -99 -20 99 99 -20] ";
        c.functions = kSphere;
        const Image image =
            c.render("float slope = " + number(slope) +
                     "; float z = 4.5 + xcomp(P) / slope; vector d = vector(0, 0, -1);"
                     "point there = on_plane(point(xcomp(P), ycomp(P), z),"
                     "  reflect(d, normalize(vector(1, 0, -slope))), -20);"
                     "float met = z > -14.9 && z < 4.4 ? 1 : 0;"
                     "Ci = told(comp(trace(P, d), 0) - 16, xcomp(there) + .5 * ycomp(there), met);");
        expect_told(image, 2e-4f, static_cast<int>(std::min(1900.0, 50 * degrees * 5)));
    }
}

INSTANTIATE_TEST_SUITE_P(, RayBalls,
                         ::testing::Values(Pose{"AtRest"}, Pose{"Moving", "-.1 .05 3.1", ".1 0 2.9"},
                                           Pose{"Growing", "0 0 3", "0 0 3", .8},
                                           Pose{"Turning", "0 0 3", "0 0 3", 1, false, 60},
                                           Pose{"Displaced", "0 0 3", "0 0 3", 1, true},
                                           Pose{"DisplacedAndGrowing", "0 0 3", "0 0 3", .8, true},
                                           Pose{"DisplacedAndTurning", "0 0 3", "0 0 3", 1, true, 60},
                                           Pose{"DisplacedAndMoving", "-.1 .05 3.1", ".1 0 2.9", 1, true}),
                         [](const ::testing::TestParamInfo<Pose>& pose) { return pose.param.name; });

}  // namespace
}  // namespace trapeze::testing
