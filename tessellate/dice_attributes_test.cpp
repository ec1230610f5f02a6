/// Attributes that change how surfaces are diced: "dice", and the factors of GeometricApproximation.
#include <gtest/gtest.h>

#include <array>
#include <bit>
#include <cmath>

#include "tessellate/dicing_harness.h"

namespace trapeze {
namespace {

using testing::DicedScene;
using testing::TestScene;
using testing::translation;

/// A square of 2 x 2 at z = 4, where the picture is 8 high: 100 x 100 pixels.
struct Square {
    TestScene scene;

    explicit Square(float turned_degrees = 0, float moved = 0) {
        scene.scene.options.width = scene.scene.options.height = 400;
        PatchMesh mesh;
        ParameterList variables;
        variables.set(testing::parameter("P", StorageClass::Vertex, ValueType::Point,
                                         {-1, -1, 0, 1, -1, 0, -1, 1, 0, 1, 1, 0}));
        const double angle = turned_degrees * M_PI / 180;
        M44f turned;
        turned[0][0] = turned[2][2] = static_cast<float>(std::cos(angle));
        turned[0][2] = static_cast<float>(std::sin(angle));
        turned[2][0] = -turned[0][2];
        std::vector<M44f> keys{turned * translation(0, 0, 4)};
        if (moved != 0) keys.push_back(turned * translation(moved, 0, 4));
        scene.add({testing::shape_of(mesh, variables)}, keys);
    }
    uint64_t micropolygons() { return DicedScene(scene).stats.micropolygons; }
};

TEST(DiceAttributes, BinaryRatesArePowersOfTwo) {
    Square plain, binary;
    plain.scene.attributes->shading_rate = 2;
    binary.scene.attributes->shading_rate = 2;
    binary.scene.attributes->dice.binary = true;
    const auto all_binary = [](const std::vector<Grid>& grids) {
        for (const Grid& grid : grids)
            if (!std::has_single_bit(static_cast<unsigned>(grid.shape.nu)) ||
                !std::has_single_bit(static_cast<unsigned>(grid.shape.nv)))
                return false;
        return true;
    };
    const DicedScene binary_grids(binary.scene), plain_grids(plain.scene);
    EXPECT_TRUE(all_binary(binary_grids.grids));
    EXPECT_FALSE(all_binary(plain_grids.grids));
    EXPECT_GE(binary_grids.stats.micropolygons, plain_grids.stats.micropolygons);
}

TEST(DiceAttributes, WithoutRasterOrientationForeshorteningDoesNotCount) {
    Square turned(60), square_on(60);
    square_on.scene.attributes->dice.raster_oriented = false;
    // Turned by 60 degrees the square is half as wide on the picture, and as wide as ever without.
    const auto seen = static_cast<double>(turned.micropolygons());
    const auto whole = static_cast<double>(square_on.micropolygons());
    EXPECT_GT(whole, 1.5 * seen);
    EXPECT_LT(whole, 2.6 * seen);
    EXPECT_GT(whole, 0.9 * 100 * 100);
}

TEST(DiceAttributes, MotionCoarsensByItsFactor) {
    Square still, moving(0, 0.64f), sharp(0, 0.64f);
    moving.scene.attributes->motion_factor = 1.5f;
    still.scene.attributes->motion_factor = 1.5f;
    EXPECT_EQ(still.micropolygons(), sharp.micropolygons());
    // It moves by 32 pixels: a rate of 1 + 1.5 * 32 / 16 = 4.
    EXPECT_NEAR(static_cast<double>(sharp.micropolygons()) / static_cast<double>(moving.micropolygons()), 4,
                0.6);
}

TEST(DiceAttributes, DefocusCoarsensByItsFactor) {
    Square sharp, blurred;
    for (Square* square : {&sharp, &blurred}) {
        Options& options = square->scene.scene.options;
        options.f_stop = 1, options.focal_length = 0.2f, options.focal_distance = 2;
        square->scene.attributes->focus_factor = square == &blurred ? 2.0f : 0.0f;
    }
    const float width = 2 * blurred.scene.context().camera.circle_of_confusion(4).x;
    ASSERT_GT(width, 8);
    EXPECT_NEAR(static_cast<double>(sharp.micropolygons()) / static_cast<double>(blurred.micropolygons()),
                1 + 2 * width / 16, 0.15 * (1 + 2 * width / 16));
}

/// A floor 1 below the eye, from z = `from` to `to`, `half_width` to both sides of the middle of the picture.
/// 200 pixels are a unit of the image plane.
struct Floor {
    TestScene scene;

    explicit Floor(float from, float to, float half_width) {
        scene.scene.options.width = scene.scene.options.height = 400;
        PatchMesh mesh;
        ParameterList variables;
        variables.set(testing::parameter(
            "P", StorageClass::Vertex, ValueType::Point,
            {-half_width, -1, from, half_width, -1, from, -half_width, -1, to, half_width, -1, to}));
        scene.add(testing::shape_of(mesh, variables), M44f());
    }
    double micropolygons() { return static_cast<double>(DicedScene(scene).stats.micropolygons); }
};

/// 10 to 20 pixels below the horizon a pixel is seen 10 to 20 times foreshortened.
TEST(DiceAttributes, FloorsFarAwayHaveAMicropolygonForAPixel) {
    Floor floor(10, 20, 0.5f), square_on(10, 20, 0.5f), displaced(10, 20, 0.5f);
    // From 5 to 10 pixels to both sides, 10 pixels high.
    const double pixels = 15 * 10;
    EXPECT_GE(floor.micropolygons(), pixels);
    EXPECT_LT(floor.micropolygons(), 2.2 * pixels);
    // Where displacement may raise it, four times foreshortened at the most.
    displaced.scene.attributes->displacement = std::make_shared<ShaderInstance>();
    EXPECT_GT(displaced.micropolygons(), 2.5 * floor.micropolygons());
    square_on.scene.attributes->dice.raster_oriented = false;
    EXPECT_GT(square_on.micropolygons(), 8 * floor.micropolygons());
}

/// Lines that lead to the horizon are seen to cross those along it at a slant everywhere but in the middle.
TEST(DiceAttributes, SlantedMicropolygonsAreLongerInstead) {
    Floor floor(10, 40, 40), middle(10, 40, 0.2f);
    // 200 pixels to both sides, 5 to 20 pixels below the horizon. By lengths alone there were 15 times more.
    EXPECT_LT(floor.micropolygons(), 5 * 400 * 15);
    EXPECT_GE(middle.micropolygons(), 5 * 15);
}

/// A sheet that leads away from the eye at first, and faces it when the shutter closes.
TEST(DiceAttributes, WhatTurnsToTheViewerIsDicedForIt) {
    const auto turned = [](float degrees) {
        const double angle = degrees * M_PI / 180;
        M44f m;
        m[1][1] = m[2][2] = static_cast<float>(std::cos(angle));
        m[1][2] = static_cast<float>(std::sin(angle));
        m[2][1] = -m[1][2];
        return m * translation(0, 0, 4);
    };
    const auto count = [&](std::vector<M44f> keys) {
        Square square;
        square.scene.scene.primitives.front().camera_from_object = keys;
        return static_cast<double>(square.micropolygons());
    };
    const double still = count({turned(89)}), turning = count({turned(89), turned(60)});
    EXPECT_GT(turning, 3 * still);
}

/// A ball's outline is as round as it was when its micropolygons were four pixels long there.
TEST(DiceAttributes, SilhouettesAreSmooth) {
    TestScene scene;
    scene.scene.options.width = scene.scene.options.height = 400;
    scene.add(testing::shape_of(testing::quadric(Quadric::Kind::Sphere, {1, -1, 1, 360})),
              translation(0, 0, 5));
    const DicedScene diced(scene);
    const RenderContext context = scene.context();
    // The outline's radius: 200 pixels times the tangent of asin(1 / 5).
    const double radius = 200 / std::sqrt(24.0);
    std::array<double, 256> farthest{};
    for (const Grid& grid : diced.grids)
        for (int j = 0; j < grid.shape.nv; ++j)
            for (int i = 0; i < grid.shape.nu; ++i) {
                // Along all four sides.
                const Quad quad = grid.quad(i, j, 0);
                for (const auto& [from, to] : {std::pair{0, 1}, {1, 3}, {3, 2}, {2, 0}})
                    for (int step = 0; step < 16; ++step) {
                        const float w = static_cast<float>(step) / 16;
                        const V3f p((1 - w) * quad.x[from] + w * quad.x[to],
                                    (1 - w) * quad.y[from] + w * quad.y[to],
                                    (1 - w) * quad.z[from] + w * quad.z[to]);
                        const V2f at = context.camera.raster_from_camera(p) - V2f(200, 200);
                        const double angle = std::atan2(static_cast<double>(at.y), static_cast<double>(at.x));
                        const auto place = static_cast<size_t>((angle / M_PI + 1) * 127.99);
                        farthest[place] = std::max(farthest[place], static_cast<double>(at.length()));
                    }
            }
    for (const double r : farthest) EXPECT_NEAR(r, radius, 0.08);
}

/// What doubles its size is left as it is; a square that begins a hundredth as large has at least a fourth as
/// many micropolygons as when it stands still in its full size.
TEST(DiceAttributes, WhatGrowsIsDicedForHowLargeItBecomes) {
    const auto scaled = [](float scale) {
        M44f m;
        for (int k = 0; k < 3; ++k) m[k][k] = scale;
        return m * translation(0, 0, 4);
    };
    const auto count = [&](float open, float close) {
        Square square;
        square.scene.scene.primitives.front().camera_from_object = {scaled(open), scaled(close)};
        return square.micropolygons();
    };
    Square still;
    const uint64_t whole = still.micropolygons();
    EXPECT_EQ(count(1, 2), count(1, 1));
    EXPECT_EQ(count(1, 0.01f), count(1, 1)) << "what shrinks was large";
    EXPECT_GE(4 * count(0.01f, 1), whole);
    EXPECT_LE(count(0.01f, 1), whole);
    EXPECT_LE(count(1e-4f, 1e6f), 100 * whole) << "no finer than the picture is large";
}

}  // namespace
}  // namespace trapeze
