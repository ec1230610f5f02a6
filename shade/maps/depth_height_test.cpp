#include <gmock/gmock.h>

#include "shade/maps/map_files_harness.h"

namespace trapeze {
namespace {

constexpr int kSize = 16;

class DepthHeightTest : public MapFilesTest {
  protected:
    /// depth(x, y) from -1 to 1, y up.
    std::string depth_map(const std::string& name, bool perspective,
                          const std::function<float(float x, float y)>& depth,
                          const M44f& camera_from_world = M44f()) {
        const auto at_pixel = [&](int x, int y) {
            const auto middle = [](int pixel) {
                return (static_cast<float>(pixel) + 0.5f) / (kSize / 2) - 1;
            };
            return depth(middle(x), -middle(y));
        };
        return write_depth_map(name, kSize, perspective, at_pixel, camera_from_world);
    }

    Textures textures_{options_, &diagnostics_};
};

TEST_F(DepthHeightTest, IsTheDistanceAlongTheMapsView) {
    const std::string file =
        depth_map("step.tif", false, [](float x, float) { return x < 0 ? 5.0f : 1e30f; });
    const DepthHeight height = textures_.height_over(file, {}, M44f());
    ASSERT_TRUE(height);
    EXPECT_FLOAT_EQ(height({-0.5f, 0.2f, 3}), 2);
    EXPECT_FLOAT_EQ(height({-0.5f, 0.2f, 7}), -2) << "below";
    EXPECT_GE(height({0.5f, 0, 3}), kInfinity / 2) << "nothing there";
    EXPECT_EQ(height({-1.5f, 0, 3}), kInfinity) << "outside the map";
    EXPECT_EQ(height({-0.5f, 0, -3}), kInfinity) << "behind its camera";
    EXPECT_TRUE(reported_.empty());
}

TEST_F(DepthHeightTest, IsExactOverPlanes) {
    const std::string flat = depth_map("flat.tif", false, [](float x, float y) { return 5 + 2 * x - y; });
    // The plane z = 5 + x - y, seen at (X, Y) = (x, y) / z.
    const std::string deep =
        depth_map("deep.tif", true, [](float x, float y) { return 5 / (1 - 0.4f * x + 0.2f * y); });
    const DepthHeight over_flat = textures_.height_over(flat, {}, M44f());
    const DepthHeight over_deep = textures_.height_over(deep, {}, M44f());
    ASSERT_TRUE(over_flat && over_deep);
    for (const float x : {-0.71f, 0.033f, 0.4f})
        for (const float y : {-0.5f, 0.12f}) {
            EXPECT_NEAR(over_flat({x, y, 4}), 1 + 2 * x - y, 1e-4f);
            // The ray through (x, y, 1) * 3 meets the plane at depth 5 / (1 - 0.4 x + 0.2 y).
            EXPECT_NEAR(over_deep({3 * x, 3 * y, 3}), 5 / (1 - 0.4f * x + 0.2f * y) - 3, 1e-4f);
        }
}

TEST_F(DepthHeightTest, MapsStandInTheWorld) {
    // The map's camera stands at world (0, 10, 0) and looks down: its z is world -y, its y is world z.
    const M44f map_from_world(1, 0, 0, 0, 0, 0, -1, 0, 0, 1, 0, 0, 0, 0, 10, 1);
    const std::string file = depth_map(
        "down.tif", false, [](float, float) { return 9.0f; }, map_from_world);  // world y = 1
    M44f camera_from_world;
    camera_from_world.translate(V3f(0, 0, 20));
    const DepthHeight height = textures_.height_over(file, {}, camera_from_world);
    ASSERT_TRUE(height);
    EXPECT_NEAR(height({0.5f, 1.25f, 20.5f}), 0.25f, 1e-5f);
    EXPECT_NEAR(height({0.5f, 0.5f, 20.5f}), -0.5f, 1e-5f);
}

TEST_F(DepthHeightTest, MissingFilesAreReportedOnce) {
    EXPECT_FALSE(textures_.height_over(path("none.tif"), {}, M44f()));
    EXPECT_FALSE(textures_.height_over(path("none.tif"), {}, M44f()));
    EXPECT_FALSE(textures_.height_over("", {}, M44f()));
    ASSERT_EQ(reported_.size(), 1u);
    EXPECT_THAT(reported_[0].text, ::testing::HasSubstr("none.tif"));
}

}  // namespace
}  // namespace trapeze
