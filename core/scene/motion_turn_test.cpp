#include "core/scene/motion_turn.h"

#include <gtest/gtest.h>

#include <cmath>

namespace trapeze {
namespace {

/// A space that turns about z by so many degrees at each key, and is moved and stretched besides.
Primitive turning(std::initializer_list<float> degrees) {
    std::vector<M44f> poses;
    float key = 0;
    for (const float angle : degrees) {
        M44f m, turn, stretch;
        m.translate(V3f(1 + key, 2, 3 - key)), key += 1;
        turn.rotate(V3f(0, 0, angle * static_cast<float>(M_PI) / 180));
        stretch.scale(V3f(2, 3, 0.5f));
        poses.push_back(stretch * turn * m);
    }
    Primitive primitive;
    primitive.camera_from_object = poses;
    return primitive;
}

void expect_close(const V3f& found, const V3f& expected) {
    EXPECT_NEAR((found - expected).length(), 0, 1e-6f) << found << " " << expected;
}

TEST(MotionTurn, IsThatOfTheSpaceBetweenItsKeys) {
    const MotionTurn turn(turning({0, 10, 20}), 3, {});
    ASSERT_FALSE(turn.is_none());
    for (const float time : {0.25f, 0.5f, 0.75f, 1.0f}) {
        // The middle between two turns is half way.
        const float angle = 20 * time * static_cast<float>(M_PI) / 180;
        expect_close(turn.forward(V3f(1, 0, 0), time), V3f(std::cos(angle), std::sin(angle), 0));
        expect_close(turn.forward(V3f(0, 0, 1), time), V3f(0, 0, 1));
        expect_close(turn.back(turn.forward(V3f(1, -2, 3), time), time), V3f(1, -2, 3));
    }
    EXPECT_EQ(turn.forward(V3f(1, -2, 3), 0), V3f(1, -2, 3));
}

TEST(MotionTurn, OfWhatMovesAloneIsNone) {
    EXPECT_TRUE(MotionTurn(turning({30, 30}), 2, {}).is_none());
    EXPECT_TRUE(MotionTurn(turning({30}), 1, {}).is_none());
    const MotionTurn none(turning({30, 30}), 2, {});
    EXPECT_EQ(none.forward(V3f(1, -2, 3), 0.5f), V3f(1, -2, 3));
}

/// What the camera takes with it is taken back; what goes with the camera is then turned.
TEST(MotionTurn, TakesTheCamerasOwnMotionOut) {
    std::vector<M44f> held(5);
    for (size_t key = 0; key < held.size(); ++key)
        held[key].rotate(V3f(0, 0, -0.1f * static_cast<float>(key)));
    const float end = 0.4f * 180 / static_cast<float>(M_PI);
    EXPECT_TRUE(MotionTurn(turning({0, end / 4, end / 2, end * 0.75f, end}), 5, held).is_none());
    const MotionTurn turn(turning({0}), 5, held);
    ASSERT_FALSE(turn.is_none());
    expect_close(turn.forward(V3f(1, 0, 0), 1), V3f(std::cos(0.4f), -std::sin(0.4f), 0));
}

/// A plane along x and y that is drawn out along x tips less than its points do; beyond a quarter nothing is
/// known.
TEST(MotionTurn, TakesPlanesAlong) {
    const MotionTurn turn(turning({0, 10, 20}), 3, {});
    const float angle = 20 * .5f * static_cast<float>(M_PI) / 180;
    expect_close(*turn.normal(V3f(1, 0, 0), .5f), V3f(std::cos(angle), std::sin(angle), 0));
    EXPECT_EQ(*turn.normal(V3f(0, .6f, .8f), 0), V3f(0, .6f, .8f));
    EXPECT_EQ(*MotionTurn(turning({30, 30}), 2, {}).normal(V3f(0, 0, 1), .5f), V3f(0, 0, 1));
    const auto drawn_out = [](const M44f& end) {
        Primitive primitive;
        primitive.camera_from_object = {M44f(), end};
        return MotionTurn(primitive, 2, {}).normal(V3f(1, 0, 1).normalized(), 1);
    };
    M44f longer, much_longer, skewed;
    longer[0][0] = 1.2f, much_longer[0][0] = 1.3f, skewed[0][1] = .6f, skewed[0][0] = .8f;
    ASSERT_TRUE(drawn_out(longer));
    expect_close(*drawn_out(longer), V3f(1 / 1.2f, 0, 1).normalized());
    EXPECT_FALSE(drawn_out(much_longer));
    EXPECT_FALSE(drawn_out(skewed)) << "of unit length along each axis, but not across";
}

}  // namespace
}  // namespace trapeze
