#include "shade/lights.h"

#include <gtest/gtest.h>

#include "shade/test_scene.h"

namespace trapeze {
namespace {

/// What a light sends to one point.
struct Received {
    V3f L, direction, Cl;
};

Received received(const ShaderInstance& instance, const V3f& P) {
    const auto made = make_standard_light(ParameterBinder(instance, nullptr));
    PlanePool pool;
    pool.start(1);
    const Plane3 Ps = pool.take3();
    for (int k = 0; k < 3; ++k) fill(P[k], Ps[k]);
    LightShader::Light light;
    light.L = pool.take3(), light.direction = pool.take3(), light.Cl = pool.take3();
    made->illuminate(Ps, light);
    const auto at = [](const Plane3& p) { return V3f(p.x[0], p.y[0], p.z[0]); };
    if (made->is_ambient()) return {V3f(0), V3f(0), at(light.Cl)};
    return {at(light.L), at(light.direction), at(light.Cl)};
}

constexpr float kPi = 3.14159265f;

TEST(Lights, UnknownNamesMakeNone) {
    EXPECT_EQ(make_standard_light(ParameterBinder(shader("sunshine"), nullptr)), nullptr);
}

TEST(Lights, AmbientIsIntensityTimesColor) {
    const Received r = received(
        shader("ambientlight", {number("intensity", 2), color("lightcolor", V3f(1, 0.5f, 0.25f))}), V3f(9));
    EXPECT_EQ(r.Cl, V3f(2, 1, 0.5f));
}

TEST(Lights, DistantShinesAlongItsAxisInShaderSpace) {
    const Received ahead = received(shader("distantlight"), V3f(3, 2, 1));
    EXPECT_EQ(ahead.direction, V3f(0, 0, -1));
    EXPECT_EQ(ahead.Cl, V3f(1));

    ShaderInstance turned =
        shader("distantlight", {point("from", V3f(0, 2, 0)), point("to", V3f(0)), number("intensity", 3)});
    turned.camera_from_shader.setAxisAngle(V3f(0, 0, 1), kPi / 2);  // y to -x
    turned.camera_from_shader[3][2] = 50;
    const Received r = received(turned, V3f(0));
    expect_near(r.direction, V3f(-1, 0, 0), 1e-6f);
    expect_near(r.L, V3f(-2, 0, 0), 1e-5f);
    EXPECT_EQ(r.Cl, V3f(3));
}

TEST(Lights, PointFallsOffWithTheSquareOfTheDistance) {
    const ShaderInstance lamp = shader("pointlight", {number("intensity", 12), point("from", V3f(0, 0, 3))});
    const Received near = received(lamp, V3f(0, 0, 1)), far = received(lamp, V3f(0, 0, -1));
    expect_near(near.Cl, V3f(3), 1e-6f);
    expect_near(far.Cl, V3f(0.75f), 1e-6f);
    EXPECT_EQ(near.L, V3f(0, 0, 2));
    EXPECT_EQ(near.direction, V3f(0, 0, 1));
}

TEST(Lights, PointDoesNotLightItsOwnPlace) {
    const Received r = received(shader("pointlight"), V3f(0));
    EXPECT_EQ(r.Cl, V3f(0));
    EXPECT_EQ(r.direction, V3f(0));
}

/// RISpec's spotlight for a point at distance 2 and an angle from the axis.
float spot_formula(float angle, float cone, float delta, float beam) {
    const float x = std::cos(angle), low = std::cos(cone), high = std::cos(cone - delta);
    const float t = std::clamp((x - low) / (high - low), 0.0f, 1.0f);
    return std::pow(std::max(x, 0.0f), beam) * t * t * (3 - 2 * t) / 4;
}

TEST(Lights, SpotFollowsItsConeAndBeam) {
    const float cone = 0.6f, delta = 0.3f;
    for (float beam : {0.0f, 2.0f, 7.5f}) {
        const ShaderInstance spot =
            shader("spotlight", {number("coneangle", cone), number("conedeltaangle", delta),
                                 number("beamdistribution", beam), point("to", V3f(5, 0, 0))});
        for (float angle : {0.0f, 0.2f, 0.35f, 0.45f, 0.55f, 0.65f, 2.0f}) {
            const V3f P(2 * std::cos(angle), 2 * std::sin(angle), 0);
            EXPECT_NEAR(received(spot, P).Cl.x, spot_formula(angle, cone, delta, beam), 2e-6f)
                << beam << ' ' << angle;
        }
    }
}

TEST(Lights, SpotDefaultsAreThirtyAndFiveDegrees) {
    const auto at_degrees = [](float degrees) {
        const float a = degrees * kPi / 180;
        return received(shader("spotlight"), V3f(std::sin(a), 0, std::cos(a))).Cl.x;
    };
    EXPECT_NEAR(at_degrees(0), 1, 1e-6f);
    EXPECT_NEAR(at_degrees(20), std::pow(std::cos(20 * kPi / 180), 2), 1e-5f);
    EXPECT_GT(at_degrees(29), 0);
    EXPECT_EQ(at_degrees(30.5f), 0);
}

TEST(Lights, SpotWithoutADeltaHasAHardEdge) {
    const ShaderInstance spot =
        shader("spotlight", {number("conedeltaangle", 0), number("beamdistribution", 0)});
    EXPECT_NEAR(received(spot, V3f(std::sin(0.5f), 0, std::cos(0.5f))).Cl.x, 1, 1e-5f);
    EXPECT_EQ(received(spot, V3f(std::sin(0.55f), 0, std::cos(0.55f))).Cl.x, 0);
}

TEST(Lights, AParameterOfTheWrongTypeIsReported) {
    std::vector<Diagnostic> reported;
    Diagnostics diagnostics([&](const Diagnostic& d) { reported.push_back(d); });
    const ShaderInstance lamp = shader("pointlight", {color("intensity", V3f(5))});
    make_standard_light(ParameterBinder(lamp, &diagnostics));
    ASSERT_EQ(reported.size(), 1u);
    EXPECT_NE(reported[0].text.find("\"intensity\" is not a float"), std::string::npos) << reported[0].text;
}

}  // namespace
}  // namespace trapeze
