// gather("environment:MAP", ...)
#include <cmath>
#include <numbers>

#include "shade/maps/map_files_harness.h"
#include "shade/maps/map_service.h"
#include "shade/vm/run_shader_harness.h"

namespace trapeze {
namespace {

using testing::ShaderRun;

constexpr float kSphere = 4 * std::numbers::pi_v<float>;

class SkyTurnsTest : public MapFilesTest {
  protected:
    /// White but for a spot, an eighth of the width and of the height, in the upper half.
    SkyTurnsTest() {
        sky_ = write("sky.exr", OIIO::ImageSpec(64, 32, 3, OIIO::TypeDesc::FLOAT), [](int x, int y, int c) {
            return (x / 8 == 2 && y / 4 == 2 ? 200.0f : 1.0f) * static_cast<float>(c + 1);
        });
    }
    /// The integral of its red.
    static float light() {
        const float spot = (std::cos(kSphere / 16) - std::cos(kSphere * 3 / 32)) * kSphere / 16;
        return kSphere + 199 * spot;
    }

    std::unique_ptr<ShaderRun> run(const std::string& body, uint32_t seed = 0, bool optimised = true) {
        auto shader = std::make_unique<ShaderRun>(
            "surface test(output varying float r = 0, q = 0; output varying vector way = 0;) {"
            " color c = 7; vector d = 7, e = 7; float w = 7; string sky = \"environment:" +
                sky_ + "\";" + body + " }",
            optimised);
        MapService service(textures_, scene_, seed);
        vm::Context context;
        context.maps = &service;
        shader->run(context);
        return shader;
    }
    void expect(const std::string& body, float value, float tolerance) {
        for (const bool optimised : {false, true}) {
            const auto shader = run(body, 0, optimised);
            EXPECT_EQ(shader->messages(), "") << body;
            for (size_t i = 0; i < shader->vertices(); ++i)
                EXPECT_NEAR(shader->at("r", i), value, tolerance) << body << " at vertex " << i;
        }
    }

    Scene scene_;
    Textures textures_{options_, &diagnostics_};
    std::string sky_;
};

const char* const kAll =
    "\"environment:color\", c, \"environment:direction\", d, \"environment:solidangle\", w";

TEST_F(SkyTurnsTest, SumToTheLightOfTheMap) {
    for (const char* samples : {"1", "2", "16", "100"}) {
        const std::string call = std::string("gather(sky, 0, 0, 0, ") + samples + ", " + kAll + ") ";
        expect(call + "r += comp(c, 0);", light(), 1e-3f * light());
        expect(call + "r += comp(c, 2); else r += 1000;", 3 * light(), 3e-3f * light());
        expect(call + "r += w;", kSphere, 1e-3f);
        expect(call + "{ r += 1; if (r > 4) break; }", std::min(std::stof(samples), 5.0f), 0);
    }
    expect(std::string("gather(sky, P, N, 1, s > 2 ? 3 : 5, ") + kAll + ") r += 1;", 5, 0);
    expect(std::string("gather(sky, P, N, 1, -3, ") + kAll + ") r += 1; else r += 1;", 0, 0);
    EXPECT_TRUE(reported_.empty());
}

/// The spot is a third of all light.
TEST_F(SkyTurnsTest, GoWhereTheLightIs) {
    const float share = 200 * (light() - kSphere) / 199 / light();
    const std::string spot =
        "vector m = vector (cos(PI * 5 / 8) * sin(PI * 5 / 16), sin(PI * 5 / 8) * sin(PI * 5 / 16),"
        " cos(PI * 5 / 16));";
    expect(spot + "gather(sky, 0, 0, 0, 200, \"environment:direction\", d) if (d . m > .9) r += 1 / 200;",
           share, 0.04f);
    expect(spot + "gather(sky, 0, 0, 0, 200, \"ray:direction\", d) if (d . m > .9) r += 1 / 200;", share,
           0.04f);
    expect(
        "gather(sky, 0, 0, 0, 20, \"ray:direction\", d, \"environment:direction\", e) r += abs(length(d) - 1) +"
        " abs(length(e) - 1);",
        0, 1e-4f);
}

/// Each vertex has rays of its own within the same parts, which are the same for each run, and others for
/// another seed.
TEST_F(SkyTurnsTest, RaysDifferFromVertexToVertex) {
    const std::string body =
        "gather(sky, 0, 0, 0, 4, \"ray:direction\", d, \"environment:direction\", e) { way += d; r += xcomp(e); }";
    const auto one = run(body), again = run(body), other = run(body, 5);
    int same = 0, same_elsewhere = 0;
    for (size_t i = 0; i < one->vertices(); ++i) {
        EXPECT_EQ(one->at("r", i), one->at("r", 0));
        EXPECT_EQ(one->at("way", i), again->at("way", i));
        same += i > 0 && one->at("way", i) == one->at("way", 0);
        same_elsewhere += one->at("way", i) == other->at("way", i);
    }
    EXPECT_EQ(same, 0);
    EXPECT_EQ(same_elsewhere, 0);
}

TEST_F(SkyTurnsTest, CountsMayVary) {
    const auto shader =
        run("gather(sky, 0, 0, 0, 1 + 4 * s, " + std::string(kAll) + ") { r += comp(c, 0); q += 1; }");
    for (size_t i = 0; i < shader->vertices(); ++i) {
        EXPECT_NEAR(shader->at("r", i), light(), 1e-3f * light());
        EXPECT_EQ(shader->at("q", i), std::floor(1 + 4 * shader->grid().s[i]));
    }
}

TEST_F(SkyTurnsTest, ReachTheVerticesThatAreThere) {
    const auto shader =
        run("if (s > .4) { gather(sky, 0, 0, 0, 3, " + std::string(kAll) + ") r += w; } q = w;");
    for (size_t i = 0; i < shader->vertices(); ++i) {
        const bool there = shader->grid().s[i] > 0.4f;
        EXPECT_NEAR(shader->at("r", i), there ? kSphere : 0, 1e-3f);
        EXPECT_EQ(shader->at("q", i) == 7, !there);
    }
}

TEST_F(SkyTurnsTest, WhatIsNotThereIsDark) {
    expect("gather(\"environment:\", 0, 0, 0, 4, \"environment:color\", c) r += 1; else r += 1;", 0, 0);
    EXPECT_TRUE(reported_.empty());
    expect("gather(\"environment:none.tx\", 0, 0, 0, 4, \"environment:color\", c) r += 1; else r += 1;", 0,
           0);
    ASSERT_EQ(reported_.size(), 1u);
    EXPECT_NE(to_string(reported_.front()).find("none.tx"), std::string::npos);
}

TEST_F(SkyTurnsTest, UnknownOutputsAreReported) {
    const auto shader = run("gather(sky, 0, 0, 0, 4, \"environment:color\", w, \"surface:Ci\", c) r += w;");
    EXPECT_EQ(shader->at("r", 0), 28);
    EXPECT_NE(shader->messages().find(
                  "warning: gather() of an environment knows no \"environment:color\" of this type: "
                  "it stays as it is"),
              std::string::npos)
        << shader->messages();
    EXPECT_NE(shader->messages().find("\"surface:Ci\""), std::string::npos);
}

}  // namespace
}  // namespace trapeze
