#include "pipeline/rib/state/moving_transform.h"

#include <gtest/gtest.h>

#include <cmath>

namespace trapeze::rib {
namespace {

void expect_near(const V3d& got, const V3d& wanted) {
    for (int i = 0; i < 3; ++i) EXPECT_NEAR(got[i], wanted[i], 1e-9) << got << " for " << wanted;
}

V3d moved(TransformKind kind, const TransformArguments& arguments, const V3d& p) {
    return p * transform_matrix(kind, arguments);
}

double degrees_between(const V3d& a, const V3d& b) {
    return std::acos(a.normalized().dot(b.normalized())) * (180 / M_PI);
}

TEST(TransformMatrix, TranslateAndScale) {
    expect_near(moved(TransformKind::Translate, {1, 2, 3}, {1, 1, 1}), {2, 3, 4});
    expect_near(moved(TransformKind::Scale, {1, 2, 3}, {1, 1, 1}), {1, 2, 3});
}

TEST(TransformMatrix, RotateTurnsXToYAboutZ) {
    expect_near(moved(TransformKind::Rotate, {90, 0, 0, 1}, {1, 0, 0}), {0, 1, 0});
    expect_near(moved(TransformKind::Rotate, {90, 0, 0, -1}, {1, 0, 0}), {0, -1, 0});
    expect_near(moved(TransformKind::Rotate, {90, 2, 0, 0}, {0, 1, 0}), {0, 0, 1});
    expect_near(moved(TransformKind::Rotate, {90, 0, 1, 0}, {0, 0, 1}), {1, 0, 0});
    expect_near(moved(TransformKind::Rotate, {120, 1, 1, 1}, {1, 0, 0}), {0, 1, 0});
}

/// RISpec: points along the first vector are mapped to one at `angle` degrees from it, by shifts along the
/// second.
TEST(TransformMatrix, SkewMovesTheFirstAxisByTheAngleAlongTheSecond) {
    for (const TransformArguments& a : {TransformArguments{45, 0, 1, 0, 1, 0, 0},
                                        {30, 0, 2, 0, 1, 1, 0},
                                        {-20, 0, 0, 1, 1, 0, 1},
                                        {10, 1, 0, 0, -1, 1, 0}}) {
        const V3d from(a[1], a[2], a[3]), to(a[4], a[5], a[6]);
        const V3d image = moved(TransformKind::Skew, a, from);
        EXPECT_NEAR(degrees_between(image, from), std::abs(a[0]), 1e-6);
        EXPECT_NEAR((image - from).cross(to).length(), 0, 1e-9);
        EXPECT_GT((image - from).dot(to) * a[0], 0);
        expect_near(moved(TransformKind::Skew, a, to), to);
        const V3d normal = from.cross(to);
        expect_near(moved(TransformKind::Skew, a, normal), normal);
    }
}

TEST(TransformMatrix, PerspectiveMapsTheFieldOfViewToOne) {
    const M44d m = transform_matrix(TransformKind::Perspective, {90});
    expect_near(V3d(2, 0, 2) * m, {1, 0, 0.5});
    expect_near(V3d(0, -3, 3) * m, {0, -1, 2.0 / 3});
    const M44d narrow = transform_matrix(TransformKind::Perspective, {60});
    expect_near(V3d(std::tan(M_PI / 6), 0, 1) * narrow, {1, 0, 0});
}

TEST(MovingTransform, ArgumentsAreInterpolatedNotMatrices) {
    MovingTransform transform;
    transform.concat(MovingFactor{TransformKind::Rotate, {0, 1}, {{0, 0, 0, 1}, {90, 0, 0, 1}}});
    const double half = std::sqrt(0.5);
    expect_near(V3d(1, 0, 0) * transform.at(0.5f), {half, half, 0});
    expect_near(V3d(1, 0, 0) * transform.at(-3), {1, 0, 0});
    expect_near(V3d(1, 0, 0) * transform.at(7), {0, 1, 0});
}

TEST(MovingTransform, TheNewestFactorIsAppliedFirst) {
    MovingTransform transform;
    transform.concat(transform_matrix(TransformKind::Translate, {1, 0, 0}));
    transform.concat(transform_matrix(TransformKind::Scale, {2, 2, 2}));
    expect_near(V3d(1, 0, 0) * transform.at(0), {3, 0, 0});
    transform.concat(MovingFactor{TransformKind::Translate, {0, 1}, {{0, 0, 0}, {0, 1, 0}}});
    expect_near(V3d(1, 0, 0) * transform.at(1), {3, 2, 0});
}

TEST(MovingTransform, ObjectUnderAMovingCamera) {
    MovingTransform camera, object, both;
    camera.concat(MovingFactor{TransformKind::Translate, {0, 1}, {{0, 0, 0}, {0, 0, 4}}});
    object.concat(transform_matrix(TransformKind::Scale, {2, 2, 2}));
    object.concat(MovingFactor{TransformKind::Translate, {0, 1}, {{0, 0, 0}, {1, 0, 0}}});
    both = camera;
    both.concat(object);
    for (const float time : {0.0f, 0.25f, 1.0f})
        expect_near(V3d(0, 1, 0) * both.at(time), V3d(0, 1, 0) * object.at(time) * camera.at(time));
    expect_near(V3d(0, 1, 0) * both.at(1), {2, 2, 4});
    EXPECT_EQ(both.moving_factors(), 2);
    EXPECT_EQ(camera.moving_factors(), 1);
}

TEST(MovingTransform, CopiesAreIndependent) {
    MovingTransform a;
    a.concat(transform_matrix(TransformKind::Translate, {1, 0, 0}));
    MovingTransform b = a;
    b.concat(transform_matrix(TransformKind::Translate, {1, 0, 0}));
    expect_near(V3d(0, 0, 0) * a.at(0), {1, 0, 0});
    expect_near(V3d(0, 0, 0) * b.at(0), {2, 0, 0});
}

MovingTransform translation(std::vector<float> times) {
    std::vector<TransformArguments> arguments;
    for (size_t i = 0; i < times.size(); ++i) arguments.push_back({static_cast<float>(i), 0, 0});
    MovingTransform transform;
    transform.concat(MovingFactor{TransformKind::Translate, std::move(times), std::move(arguments)});
    return transform;
}

TEST(WantedKeys, MeetTheTimesWithinTheShutter) {
    EXPECT_EQ(MovingTransform().wanted_keys(0, 1), 1);
    EXPECT_EQ(translation({0, 1}).wanted_keys(0, 1), 2);
    EXPECT_EQ(translation({0, 0.5f, 1}).wanted_keys(0, 1), 3);
    EXPECT_EQ(translation({0, 0.25f, 1}).wanted_keys(0, 1), 5);
    EXPECT_EQ(translation({0, 0.25f, 1}).wanted_keys(0, 0.5f), 3);
    EXPECT_EQ(translation({0, 0.3f, 1}).wanted_keys(0, 1), 17);
    EXPECT_EQ(translation({-1, 3}).wanted_keys(0, 1), 2);
    EXPECT_EQ(translation({2, 3}).wanted_keys(0, 1), 1);
    EXPECT_EQ(translation({0, 1}).wanted_keys(0.5f, 0.5f), 1);
}

TEST(WantedKeys, NoSegmentTurnsByMoreThanTenDegrees) {
    const auto keys = [](std::vector<float> times, std::vector<float> degrees) {
        std::vector<TransformArguments> arguments;
        for (const float d : degrees) arguments.push_back({d, 0, 0, 1});
        MovingTransform transform;
        transform.concat(MovingFactor{TransformKind::Rotate, std::move(times), std::move(arguments)});
        return transform.wanted_keys(0, 1);
    };
    EXPECT_EQ(keys({0, 1}, {0, 10}), 2);
    EXPECT_EQ(keys({0, 1}, {0, 11}), 3);
    EXPECT_EQ(keys({0, 1}, {0, -90}), 17);
    EXPECT_EQ(keys({0, 1}, {0, 1e9f}), 65);
    EXPECT_EQ(keys({0, 0.5f, 1}, {0, 0, 10}), 3);  // twenty degrees a shutter while it turns
    EXPECT_EQ(keys({0, 0.5f, 1}, {0, 1, 41}), 9);  // eighty
    EXPECT_EQ(keys({0, 1, 2}, {0, 10, 9000}), 2);  // turns fast only after the shutter closes
}

TEST(MotionTimes, BetweenKeysAreThoseThatNoKeyIs) {
    using Times = std::vector<float>;
    EXPECT_EQ(times_between_keys({0, .5f, 1}, 0, 1, 3), Times());
    EXPECT_EQ(times_between_keys({0, .5f, 1}, 0, 1, 2), Times{.5f});
    EXPECT_EQ(times_between_keys({-1, .3f, .5f, 2}, 0, 1, 17), Times{.3f});
    // Two at one key: something happens between them, also at the shutter's ends.
    EXPECT_EQ(times_between_keys({0, .5f, .50001f, 1}, 0, 1, 3), Times{.50001f});
    EXPECT_EQ(times_between_keys({0, .00001f, 1}, 0, 1, 2), Times{.00001f});
    EXPECT_EQ(times_between_keys({0, .99999f, 1}, 0, 1, 2), Times{.99999f});
    EXPECT_EQ(keys_meeting({0, .00001f, 1}, 0, 1), 17);
    Times many;
    for (int i = 0; i <= 1000; ++i) many.push_back(static_cast<float>(i) / 1000);
    EXPECT_EQ(times_between_keys(many, 0, 1, 2).size(), 64u);
}

}  // namespace
}  // namespace trapeze::rib
