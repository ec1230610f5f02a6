/// When things are where: times of motion that are no even parts of the shutter, of shapes, transformations
/// and clipping planes, each beside a closed form or a motion that is written in another way.
#include <gtest/gtest.h>

#include <string>

#include "tests/program_harness.h"
#include "tests/scene_harness.h"

namespace trapeze::testing {
namespace {

constexpr int kRowWidth = 64;

/// One row of alphas: 4 by 1/16 units, 16 pixels a unit. `camera`: requests before the world.
std::vector<float> alphas_of(const std::string& camera, const std::string& world) {
    const WorkFolder folder;
    folder.write("a.rib",
                 "Format 64 1 1 PixelSamples 16 16 PixelFilter \"box\" 1 1 ScreenWindow -2 2 -.03 .03\n"
                 "Shutter 0 1 Projection \"orthographic\" Translate 0 0 5 " +
                     camera + "\nWorldBegin Surface \"constant\"\n" + world + "\nWorldEnd\n");
    const auto frames = render_scene((folder / "a.rib").string(), RenderSettings());
    std::vector<float> alphas;
    for (size_t i = 3; !frames.empty() && i < frames.front().image.rgba.size(); i += 4)
        alphas.push_back(frames.front().image.rgba[i]);
    return alphas;
}

/// A bar from x to x + .5.
std::string bar(double x) {
    const std::string from = std::to_string(x), to = std::to_string(x + .5);
    return "Polygon \"P\" [" + from + " -1 0 " + to + " -1 0 " + to + " 1 0 " + from + " 1 0] ";
}

using BarTimes =
    std::vector<std::pair<std::string, double>>;  ///< of a motion: a time, and where the bar is then

std::string deformed(const BarTimes& times) {
    std::string at, poses;
    for (const auto& [time, x] : times) at += time + ' ', poses += bar(x);
    return "MotionBegin [" + at + "] " + poses + "MotionEnd ";
}

std::string translated(const BarTimes& times, const std::string& moved) {
    std::string at, ways;
    for (const auto& [time, x] : times) at += time + ' ', ways += "Translate " + std::to_string(x) + " 0 0 ";
    return "MotionBegin [" + at + "] " + ways + "MotionEnd " + moved;
}

int leftmost(const std::vector<float>& alphas) {
    for (size_t x = 0; x < alphas.size(); ++x)
        if (alphas[x] > 0) return static_cast<int>(x);
    return kRowWidth;
}

/// Away and back again while a sixteenth of the shutter goes by. There are 65 keys at most, so that the
/// farthest is not reached wholly.
TEST(MotionTimes, OfAShapeThatJumpsAreSeen) {
    const BarTimes swing{{"0", .8}, {".03", -.8}, {".06", .8}, {"1", .8}};
    const int farthest = static_cast<int>((2 - .8) * 16);
    for (const std::string& world : {deformed(swing), translated(swing, bar(0)),
                                     "ObjectBegin 1 " + deformed(swing) + "ObjectEnd ObjectInstance 1 "}) {
        EXPECT_GE(leftmost(alphas_of("", world)), farthest);
        EXPECT_LE(leftmost(alphas_of("", world)), farthest + 3);
    }
    const BarTimes sooner{{"0", .8}, {".1", -.8}, {".2", .8}, {"1", .8}};
    for (const std::string& world : {deformed(sooner), translated(sooner, bar(0))})
        EXPECT_LE(leftmost(alphas_of("", world)), farthest + 2);
}

TEST(MotionTimes, OfManyPosesAllCount) {
    BarTimes turns;
    for (int i = 0; i <= 32; ++i) turns.push_back({std::to_string(i / 32.), i % 2 == 0 ? .6 : -1.1});
    const std::vector<float> shape = alphas_of("", deformed(turns)),
                             space = alphas_of("", translated(turns, bar(0)));
    for (int x = 0; x < kRowWidth; ++x)
        EXPECT_NEAR(shape[static_cast<size_t>(x)], space[static_cast<size_t>(x)], .03f) << x;
    EXPECT_NEAR(shape[15 + 16], .29f,
                .03f);  // the whole way is 1.7, of which a bar of .5 hides a place for .5
}

/// What happens between two times that are nearly one happens at once.
TEST(MotionTimes, CloseTogetherAreAJump) {
    const BarTimes jump{{"0", .7}, {".5", .7}, {".50001", -1}, {"1", -1}};
    for (const std::string& world : {deformed(jump), translated(jump, bar(0))}) {
        const std::vector<float> seen = alphas_of("", world);
        EXPECT_NEAR(seen[20], .5f, .03f);  // at -.72
        EXPECT_NEAR(seen[47], .5f, .03f);  // at .97
        EXPECT_NEAR(seen[34], 0, .02f);
    }
    // As the shutter opens, and as it closes.
    const BarTimes at_open{{"0", .7}, {".00001", -1}, {"1", -1}},
        at_close{{"0", .7}, {".99999", .7}, {"1", -1}};
    for (const std::string& world : {deformed(at_open), translated(at_open, bar(0))})
        EXPECT_GT(alphas_of("", world)[20], .95f);
    for (const std::string& world : {deformed(at_close), translated(at_close, bar(0))})
        EXPECT_GT(alphas_of("", world)[47], .95f);
}

/// The edge goes from 0 to .8 at an even speed, though nothing else moves.
TEST(MotionTimes, OfAPlaneCountByThemselves) {
    const std::string wall = "Polygon \"P\" [-9 -9 0 9 -9 0 9 9 0 -9 9 0] ";
    const auto cut = [&](const std::string& motion) {
        return alphas_of("TransformBegin " + motion + "ClippingPlane 0 0 0 1 0 0 TransformEnd ", wall);
    };
    const std::vector<float> seen = cut("MotionBegin [0 1] Translate 0 0 0 Translate .8 0 0 MotionEnd ");
    for (int x = 0; x < kRowWidth; ++x) {
        const float at = (static_cast<float>(x) + .5f) / 16 - 2;
        EXPECT_NEAR(seen[static_cast<size_t>(x)], std::clamp(1 - at / .8f, 0.0f, 1.0f), .04f) << x;
    }
    BarTimes turns;
    for (int i = 0; i <= 32; ++i) turns.push_back({std::to_string(i / 32.), i % 2 == 0 ? -1. : 1.});
    const std::vector<float> often = cut(translated(turns, ""));
    for (int x = 0; x < kRowWidth; ++x) {
        const float at = (static_cast<float>(x) + .5f) / 16 - 2;
        EXPECT_NEAR(often[static_cast<size_t>(x)], std::clamp((1 - at) / 2, 0.0f, 1.0f), .04f) << x;
    }
}

}  // namespace
}  // namespace trapeze::testing
