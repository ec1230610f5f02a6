#include "shade/materials/light_rig.h"

#include <gtest/gtest.h>

#include "shade/materials/shader_library.h"
#include "shade/shading_harness.h"

namespace trapeze {
namespace {

using testing::color;
using testing::expect_near_triple;
using testing::number;
using testing::point;
using testing::shader;

/// What a light sends to one point.
struct Received {
    V3f L, direction, Cl;
};

/// A lamp, and what is needed to light one point with it.
class OneLamp {
  public:
    explicit OneLamp(const ShaderInstance& instance, Diagnostics* diagnostics = nullptr)
        : library_(scene_.options, diagnostics) {
        auto executable = library_.find(instance.name, rsl::ShaderKind::Light, {}, {});
        if (!executable) return;
        lamp_.spaces = std::make_unique<SceneSpaces>(scene_, camera_, &instance, nullptr);
        lamp_.shader =
            std::make_unique<BoundShader>(std::move(executable), instance, *lamp_.spaces, diagnostics);
    }

    bool exists() const { return lamp_.shader != nullptr; }

    Received at(const V3f& P) {
        alignas(64) float planes[3 * kLanes];
        for (size_t k = 0; k < 3; ++k) std::fill_n(planes + k * kLanes, kLanes, P[static_cast<int>(k)]);
        vm::Operand operand;
        operand.data = planes;
        operand.lane_mask = ~size_t{0};
        operand.stride = kLanes;
        const std::vector<const Lamp*> lamps{&lamp_};
        const vm::Context surroundings;
        LightRig rig;
        rig.start(machine_, lamps, lamps, surroundings, kLanes, {});
        const vm::LightRequest request{.P = operand};
        const vm::Lights::Arriving& light = *rig.arriving(0, request).get();
        const auto first = [](const float* p) { return V3f(p[0], p[kLanes], p[2 * kLanes]); };
        if (light.ambient) return {V3f(0), V3f(0), first(light.Cl)};
        return {first(light.L), first(light.direction), first(light.Cl)};
    }

  private:
    Scene scene_;
    Camera camera_;
    ShaderLibrary library_;
    vm::Machine machine_;
    Lamp lamp_;
};

Received received(const ShaderInstance& instance, const V3f& P) {
    return OneLamp(instance).at(P);
}

constexpr float kPi = 3.14159265f;

TEST(Lights, UnknownNamesMakeNone) {
    EXPECT_FALSE(OneLamp(shader("sunshine")).exists());
    EXPECT_FALSE(OneLamp(shader("plastic")).exists());  // of another kind
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
    expect_near_triple(r.direction, V3f(-1, 0, 0), 1e-6f);
    expect_near_triple(r.L, V3f(-2, 0, 0), 1e-5f);
    EXPECT_EQ(r.Cl, V3f(3));
}

TEST(Lights, PointFallsOffWithTheSquareOfTheDistance) {
    const ShaderInstance lamp = shader("pointlight", {number("intensity", 12), point("from", V3f(0, 0, 3))});
    const Received near = received(lamp, V3f(0, 0, 1)), far = received(lamp, V3f(0, 0, -1));
    expect_near_triple(near.Cl, V3f(3), 1e-6f);
    expect_near_triple(far.Cl, V3f(0.75f), 1e-6f);
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
    const OneLamp made(lamp, &diagnostics);
    EXPECT_TRUE(made.exists());
    ASSERT_EQ(reported.size(), 1u);
    EXPECT_NE(reported[0].text.find("declares \"intensity\" as float"), std::string::npos)
        << reported[0].text;
}

}  // namespace
}  // namespace trapeze
