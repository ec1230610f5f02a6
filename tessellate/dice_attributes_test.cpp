/// Attributes that change how surfaces are diced: "dice", and the factors of GeometricApproximation.
#include <gtest/gtest.h>

#include <bit>
#include <cmath>

#include "tessellate/test_scene.h"

namespace trapeze {
namespace {

using test::DicedScene;
using test::TestScene;
using test::translation;

/// A square of 2 x 2 at z = 4, where the picture is 8 high: 100 x 100 pixels.
struct Square {
    TestScene scene;

    explicit Square(float turned_degrees = 0, float moved = 0) {
        scene.scene.options.width = scene.scene.options.height = 400;
        PatchMesh mesh;
        ParameterList variables;
        variables.set(test::parameter("P", StorageClass::Vertex, ValueType::Point,
                                      {-1, -1, 0, 1, -1, 0, -1, 1, 0, 1, 1, 0}));
        const double angle = turned_degrees * M_PI / 180;
        M44f turned;
        turned[0][0] = turned[2][2] = static_cast<float>(std::cos(angle));
        turned[0][2] = static_cast<float>(std::sin(angle));
        turned[2][0] = -turned[0][2];
        std::vector<M44f> keys{turned * translation(0, 0, 4)};
        if (moved != 0) keys.push_back(turned * translation(moved, 0, 4));
        scene.add({test::shape_of(mesh, variables)}, keys);
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

}  // namespace
}  // namespace trapeze
