#include <gmock/gmock.h>

#include "shade/maps/map_files_harness.h"

namespace trapeze {
namespace {

using OIIO::ImageSpec;
using OIIO::TypeDesc;

constexpr float kNothing = 3.4028235e38f;

class ShadowLookupTest : public MapFilesTest {
  protected:
    static constexpr int kSize = 64;

    std::string depth_map(const std::string& name, bool perspective,
                          const std::function<float(int, int)>& depth,
                          const M44f& camera_from_world = M44f()) {
        return write_depth_map(name, kSize, perspective, depth, camera_from_world);
    }
    /// Something at depth 5 in the left half.
    std::string half(const M44f& camera_from_world = M44f()) {
        return depth_map(
            "half.tif", false, [](int x, int) { return x < kSize / 2 ? 5.0f : kNothing; }, camera_from_world);
    }
    float hidden(const std::string& file, const V3f& P, MapOptions options = {}, const V3f& dPdu = V3f(0),
                 const V3f& dPdv = V3f(0), const M44f& camera_from_world = M44f()) {
        const Plane out = plane(kLanes, -1);
        const auto triple = [&](const V3f& v) {
            return ConstPlane3(plane({v.x}), plane({v.y}), plane({v.z}));
        };
        textures_.shadow(textures_.find_shadow(file, {}), {triple(P), triple(dPdu), triple(dPdv)},
                         camera_from_world, options, {1, {}}, out);
        return out[0];
    }
    static MapOptions blurred(float blur, float samples) {
        MapOptions options;
        options.sblur = options.tblur = blur, options.samples = samples;
        return options;
    }

    Textures textures_{options_, &diagnostics_};
};

TEST_F(ShadowLookupTest, WhatIsBehindIsHidden) {
    const std::string file = half();
    EXPECT_EQ(hidden(file, V3f(-0.5f, 0, 10)), 1);
    EXPECT_EQ(hidden(file, V3f(0.5f, 0, 10)), 0);
    EXPECT_EQ(hidden(file, V3f(-0.5f, 0, 3)), 0);
    EXPECT_EQ(hidden(file, V3f(-0.5f, 0, 5)), 0);
    EXPECT_EQ(hidden(file, V3f(-1.5f, 0, 10)), 0) << "outside the map";
    EXPECT_EQ(hidden(file, V3f(-0.5f, 0, -3)), 0) << "behind its camera";
    EXPECT_TRUE(reported_.empty());
}

TEST_F(ShadowLookupTest, YPointsUpThePicture) {
    const std::string file =
        depth_map("top.tif", true, [](int, int y) { return y < kSize / 2 ? 5.0f : kNothing; });
    EXPECT_EQ(hidden(file, V3f(0, 4, 10)), 1);
    EXPECT_EQ(hidden(file, V3f(0, -4, 10)), 0);
}

TEST_F(ShadowLookupTest, EdgesAreAsWideAsTheBlur) {
    const std::string file = half();
    // A region of a quarter of the map whose middle is right of the edge by a 32nd of the map.
    const float expected = (0.125f - 0.03125f) / 0.25f;
    EXPECT_NEAR(hidden(file, V3f(0.0625f, 0, 10), blurred(0.25f, 1024)), expected, 1.0f / 32);
    EXPECT_NEAR(hidden(file, V3f(0, 0, 10), blurred(0.25f, 256)), 0.5f, 1.0f / 16);
    EXPECT_EQ(hidden(file, V3f(0.3f, 0, 10), blurred(0.25f, 256)), 0);
    EXPECT_EQ(hidden(file, V3f(-0.3f, 0, 10), blurred(0.25f, 256)), 1);
}

TEST_F(ShadowLookupTest, TheRegionIsTheMicropolygonTimesWidth) {
    const std::string file = half();
    MapOptions options = blurred(0, 1024);
    options.swidth = options.twidth = 2;
    const V3f dPdu(0.25f, 0, 0), dPdv(0, 0.25f, 0);  // an eighth of the map
    const float expected = (0.125f - 0.03125f) / 0.25f;
    EXPECT_NEAR(hidden(file, V3f(0.0625f, 0, 10), options, dPdu, dPdv), expected, 1.0f / 32);
}

TEST_F(ShadowLookupTest, AtLeastATexelIsLookedAt) {
    const std::string file = half();
    const float texel = 2.0f / kSize;
    EXPECT_NEAR(hidden(file, V3f(0.25f * texel, 0, 10), blurred(0, 1024)), 0.25f, 1.0f / 32);
}

TEST_F(ShadowLookupTest, SlantedPlanesDoNotShadowThemselves) {
    // z = 5 + 2 x; and, in perspective, z = 5 + x, seen at x / z = X where z = 5 / (1 - X).
    const std::string flat = depth_map("flat.tif", false, [](int x, int) {
        return 5 + 2 * ((static_cast<float>(x) + 0.5f) / (kSize / 2) - 1);
    });
    const std::string deep = depth_map("deep.tif", true, [](int x, int) {
        return 5 / (1.0001f - ((static_cast<float>(x) + 0.5f) / (kSize / 2) - 1));
    });
    for (const float x : {-0.4f, 0.0f, 0.31f}) {
        EXPECT_EQ(
            hidden(flat, V3f(x, 0.1f, 5 + 2 * x), blurred(0.1f, 64), V3f(0.1f, 0, 0.2f), V3f(0, 0.1f, 0)), 0);
        EXPECT_EQ(hidden(deep, V3f(x, 0.1f, 5 + x), blurred(0.1f, 64), V3f(0.1f, 0, 0.1f), V3f(0, 0.1f, 0)),
                  0);
        EXPECT_GT(hidden(flat, V3f(x, 0.1f, 5 + 2 * x), blurred(0.1f, 64)), 0.2f) << "without its slant";
    }
    // What is behind the plane is hidden.
    EXPECT_EQ(hidden(flat, V3f(0, 0.1f, 6), blurred(0.1f, 64), V3f(0.1f, 0, 0.2f), V3f(0, 0.1f, 0)), 1);
}

TEST_F(ShadowLookupTest, BiasIsTheShadersThenTheRenders) {
    const std::string file = half();
    MapOptions options;
    const V3f behind(-0.5f, 0, 5.5f);
    EXPECT_EQ(hidden(file, behind, options), 1);
    options.bias = 1;
    EXPECT_EQ(hidden(file, behind, options), 0);
    options.bias = 0.25f;
    EXPECT_EQ(hidden(file, behind, options), 1);

    options_.user.set("shadow", {"bias", {StorageClass::Uniform, ValueType::Float, 1}, {1}, {}});
    Textures biased(options_, &diagnostics_);
    const Plane out = plane(kLanes, -1);
    biased.shadow(biased.find_shadow(file, {}), {{plane({-0.5f}), {}, plane({5.5f})}, {}, {}}, M44f(), {},
                  {1, {}}, out);
    EXPECT_EQ(out[0], 0);
}

TEST_F(ShadowLookupTest, PointsAreOfTheCurrentCamera) {
    // The map's camera is at (3, 0, 0) of world, the current one at (0, 0, -7).
    M44f map_from_world, camera_from_world;
    map_from_world.setTranslation(V3f(-3, 0, 0)), camera_from_world.setTranslation(V3f(0, 0, 7));
    const std::string file = half(map_from_world);
    EXPECT_EQ(hidden(file, V3f(2.5f, 0, 17), {}, V3f(0), V3f(0), camera_from_world), 1);
    EXPECT_EQ(hidden(file, V3f(3.5f, 0, 17), {}, V3f(0), V3f(0), camera_from_world), 0);
    EXPECT_EQ(hidden(file, V3f(2.5f, 0, 10), {}, V3f(0), V3f(0), camera_from_world), 0);
}

TEST_F(ShadowLookupTest, IsTheSameWheneverItIsAsked) {
    const std::string file = half();
    const float first = hidden(file, V3f(0.01f, 0.2f, 10), blurred(0.3f, 5));
    hidden(file, V3f(0.3f, 0.2f, 10), blurred(0.3f, 5));
    EXPECT_EQ(hidden(file, V3f(0.01f, 0.2f, 10), blurred(0.3f, 5)), first);
}

TEST_F(ShadowLookupTest, FilesThatAreNoDepthMapsAreReportedOnceAndHideNothing) {
    const std::string plain =
        write("plain.tif", ImageSpec(8, 8, 1, TypeDesc::FLOAT), [](int, int, int) { return 1.0f; });
    EXPECT_EQ(hidden(plain, V3f(0, 0, 10)), 0);
    EXPECT_EQ(hidden(plain, V3f(0, 0, 10)), 0);
    ASSERT_EQ(reported_.size(), 1u);
    EXPECT_NE(reported_[0].text.find("worldtocamera"), std::string::npos) << reported_[0].text;
    EXPECT_EQ(hidden("nowhere.tif", V3f(0, 0, 10)), 0);
    EXPECT_EQ(hidden("nowhere.tif", V3f(0, 0, 10)), 0);
    EXPECT_EQ(reported_.size(), 2u);
}

TEST_F(ShadowLookupTest, NumbersThatAreNoneAreHarmless) {
    const std::string file = half();
    MapOptions options;
    options.samples = std::nanf(""), options.sblur = -3;
    EXPECT_GE(hidden(file, V3f(std::nanf(""), INFINITY, 10), options), 0);
    EXPECT_EQ(hidden(file, V3f(1e30f, 1e30f, 1e30f)), 0);
}

}  // namespace
}  // namespace trapeze
