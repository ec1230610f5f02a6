/// White furnaces: things of albedo 1 under a sky of 1 are not to be seen. Convex ones at one bounce, others
/// but for what the depth limit cuts off: what is hit beyond the D bounces that are allowed is black. At
/// rest, while they move and grow, and blown up by a displacement from things of half their size.
#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <random>
#include <utility>
#include <vector>

#include "tests/rays/rays_harness.h"

namespace trapeze::testing {
namespace {

/// How a thing about the point (0, 0, 4) comes to be there, and where it goes while the shutter is open.
struct FurnacePose {
    const char* name;
    const char* to = "0 0 4";
    double grows = 1;  ///< from this part of its size
    bool displaced = false;
    double turns = 0;  ///< degrees
};

void PrintTo(const FurnacePose& pose, std::ostream* out) {
    *out << pose.name;
}

/// A thing in its own space, by its size.
using Thing = std::function<std::string(double)>;

std::string placed(const FurnacePose& pose, const Thing& thing, const std::string& turned = "") {
    const double size = pose.displaced ? 0.5 : 1;
    std::string text = "MotionBegin [0 1] Translate 0 0 4 Translate " + std::string(pose.to) + " MotionEnd ";
    if (pose.turns != 0)
        text += "MotionBegin [0 1] Rotate 0 1 2 3 Rotate " + std::to_string(pose.turns) + " 1 2 3 MotionEnd ";
    text += turned;
    if (pose.displaced)
        text +=
            "Attribute \"displacementbound\" \"sphere\" [1.1] Attribute \"trace\" \"int displacements\" [1] "
            "Displacement \"blow\" ";
    if (pose.grows == 1) return text + thing(size);
    return text + "MotionBegin [0 1] " + thing(pose.grows * size) + thing(size) + "MotionEnd ";
}

std::string round(const std::string& name, double radius, double from, double to) {
    return name + " " + std::to_string(radius) + " " + std::to_string(from * radius) + " " +
           std::to_string(to * radius) + " 360 ";
}
std::string furnace_ball(double size) {
    return round("Sphere", 0.7 * size, -1, 1);
}
/// Half of a sphere; the camera looks into it.
std::string bowl(double size) {
    return round("Sphere", size, 0, 1);
}
/// The corners of a cube of the side 2, of which every other thing takes what it needs.
std::string corners(double size) {
    std::string points = "\"P\" [";
    for (int i = 0; i < 8; ++i)
        for (int k = 0; k < 3; ++k) points += std::to_string((i >> k & 1 ? 1 : -1) * size) + " ";
    return points + "] ";
}
std::string cube(double size) {
    return "PointsPolygons [4 4 4 4 4 4] [0 1 3 2 5 4 6 7 1 0 4 5 2 3 7 6 0 2 6 4 3 1 5 7] " +
           corners(0.4 * size);
}
/// Three of its sides, seen from within.
std::string corner(double size) {
    return "PointsPolygons [4 4 4] [5 4 6 7 1 0 4 5 3 1 5 7] " + corners(0.6 * size);
}
/// Turns a corner towards the camera.
const std::string kTurned = "Rotate -35.26 1 0 0 Rotate 45 0 1 0 ";

const std::string kOutOfTheFurnaceBall = "normal away = normal(normalize(P - point(0, 0, 4))); ";
const std::string kInwards = "normal away = normal(normalize(point(0, 0, 4) - P)); ";
/// Of a corner, seen from wherever.
const std::string kIntoCorner =
    "normal n = normalize(N); vector into = vtransform(\"object\", \"current\", vector(-1, 1, -1));"
    "normal away = n . into > 0 ? n : -n; ";
const std::string kFacing = "normal away = faceforward(normalize(N), I); ";

/// What misses adds the sky, the first time by 16 rays, then by one.
const std::string kWhite =
    "color k = 0, sum = 0; uniform float rays = raydepth() == 0 ? 16 : 1;"
    "gather(\"illuminance\", P, away, PI / 2, rays, \"distribution\", \"cosine\", \"surface:Ci\", k)"
    "  sum += k;"
    "else sum += 1; Ci = sum / rays;";

Case furnace(const std::string& thing, int depth) {
    Case c;
    c.shaders["blow"] =
        "displacement blow() { P = transform(\"object\", \"current\", 2 * transform(\"object\", P));"
        "  N = calculatenormal(P); }";
    c.options = "Shutter 0 1 ";
    c.asker = kSeen +
              "Attribute \"trace\" \"int samplemotion\" 1 Attribute \"trace\" \"int maxdiffusedepth\" [" +
              std::to_string(depth) + "] ";
    c.asks = "AttributeBegin " + thing + " AttributeEnd ";
    return c;
}

/// The mean of what a thing sends, where it sees itself and the sky; and of how many pixels.
struct Sent {
    double mean = 0, pixels = 0;
};

Sent white(const std::string& thing, const std::string& away, int depth) {
    const Image image = furnace(thing, depth).render(away + kWhite);
    Sent sent;
    for (const Pixel& p : pixels(image)) sent.pixels += p.alpha > 0;
    for (const Pixel& p : pixels(image)) EXPECT_LE(p.red, 1 + 1e-5f);
    sent.mean = mean_red(image);
    return sent;
}

/// A map that is white all around. (Files of 8 bits hold the numbers that are meant.)
const std::string kWhiteMap = "P3\n4 2\n255\n" + [] {
    std::string pixels;
    for (int i = 0; i < 4 * 2 * 3; ++i) pixels += "255 ";
    return pixels;
}();

class RayFurnace : public ::testing::TestWithParam<FurnacePose> {};

/// All rays miss, so that there is no noise.
TEST_P(RayFurnace, ConvexThingsAreNotToBeSeenAtOneBounce) {
    const std::pair<Thing, std::string> things[] = {{furnace_ball, kOutOfTheFurnaceBall}, {cube, kFacing}};
    for (const auto& [thing, away] : things) {
        int seen = 0;
        for (const Pixel& p : pixels(furnace(placed(GetParam(), thing, kTurned), 1).render(away + kWhite))) {
            seen += p.alpha > 0;
            ASSERT_EQ(p.red, p.alpha);
        }
        EXPECT_GT(seen, 400);
    }
}

class RayFurnaceOfALight : public ::testing::TestWithParam<FurnacePose> {};

/// A white dome as a light, whose samples cast shadows. Most of them follow the cosine: they count 1.23 at
/// most, an eighth is behind the surface, and independent ones have a deviation of 0.45. So 64 have 0.06, and
/// 800 points 2e-3; strata help. What turns has another hemisphere at each sample's time: strata help little,
/// and of so many points one is off by three or four deviations.
TEST_P(RayFurnaceOfALight, ConvexThingsAreNotToBeSeen) {
    Case c = furnace(placed(GetParam(), furnace_ball), 1);
    c.may_say = "ris";
    c.asker += "AttributeBegin Light \"PxrDomeLight\" \"l\" \"int fixedSampleCount\" [64] AttributeEnd ";
    const Image image = c.render("Ci = diffuse(faceforward(normalize(N), point(0, 0, 4) - P));");
    const float most = GetParam().turns != 0 ? 0.24f : 0.12f;
    for (const Pixel& p : pixels(image)) ASSERT_NEAR(p.red, p.alpha, most);
    EXPECT_NEAR(mean_red(image), 1, 2e-3);
}

/// What looks at all of the sky by one call sees nothing else, and all of it: no noise, however it moves.
TEST_P(RayFurnace, ConvexThingsHideNothingOfTheSkyFromThemselves) {
    const WorkFolder folder;
    folder.write("white.ppm", kWhiteMap);
    const std::string map = (folder / "white.ppm").string();
    const std::pair<Thing, std::string> things[] = {{furnace_ball, kOutOfTheFurnaceBall}, {cube, kFacing}};
    for (const auto& [thing, away] : things) {
        int seen = 0;
        const Image image = furnace(placed(GetParam(), thing, kTurned), 1)
                                .render(away +
                                        "Ci = color(1 - occlusion(P, away, 16),"
                                        "  comp(indirectdiffuse(P, away, 16, \"environmentmap\", \"" +
                                        map + "\"), 0), 1);");
        for (const Pixel& p : pixels(image)) {
            seen += p.alpha > 0;
            ASSERT_EQ(p.red, p.alpha);
            ASSERT_NEAR(p.green, p.alpha, 1e-5f);
        }
        EXPECT_GT(seen, 400);
    }
}

/// Domes that turn while the shutter is open and are drawn out, so that what a sample of a map stands for
/// changes with its direction and time. A white map is white all the time.
std::string turning_dome(const std::string& map, int samples) {
    return "AttributeBegin MotionBegin [0 1] Rotate 0 1 2 3 Rotate 120 1 2 3 MotionEnd "
           "MotionBegin [0 1] Scale 1 1 1 Scale 1 1 3 MotionEnd "
           "Light \"PxrDomeLight\" \"l\" \"int fixedSampleCount\" [" +
           std::to_string(samples) + "] " +
           (map.empty() ? "" : "\"string lightColorMap\" [\"" + map + "\"] ") + "AttributeEnd ";
}

/// The mean over the picture is white within four of its deviations, which blocks of 64 pixels tell: their
/// random numbers are independent. The deviation is as given at most: there is more where some blocks are too
/// bright and others too dark.
void expect_white(const Image& image, double deviation) {
    constexpr int kBlock = 8;
    std::map<std::pair<int, int>, std::pair<double, double>> blocks;
    int i = 0;
    for (const Pixel& p : pixels(image)) {
        const int x = i % image.width, y = i++ / image.width;
        auto& [error, count] = blocks[{x / kBlock, y / kBlock}];
        if (p.alpha > 0) error += static_cast<double>(p.red - p.alpha), ++count;
    }
    double error = 0, squares = 0, count = 0;
    for (const auto& [at, block] : blocks)
        error += block.first, squares += block.first * block.first, count += block.second;
    ASSERT_GT(count, 400);
    EXPECT_LE(std::sqrt(squares) / count, deviation);
    EXPECT_NEAR(error / count, 0, 4 * std::sqrt(squares) / count);
}

TEST_P(RayFurnaceOfALight, ConvexThingsAreNotToBeSeenUnderDomesThatTurn) {
    const WorkFolder folder;
    folder.write("white.ppm", kWhiteMap);
    for (const std::string& map : {std::string(), (folder / "white.ppm").string()}) {
        SCOPED_TRACE(map);
        Case c = furnace(placed(GetParam(), furnace_ball), 1);
        c.may_say = "ris";
        c.asker += turning_dome(map, 128);
        expect_white(c.render("Ci = diffuse(faceforward(normalize(N), point(0, 0, 4) - P));"), 2e-3);
    }
}

/// What one bounce brings is lit by the dome in turn: 3/4 of the light is seen, as below.
TEST_P(RayFurnaceOfALight, ABowlUnderADomeThatTurnsLosesAQuarter) {
    Case c = furnace(placed(GetParam(), bowl), 1);
    c.may_say = "ris";
    c.asker += turning_dome("", 8);
    expect_white(
        c.render(kInwards + "Ci = raydepth() == 0 ? (diffuse(away) + indirectdiffuse(P, away, 8)) / .75 :"
                            "  diffuse(away);"),
        5e-3);
}

/// In a bowl that is half of a sphere every point sees as much of the bowl as every other one: its share of
/// the sphere's area, 1/2. So after D bounces 2^-(D + 1) of the light is on its way.
TEST_P(RayFurnace, ABowlLosesHalfAtEachBounce) {
    for (const int depth : {1, 2, 3, 5}) {
        const double left = std::pow(0.5, depth + 1);
        const Sent sent = white(placed(GetParam(), bowl), kInwards, depth);
        EXPECT_GT(sent.pixels, 2000);
        // 16 rays a pixel, each of which is 0 or 1: twice four deviations, since rays of pixels beside each
        // other are not wholly independent.
        const double deviation = std::sqrt(left * (1 - left) / (sent.pixels * 16));
        EXPECT_NEAR(sent.mean, 1 - left, 8 * deviation + 1e-3) << depth;
    }
}

/// How much of the sky is hidden from the points of a picture of kTellsHidden.
struct Hidden {
    double most = 0, mean = 0, points = 0;
};
const std::string kTellsHidden = "Ci = occlusion(P, away, 256);";

Hidden hidden_in(const Image& image) {
    Hidden hidden;
    for (const Pixel& p : pixels(image)) {
        if (!(p.alpha > 0)) continue;
        hidden.most = std::max(hidden.most, static_cast<double>(p.red));
        hidden.mean += static_cast<double>(p.red), ++hidden.points;
    }
    hidden.mean /= hidden.points;
    return hidden;
}

/// Where the points of a picture of the corner are in its own space, as parts of its size.
const std::string kTellsPlaces = "point q = transform(\"object\", P); Ci = color(q[0], q[1], q[2]);";

std::vector<V3d> places_in(const Image& image) {
    std::vector<V3d> places;
    for (const Pixel& p : pixels(image)) {
        if (!(p.alpha > 0)) continue;
        const double size = static_cast<double>(std::max({p.red, -p.green, p.blue}));
        places.push_back(V3d(p.red, p.green, p.blue) / size);
    }
    return places;
}

/// Of light that goes from points of the corner into all directions, by the cosine, the part that meets its
/// sides `times` times: ways at random, followed in the cube's corner at the origin, whose sides are those
/// squares [0, 2] of the coordinate planes.
double met_again(const std::vector<V3d>& places, int times) {
    constexpr int kWays = 200;
    std::mt19937 random(1);
    std::uniform_real_distribution<double> unit(0, 1);
    size_t met = 0;
    for (const V3d& place : places)
        for (int way = 0; way < kWays; ++way) {
            V3d at(1 - place.x, 1 + place.y, 1 - place.z);
            int side = at.x <= at.y && at.x <= at.z ? 0 : at.y <= at.z ? 1 : 2, count = 0;
            for (; count < times; ++count) {
                const double squared = unit(random), turn = 2 * M_PI * unit(random), r = std::sqrt(squared);
                const int first = (side + 1) % 3, second = (side + 2) % 3;
                V3d direction;
                direction[side] = std::sqrt(1 - squared);
                direction[first] = r * std::cos(turn), direction[second] = r * std::sin(turn);
                const auto distance = [&](int k) { return direction[k] < 0 ? -at[k] / direction[k] : 1e9; };
                side = distance(first) < distance(second) ? first : second;
                at += direction * distance(side);
                at[side] = 0;
                if (std::max({at.x, at.y, at.z}) > 2) break;
            }
            met += count == times;
        }
    return static_cast<double>(met) / (kWays * static_cast<double>(places.size()));
}

/// A corner of three squares: after D bounces what meets its sides once more is black.
TEST_P(RayFurnace, ACornerLosesWhatMeetsItOnceMore) {
    const std::string thing = placed(GetParam(), corner, kTurned);
    const std::vector<V3d> places = places_in(furnace(thing, 1).render(kTellsPlaces));
    ASSERT_GT(places.size(), 1000u);
    for (const int depth : {1, 3, 7}) {
        const double lost = met_again(places, depth + 1);
        // As for the bowl.
        const double deviation = std::sqrt(lost * (1 - lost) / (static_cast<double>(places.size()) * 16));
        EXPECT_NEAR(white(thing, kIntoCorner, depth).mean, 1 - lost, 8 * deviation + 1e-3) << depth;
    }
}

/// A ball over a floor. Of what a point of the floor sees the ball is up to (r / d)^2, and of what the ball
/// sees up to half is floor; these follow each other.
TEST_P(RayFurnace, ABallAndItsFloorLoseNoMoreThanTheyHide) {
    const double part = 0.7 * 0.7 / (1.5 * 1.5);
    for (const int depth : {1, 3}) {
        Case c = furnace("Polygon \"P\" [-1.2 1.2 5.5 1.2 1.2 5.5 1.2 -1.2 5.5 -1.2 -1.2 5.5] ", depth);
        c.shaders["white"] = "surface white() { Oi = 1; " + kOutOfTheFurnaceBall + kWhite + " }";
        c.things = c.asker + "Surface \"white\" " + placed(GetParam(), furnace_ball);
        const Image image = c.render("normal away = normal(0, 0, -1); " + kWhite);
        EXPECT_GE(mean_red(image), 1 - std::pow(part / 2, (depth + 1) / 2)) << depth;
        for (const Pixel& p : pixels(image)) ASSERT_LE(p.red, 1 + 1e-5f);
    }
}

/// A ball whose displaced bumps hide parts of the sky from each other loses what is hit once more than the
/// depth allows.
TEST(RayFurnaceOfBumps, LoseNoMoreThanTheyHide) {
    const std::string out = "normal away = normalize(N); if (away . (P - point(0, 0, 4)) < 0) away = -away; ";
    const std::string bumpy =
        "Attribute \"displacementbound\" \"sphere\" [.2] Attribute \"trace\" \"int displacements\" [1] "
        "Displacement \"bumps\" ";
    for (const FurnacePose& pose : {FurnacePose{"at rest"}, FurnacePose{"moving", ".4 -.3 3.5"},
                                    FurnacePose{"turning", "0 0 4", 1, false, 60}}) {
        SCOPED_TRACE(pose.name);
        const auto render = [&](int depth, const std::string& body) {
            Case c = furnace(placed(pose, furnace_ball, bumpy), depth);
            c.shaders["bumps"] =
                "displacement bumps() { point Q = transform(\"object\", P); vector v = normalize(vector(Q));"
                "  P = transform(\"object\", \"current\", Q + .3 * (float noise(9 * v) - .5) * v);"
                "  N = calculatenormal(P); }";
            return c.render(out + body);
        };
        const Hidden hidden = hidden_in(render(1, kTellsHidden));
        EXPECT_GT(hidden.points, 400);
        EXPECT_GT(hidden.mean, 0.02);
        EXPECT_LT(hidden.most, 0.9);
        for (const int depth : {1, 3, 7}) {
            const Image image = render(depth, kWhite);
            for (const Pixel& p : pixels(image)) ASSERT_LE(p.red, 1 + 1e-5f);
            const double lost = 1 - mean_red(image), usual = std::pow(hidden.mean, depth + 1);
            EXPECT_LE(lost, std::pow(hidden.most, depth + 1)) << depth;
            // What bumps see of each other hides more of the sky than they do, for valleys see valleys: after
            // three bounces 3.8 times as much is lost in a picture of 512 by 512 pixels, and nearly 5 here.
            EXPECT_LE(lost, 6 * usual + 1e-3) << depth;
            EXPECT_GE(lost, usual / 2 - 1e-5) << depth;
        }
    }
}

std::string name_of(const ::testing::TestParamInfo<FurnacePose>& pose) {
    return pose.param.name;
}

const FurnacePose kMoving{"Moving", ".4 -.3 3.5"}, kGrowing{"Growing", "0 0 4", .7},
    kTurning{"Turning", "0 0 4", 1, false, 60}, kDisplaced{"Displaced", "0 0 4", 1, true},
    kBoth{"DisplacedAndMoving", ".4 -.3 3.5", 1, true};
INSTANTIATE_TEST_SUITE_P(, RayFurnace,
                         ::testing::Values(FurnacePose{"AtRest"}, kMoving, kGrowing, kTurning, kDisplaced,
                                           kBoth),
                         name_of);
INSTANTIATE_TEST_SUITE_P(, RayFurnaceOfALight,
                         ::testing::Values(FurnacePose{"AtRest"}, kMoving, kGrowing, kTurning, kDisplaced,
                                           kBoth),
                         name_of);

}  // namespace
}  // namespace trapeze::testing
