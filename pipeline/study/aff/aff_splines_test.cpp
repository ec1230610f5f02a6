#include "pipeline/study/aff/aff_splines.h"

#include <gtest/gtest.h>

#include <cmath>

#include "pipeline/study/aff/aff_harness.h"

namespace trapeze {
namespace {

using testing::expect_near;

/// Keys at times, of x alone.
std::vector<AffKey> keys_of_x(const std::vector<std::pair<double, double>>& times_and_x) {
    std::vector<AffKey> keys;
    for (const auto& [time, x] : times_and_x) keys.push_back({time, V3d(x, 0, 0), 0, 0, 0, 0});
    return keys;
}

/// Turns about z, in degrees.
std::vector<AffKey> keys_of_turns(const std::vector<std::pair<double, double>>& times_and_degrees) {
    std::vector<AffKey> keys;
    for (const auto& [time, degrees] : times_and_degrees)
        keys.push_back({time, V3d(0, 0, 1), degrees, 0, 0, 0});
    return keys;
}

/// Where the x-axis is turned to about z, in degrees from -180 to 180.
double turn_of(const Imath::Quatd& q) {
    const V3d x = V3d(1, 0, 0) * q.toMatrix44();
    return std::atan2(x.y, x.x) * 180 / 3.14159265358979323846;
}

TEST(AffSpline, PassesThroughItsInnerKeysAndStaysAtTheirEnds) {
    std::vector<AffKey> keys;
    for (int i = 0; i < 6; ++i)
        keys.push_back({i * i * .5, V3d(i % 3, i * .25, 5 - i * i), 0, .1 * i, .3 - .1 * i, .2 * i - .5});
    const AffSpline spline(keys);
    for (size_t i = 1; i + 1 < keys.size(); ++i) {
        expect_near(spline.at(keys[i].time), keys[i].value);
        expect_near(spline.at(keys[i].time + 1e-9), keys[i].value);
        expect_near(spline.at(keys[i].time - 1e-9), keys[i].value);
    }
    for (const double before : {-1e9, 0.0, .49}) expect_near(spline.at(before), keys[1].value);
    for (const double after : {8.01, 12.5, 1e9}) expect_near(spline.at(after), keys[4].value);
}

// In the middle of a Hermite segment from a to b, with tangents m and n: (a + b) / 2 + (m - n) / 8.
TEST(AffSpline, IsThatOfKochanekAndBartels) {
    struct Case {
        size_t key;
        double tension, continuity, bias;
        double out, in;  ///< tangents
    };
    // Steps are 2, 1 and 2. Without more, tangents are means of the steps before and after a key.
    const Case cases[] = {{1, 0, 0, 0, 1.5, 1.5}, {1, .5, 0, 0, .75, 1.5},
                          {2, -1, 0, 0, 1.5, 3},  {1, 0, 0, 1, 2, 1.5},  // the step before alone
                          {1, 0, 0, -1, 1, 1.5},                         // the step after alone
                          {2, 0, 0, 1, 1.5, 1},   {2, 0, 0, -1, 1.5, 2},
                          {1, 0, -1, 0, 1, 1.5},                         // straight on both sides
                          {2, 0, -1, 0, 1.5, 1},  {1, 0, 1, 0, 2, 1.5},  // as the step on the other side
                          {2, 0, 1, 0, 1.5, 2},   {2, 0, .5, .5, 1.5, .5 * (.5 * 1.5 * 1 + 1.5 * .5 * 2)}};
    for (const Case& c : cases) {
        std::vector<AffKey> keys = keys_of_x({{0, -2}, {1, 0}, {2, 1}, {3, 3}});
        keys[c.key].tension = c.tension, keys[c.key].continuity = c.continuity, keys[c.key].bias = c.bias;
        EXPECT_NEAR(AffSpline(keys).at(1.5).x, .5 + (c.out - c.in) / 8, 1e-12) << &c - cases;
    }
}

TEST(AffSpline, HasTheSameSpeedOnBothSidesOfAKeyWhateverTheTimes) {
    const AffSpline spline(keys_of_x({{0, 0}, {1, 0}, {3, 1}, {4, 3}, {4.5, 3}}));
    const double h = 1e-5;
    const double before = (spline.at(3).x - spline.at(3 - h).x) / h,
                 after = (spline.at(3 + h).x - spline.at(3).x) / h;
    EXPECT_NEAR(before, after, 1e-3);
    // The tangents from 1 to 3 are 2/3 and 2: twice 2 / 3 of the means.
    EXPECT_NEAR(spline.at(2).x, .5 + (2. / 3 - 2) / 8, 1e-12);
}

TEST(AffSpline, OfKeysAtTheSameTimeTheLaterOneHolds) {
    const AffSpline spline(keys_of_x({{0, 0}, {1, 1}, {2, 2}, {2, 7}, {3, 8}, {4, 9}}));
    EXPECT_NEAR(spline.at(2 - 1e-9).x, 2, 1e-6);
    EXPECT_EQ(spline.at(2).x, 7);
    const AffSpline at_once(keys_of_x({{1, 0}, {1, 1}, {1, 2}, {1, 3}}));
    for (const double time : {0.0, 1.0, 2.0}) EXPECT_FALSE(std::isnan(at_once.at(time).x));
}

TEST(AffRotationSpline, PassesThroughItsInnerKeys) {
    const std::vector<AffKey> keys = {{0, V3d(0, 1, 0), 10, 0, 0, 0},   {1, V3d(1, 0, 0), 30, 0, 0, 0},
                                      {2, V3d(0, 3, 4), 80, .5, 0, 0},  {3, V3d(0, -1, 0), 350, 0, 1, 0},
                                      {5, V3d(1, 1, 1), -60, 0, 0, -1}, {6, V3d(1, 0, 1), 0, 0, 0, 0}};
    const AffRotationSpline spline(keys);
    for (size_t i = 1; i + 1 < keys.size(); ++i)
        for (const V3d& point : {V3d(1, 0, 0), V3d(0, 1, 0), V3d(0, 0, 1)}) {
            M44d wanted;
            wanted.setAxisAngle(keys[i].value, keys[i].degrees * 3.14159265358979323846 / 180);
            expect_near(point * spline.at(keys[i].time).toMatrix44(), point * wanted);
            expect_near(point * spline.at(keys[i].time + (i < 4 ? 1e-8 : 9)).toMatrix44(), point * wanted);
        }
}

TEST(AffRotationSpline, AboutOneAxisIsASplineOfAngles) {
    const std::vector<std::pair<double, double>> turns = {{0, 0}, {1, 0}, {2, 10}, {3, 30}, {5, 70}, {6, 75}};
    const AffRotationSpline spline(keys_of_turns(turns));
    EXPECT_NEAR(turn_of(spline.at(1.5)), 5 + (5. - 15) / 8, 1e-9);
    const AffSpline angles(keys_of_x(turns));
    EXPECT_NEAR(turn_of(spline.at(2.5)), angles.at(2.5).x, 1e-9);
    EXPECT_NEAR(turn_of(spline.at(4)), angles.at(4).x, 1e-9);
}

TEST(AffRotationSpline, GoesOnBeyondWholeTurnsAndTheShorterWay) {
    const AffRotationSpline wheel(keys_of_turns({{0, 7110}, {1, 7200}, {2, 7290}, {3, 7380}, {4, 7470}}));
    EXPECT_NEAR(turn_of(wheel.at(1.5)), 45, 1e-9);
    EXPECT_NEAR(turn_of(wheel.at(2.25)), 112.5, 1e-9);
    const AffRotationSpline back(keys_of_turns({{0, 0}, {1, 0}, {2, 350}, {3, 350}}));
    EXPECT_NEAR(turn_of(back.at(1.5)), -5, 1e-9);
}

TEST(AffRotation, OfNoAxisIsNone) {
    EXPECT_EQ(aff_rotation(V3d(0, 0, 0), 90), Imath::Quatd());
    EXPECT_NEAR(turn_of(aff_rotation(V3d(0, 0, 1e9), 90)), 90, 1e-9);
    EXPECT_NEAR(turn_of(aff_rotation(V3d(0, 0, -.01), 90)), -90, 1e-9);
}

}  // namespace
}  // namespace trapeze
