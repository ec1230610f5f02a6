#include "shade/clouds/surfel_raster.h"

#include <gtest/gtest.h>

#include "shade/clouds/clouds_harness.h"
#include "shade/clouds/surfels_harness.h"

namespace trapeze::testing {
namespace {

/// A small thing hides its solid angle times the cosine, over half a turn; in full also near the rim.
TEST(SurfelRaster, SmallThingsHideTheirSolidAngle) {
    const SkyPart sky(static_cast<float>(kHalfTurn64 / 2), false);
    SurfelRaster raster;
    for (const double angle : {0.0, .3, .8, 1.2, 1.5})
        for (const float solid_angle : {.0001f, .01f, .1f}) {
            const V3d way(std::sin(angle) * .6, std::sin(angle) * .8, std::cos(angle));
            raster.start({0, 0, 1}, sky, true);
            raster.add_small(V3f(way), {solid_angle, 0, 1, {.5f, 1, 2}});
            const double expected = static_cast<double>(solid_angle) * std::cos(angle) / kHalfTurn64;
            EXPECT_NEAR(static_cast<double>(raster.hidden()), expected, 1e-4 * expected);
            EXPECT_NEAR(static_cast<double>(raster.light().x), expected / 2, 1e-4 * expected);
            EXPECT_NEAR(static_cast<double>(raster.light().z), expected * 2, 2e-4 * expected);
        }
    raster.start({0, 0, 1}, sky, true);
    raster.add_small({.6f, 0, -.8f}, {.1f, 0, 1, V3f(1)});
    EXPECT_EQ(raster.hidden(), 0);
}

/// What a soft disc of radius r hides from a point at the distance 1 below its middle: it covers
/// 4 / 2.14^2 (1 - (x / 2.14 r)^2)^3 at x from its middle, and a ring there is 2 x / (1 + x^2)^2 dx of the
/// sky.
double hidden_by_disc(double r) {
    constexpr int kRings = 1000;
    const double reach = 2.14 * r, step = reach / kRings;
    double sum = 0;
    for (int i = 0; i < kRings; ++i) {
        const double x = (i + .5) * step;
        sum += 4 / (2.14 * 2.14) * std::pow(1 - x * x / (reach * reach), 3) * 2 * x * step /
               std::pow(1 + x * x, 2);
    }
    return sum;
}

/// Discs turn with the point's normal. A disc of radius r without a soft rim hides r^2 / (1 + r^2).
TEST(SurfelRaster, DiscsHideTheirFormFactor) {
    const SkyPart sky(static_cast<float>(kHalfTurn64 / 2), false);
    SurfelRaster raster;
    Numbers numbers(2);
    EXPECT_NEAR(hidden_by_disc(.1), .01 / 1.01, 2e-4);
    for (int i = 0; i < 50; ++i) {
        const V3f normal = numbers.in_cube().normalized();
        const float radius = numbers.between(.2f, .5f);
        raster.start(normal, sky, true);
        raster.add_disc(normal, -normal, radius, {1, 0, 1, V3f(1)});
        const double expected = hidden_by_disc(static_cast<double>(radius));
        EXPECT_NEAR(static_cast<double>(raster.hidden()), expected, .01 * expected);
    }
}

/// What is hidden once is not hidden again: neither by the backs of a closed thing nor by what lies behind.
TEST(SurfelRaster, NearThingsHideFarOnes) {
    const SkyPart sky(static_cast<float>(kHalfTurn64 / 2), false);
    SurfelRaster raster;
    for (const bool clamp : {true, false}) {
        raster.start({0, 0, 1}, sky, clamp);
        raster.add_small({0, 0, 1}, {.05f, 0, 1, {1, 0, 0}});
        const float once = raster.hidden();
        raster.add_small({0, 0, 1}, {0, .05f, 1, {0, 1, 0}});
        EXPECT_NEAR(raster.hidden(), clamp ? once : 2 * once, 1e-6f);
        EXPECT_NEAR(raster.light().y, clamp ? 0 : once, 1e-6f);
        for (int i = 0; i < 400; ++i) raster.add_small({0, 0, 1}, {.05f, 0, 1, {0, 0, 1}});
        EXPECT_LT(raster.hidden(), clamp ? .2f : 100.0f);
    }
}

/// The whole sky, a cone of it, and all solid angles alike: the part of a half that hides everything on one
/// side is a half. A cone of angle a holds all of a thing in its middle.
TEST(SurfelRaster, ConesHoldTheirPart) {
    SurfelRaster raster;
    for (const double angle : {.4, 1.0, kHalfTurn64 / 2})
        for (const bool uniform : {false, true}) {
            const SkyPart sky(static_cast<float>(angle), uniform);
            float sum = 0;
            for (int p = 0; p < SkyPart::kPixels; ++p) sum += sky.weight(p);
            EXPECT_NEAR(sum, 1, 1e-5f);
            raster.start({0, 0, 1}, sky, true);
            raster.add_small({0, 0, 1}, {.001f, 0, 1, V3f(1)});
            const double part = uniform ? 2 * kHalfTurn64 * (1 - std::cos(angle))
                                        : kHalfTurn64 * std::pow(std::sin(angle), 2);
            EXPECT_NEAR(static_cast<double>(raster.hidden()), .001 / part, .02 * .001 / part);
        }
    // Beyond the rim nothing is seen.
    const SkyPart narrow(.4f, false);
    raster.start({0, 0, 1}, narrow, true);
    raster.add_small(V3f(.8f, 0, .6f), {.01f, 0, 1, V3f(1)});
    EXPECT_EQ(raster.hidden(), 0);
}

TEST(SurfelRaster, TellsWhereItIsOpen) {
    const SkyPart sky(static_cast<float>(kHalfTurn64 / 2), false);
    SurfelRaster raster;
    const V3f normal = V3f(1, 2, 3).normalized(), side = normal.cross(V3f(0, 0, 1)).normalized();
    raster.start(normal, sky, true);
    EXPECT_GT(raster.open_way().normalized().dot(normal), .9999f);
    raster.add_small((normal + side).normalized(), {.5f, 0, 1, V3f(1)});
    EXPECT_LT(raster.open_way().normalized().dot(side), -.05f);
}

/// From everywhere within a box, and from its floor: everything is hidden, but for what the soft rims of
/// clusters leave open between them.
TEST(SurfelRaster, BoxesAreClosed) {
    Look look;
    Numbers numbers(7);
    for (const int n : {10, 30}) {
        const SurfelTree tree(box(n, 1));
        double mean = 0;
        for (int i = 0; i < 50; ++i) {
            SurfelPlace place;
            place.position = numbers.in_cube() * .9f, place.normal = numbers.in_cube().normalized();
            place.max_solid_angle = .05f;
            const double hidden = look.hidden(tree, place);
            EXPECT_GT(hidden, .9);
            EXPECT_LT(hidden, 1.00001);
            mean += hidden / 50;
        }
        EXPECT_GT(mean, .955);
        for (int i = 0; i < 20; ++i) {
            SurfelPlace place;
            place.position = {numbers.between(-.9f, .9f), numbers.between(-.9f, .9f), -1};
            place.normal = {0, 0, 1};
            EXPECT_GT(look.hidden(tree, place), .9);
        }
    }
}

/// A plane does not hide itself, nor does a ball.
TEST(SurfelRaster, ConvexThingsDoNotHideThemselves) {
    Surfels plane;
    add_sheet(plane, 100, {-5, -5, 0}, {10, 0, 0}, {0, 10, 0});
    const SurfelTree flat(plane), round(sphere(5000, V3f(0), 1));
    Look look;
    Numbers numbers(3);
    for (int i = 0; i < 50; ++i) {
        SurfelPlace place;
        place.position = {numbers.between(-2, 2), numbers.between(-2, 2), 0}, place.normal = {0, 0, 1};
        EXPECT_EQ(look.hidden(flat, place), 0);
        place.position = place.normal = numbers.in_cube().normalized();
        EXPECT_LT(look.hidden(round, place), .001);
    }
}

/// A ball of radius R at a distance d hides (R / d)^2 cos(theta) where it is wholly above the horizon. It
/// comes to that as clusters become smaller.
TEST(SurfelRaster, BallsHideTheirFormFactor) {
    Look look;
    double last = 1;
    for (const float angle : {.1f, .01f}) {
        double worst = 0;
        for (const float height : {1.5f, 2.0f, 4.0f}) {
            const SurfelTree tree(sphere(5000, {0, 0, height}, 1));
            for (int i = 0; i < 20; ++i) {
                SurfelPlace place;
                place.position = {static_cast<float>(i) * .05f, static_cast<float>(i % 5) * .2f, 0};
                place.normal = {0, 0, 1}, place.max_solid_angle = angle;
                const auto d = static_cast<double>((place.position - V3f(0, 0, height)).length());
                const double expected = static_cast<double>(height) / (d * d * d);
                worst = std::max(worst, std::abs(look.hidden(tree, place) / expected - 1));
            }
        }
        EXPECT_LT(worst, angle < .05f ? .03 : .07);
        EXPECT_LT(worst, last / 2);
        last = worst;
    }
}

/// A disc of radius 2, of discs 1 / 30 apart; its colour changes along x and has a mean of 1 / 2.
void add_round(Surfels& surfels, float height, const V3f& color) {
    for (int i = 0; i < 120 * 120; ++i) {
        const float x = (static_cast<float>(i % 120) + .5f) / 30 - 2;
        const float y = (static_cast<float>(i / 120) + .5f) / 30 - 2;
        if (x * x + y * y > 4) continue;
        add_disc(surfels, {x, y, height}, {0, 0, -1}, 1 / 900.0);
        surfels.radiosities.push_back(color * (.5f + x / 4));
    }
}

/// A disc of radius R at a height h sends R^2 / (R^2 + h^2) of its colour to a point below its middle; what
/// lies behind it sends next to nothing, whichever of them was made first.
TEST(SurfelRaster, DiscsSendTheirFormFactor) {
    Look look;
    SurfelPlace place;
    place.position = V3f(0), place.normal = {0, 0, 1}, place.max_solid_angle = .03f;
    for (const float layers : {1.0f, 2.0f, -2.0f}) {
        Surfels surfels;
        if (layers < 0) add_round(surfels, 2, {0, 0, 1});
        add_round(surfels, 1, {1, .4f, 0});
        if (layers == 2) add_round(surfels, 2, {0, 0, 1});
        look.hidden(SurfelTree(surfels), place);
        const V3f light = look.raster.light();
        EXPECT_NEAR(light.x, .5f * .8f, .05f * .4f);
        EXPECT_NEAR(light.y, .4f * .5f * .8f, .05f * .16f);
        EXPECT_LT(light.z, .02f);
    }
}

}  // namespace
}  // namespace trapeze::testing
