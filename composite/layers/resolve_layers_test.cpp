#include "composite/layers/resolve_layers.h"

#include <gtest/gtest.h>

#include "composite/film/raster_harness.h"

namespace trapeze {
namespace {

using testing::add_grids;
using testing::GridLook;

constexpr AxisRay kRay{3.25f, 5.5f, 0, 0, 0, 0};

const DepthRule kMidpoint{true};

uint64_t id_of(uint32_t grid) {
    return MicropolygonId{grid, 3, 5}.packed();
}

GridLook flat(V3f color, float depth, uint32_t primitive) {
    GridLook look;
    look.color = [color](int, int) { return color; };
    look.depth = depth;
    look.primitive = primitive;
    return look;
}

GridLook glass(V3f color, V3f opacity, float depth, uint32_t primitive) {
    GridLook look = flat(color, depth, primitive);
    look.opacity = [opacity](int, int) { return opacity; };
    return look;
}

void expect_rgba(const SampleColor& sample, float r, float g, float b, float a) {
    EXPECT_FLOAT_EQ(sample.rgba[0], r);
    EXPECT_FLOAT_EQ(sample.rgba[1], g);
    EXPECT_FLOAT_EQ(sample.rgba[2], b);
    EXPECT_FLOAT_EQ(sample.rgba[3], a);
}

TEST(ResolveLayers, NothingIsTransparentAndFar) {
    const SampleColor sample = resolve_layers(kRay, {}, Grids{});
    expect_rgba(sample, 0, 0, 0, 0);
    EXPECT_EQ(sample.depth, kInfinity);
    EXPECT_EQ(sample.primitive, ~uint32_t{0});
}

TEST(ResolveLayers, AnOpaqueHitHidesWhatFollows) {
    Grids grids;
    add_grids(grids, 1, 1, flat({1, 0.5f, 0.25f}, 2, 7));
    add_grids(grids, 1, 1, flat({0, 1, 0}, 3, 8));
    const Hit hits[] = {{2, id_of(0)}, {3, id_of(1)}};
    const SampleColor sample = resolve_layers(kRay, hits, grids);
    expect_rgba(sample, 1, 0.5f, 0.25f, 1);
    EXPECT_EQ(sample.depth, 2);
    EXPECT_EQ(sample.primitive, 7u);
}

TEST(ResolveLayers, DepthIsOfWhatIsOpaqueEnough) {
    Grids grids;
    add_grids(grids, 1, 1, glass({0, 0, 0}, {0.75f, 0.25f, 0.75f}, 2, 1));
    add_grids(grids, 1, 1, glass({0, 0, 0}, {0.5f, 0.5f, 0.5f}, 3, 2));
    add_grids(grids, 1, 1, flat({1, 1, 1}, 5, 3));
    const Hit hits[] = {{2, id_of(0)}, {3, id_of(1)}, {5, id_of(2)}};
    const auto depth = [&](const DepthRule& rule) { return resolve_layers(kRay, hits, grids, rule).depth; };
    EXPECT_EQ(depth({}), 2);
    EXPECT_EQ(depth({false, V3f(0.25f)}), 2);
    EXPECT_EQ(depth({false, V3f(0.5f)}), 3);
    EXPECT_EQ(depth({false, V3f(0.75f, 0, 0.75f)}), 2);
    EXPECT_EQ(depth({false, V3f(0.996f)}), 5);
    EXPECT_EQ(depth({true, V3f(0.5f)}), 4);
    // Whose it is and the colour do not depend on it.
    const SampleColor sample = resolve_layers(kRay, hits, grids, {false, V3f(0.996f)});
    EXPECT_EQ(sample.primitive, 1u);
    expect_rgba(sample, 0.125f, 0.375f, 0.125f, 1);
    EXPECT_EQ(resolve_layers(kRay, std::span(hits).first(2), grids, {false, V3f(0.996f)}).depth, kInfinity);
}

TEST(ResolveLayers, FrontToBackWithOpacityPerChannel) {
    Grids grids;
    add_grids(grids, 1, 1, glass({0.5f, 0, 0}, {0.5f, 0.25f, 0}, 2, 1));
    add_grids(grids, 1, 1, flat({0, 1, 1}, 3, 2));
    const Hit hits[] = {{2, id_of(0)}, {3, id_of(1)}};
    expect_rgba(resolve_layers(kRay, hits, grids), 0.5f, 0.75f, 1, 1);
    expect_rgba(resolve_layers(kRay, std::span(hits).first(1), grids), 0.5f, 0, 0, 0.25f);
    const Hit reversed[] = {{3, id_of(1)}, {4, id_of(0)}};
    expect_rgba(resolve_layers(kRay, reversed, grids), 0, 1, 1, 1);
}

TEST(ResolveLayers, MatteHoldsOut) {
    Grids grids;
    GridLook matte = glass({0.25f, 0.25f, 0.25f}, {0.25f, 0.25f, 0.25f}, 2, 1);
    matte.matte = 1;
    add_grids(grids, 1, 1, matte);
    add_grids(grids, 1, 1, flat({1, 1, 1}, 3, 2));
    GridLook wall = flat({9, 9, 9}, 1, 3);
    wall.matte = 1;
    add_grids(grids, 1, 1, wall);
    const Hit through[] = {{2, id_of(0)}, {3, id_of(1)}};
    const SampleColor seen = resolve_layers(kRay, through, grids);
    expect_rgba(seen, 0.75f, 0.75f, 0.75f, 0.75f);
    EXPECT_EQ(seen.depth, 3);
    EXPECT_EQ(seen.primitive, 2u);
    const Hit behind[] = {{1, id_of(2)}, {3, id_of(1)}};
    const SampleColor hidden = resolve_layers(kRay, behind, grids);
    expect_rgba(hidden, 0, 0, 0, 0);
    EXPECT_EQ(hidden.depth, kInfinity);
}

TEST(ResolveLayers, Matte2KeepsItsAlpha) {
    Grids grids;
    GridLook matte = glass({0.25f, 0.25f, 0.25f}, {0.25f, 0.25f, 0.25f}, 2, 1);
    matte.matte = 2;
    add_grids(grids, 1, 1, matte);
    add_grids(grids, 1, 1, flat({1, 1, 1}, 3, 2));
    const Hit hits[] = {{2, id_of(0)}, {3, id_of(1)}};
    expect_rgba(resolve_layers(kRay, hits, grids), 0.75f, 0.75f, 0.75f, 1);
    expect_rgba(resolve_layers(kRay, std::span(hits).first(1), grids), 0, 0, 0, 0.25f);
}

TEST(ResolveLayers, MidpointsLieBetweenTheFirstTwoLayers) {
    Grids grids;
    GridLook held = flat({9, 9, 9}, 1, 5);
    held.matte = 1;
    add_grids(grids, 1, 1, glass({0, 0, 0}, {0, 0, 0}, 1, 1));
    add_grids(grids, 1, 1, flat({1, 0.5f, 0}, 2, 2));
    add_grids(grids, 1, 1, flat({0, 1, 0}, 5, 3));
    add_grids(grids, 1, 1, flat({0, 0, 1}, 9, 4));
    add_grids(grids, 1, 1, held);
    const Hit hits[] = {{1, id_of(0)}, {2, id_of(1)}, {5, id_of(2)}, {9, id_of(3)}};
    const SampleColor sample = resolve_layers(kRay, hits, grids, kMidpoint);
    EXPECT_EQ(sample.depth, 3.5f);
    EXPECT_EQ(sample.primitive, 2u);
    expect_rgba(sample, 1, 0.5f, 0, 1);
    EXPECT_EQ(resolve_layers(kRay, std::span(hits).first(2), grids, kMidpoint).depth, kInfinity);
    EXPECT_EQ(resolve_layers(kRay, std::span(hits).first(1), grids, kMidpoint).depth, kInfinity);
    const Hit behind_matte[] = {{1, id_of(4)}, {2, id_of(1)}, {5, id_of(2)}};
    EXPECT_EQ(resolve_layers(kRay, behind_matte, grids, kMidpoint).depth, 3.5f);
}

TEST(ResolveLayers, AWhollyTransparentLayerHasNoDepth) {
    Grids grids;
    add_grids(grids, 1, 1, glass({0, 0, 0}, {0, 0, 0}, 2, 1));
    add_grids(grids, 1, 1, flat({1, 0, 0}, 3, 2));
    const Hit hits[] = {{2, id_of(0)}, {3, id_of(1)}};
    const SampleColor sample = resolve_layers(kRay, hits, grids);
    EXPECT_EQ(sample.depth, 3);
    EXPECT_EQ(sample.primitive, 2u);
}

TEST(ResolveLayers, ConstantTakesVertex00AndSmoothInterpolates) {
    GridLook ramp;
    ramp.color = [](int x, int y) { return V3f(static_cast<float>(x), static_cast<float>(y), 1); };
    Grids grids;
    add_grids(grids, 1, 1, ramp);
    ramp.smooth = true;
    add_grids(grids, 1, 1, ramp);
    const Hit constant[] = {{1, id_of(0)}}, smooth[] = {{1, id_of(1)}};
    expect_rgba(resolve_layers(kRay, constant, grids), 3, 5, 1, 1);
    expect_rgba(resolve_layers(kRay, smooth, grids), 3.25f, 5.5f, 1, 1);
}

TEST(ResolveLayers, SmoothFollowsAMovingGrid) {
    Grids grids;
    GridArena arena;
    Grid grid;
    grid.shape = {1, 1};
    grid.key_count = 2;
    grid.smooth = true;
    arena.allocate(grid);
    for (int j = 0; j < 2; ++j)
        for (int i = 0; i < 2; ++i) {
            const int at = grid.shape.tiled_index(i, j);
            const float start[] = {
                static_cast<float>(i), static_cast<float>(j), 1, 2, 0, 0};  // moves by 2 along x
            for (int k = 0; k < 6; ++k) grid.plane(0, k)[at] = start[k];
            for (int c = 0; c < 3; ++c)
                grid.half_colors()[c * 4 + grid.shape.row_index(i, j)] = static_cast<float>(i);
        }
    grids.grids.push_back(grid);
    const Hit hits[] = {{1, MicropolygonId{0, 0, 0}.packed()}};
    expect_rgba(resolve_layers({0.75f, 0.5f, 0, 0, 0, 0}, hits, grids), 0.75f, 0.75f, 0.75f, 1);
    expect_rgba(resolve_layers({1.5f, 0.5f, 0, 0, 0, 0.5f}, hits, grids), 0.5f, 0.5f, 0.5f, 1);
}

/// A colour and a float.
AovLayout color_and_float() {
    return {{{"foo", 3, 0}, {"bar", 1, 3}}, 4};
}

GridLook with_values(GridLook look, std::array<float, 4> values) {
    look.aov_channels = 4;
    look.aov = [values](int, int, int channel) { return values[channel]; };
    return look;
}

std::array<float, 4> values_of(std::span<const Hit> hits, const Grids& grids) {
    std::array<float, 4> values{-1, -1, -1, -1};
    resolve_aovs(kRay, hits, grids, color_and_float(), values.data());
    return values;
}

TEST(ResolveAovs, LayersAreAddedAsColoursAreAndFloatsByTheMeanOpacity) {
    Grids grids;
    add_grids(grids, 1, 1, with_values(glass({0.5f, 0, 0}, {0.5f, 0.25f, 0}, 2, 1), {1, 2, 3, 4}));
    add_grids(grids, 1, 1, with_values(flat({0, 1, 1}, 3, 2), {10, 20, 30, 40}));
    add_grids(grids, 1, 1, with_values(flat({1, 1, 1}, 4, 3), {100, 100, 100, 100}));
    const Hit hits[] = {{2, id_of(0)}, {3, id_of(1)}, {4, id_of(2)}};
    // What passes the first layer is 1/2, 3/4 and 1: in the mean 3/4. The second hides the third.
    EXPECT_EQ(values_of(hits, grids), (std::array<float, 4>{1 + 5, 2 + 15, 3 + 30, 4 + 30}));
    EXPECT_EQ(values_of(std::span(hits).subspan(1), grids), (std::array<float, 4>{10, 20, 30, 40}));
    EXPECT_EQ(values_of({}, grids), (std::array<float, 4>{0, 0, 0, 0}));
}

TEST(ResolveAovs, LayersThatShowNothingAddNothing) {
    Grids grids;
    GridLook matte = glass({1, 1, 1}, {0.5f, 0.5f, 0.5f}, 1, 1);
    matte.matte = 1;
    add_grids(grids, 1, 1, with_values(matte, {1000, 1000, 1000, 1000}));
    add_grids(grids, 1, 1, with_values(glass({0, 0, 0}, {0, 0, 0}, 2, 1), {100, 100, 100, 100}));
    add_grids(grids, 1, 1, flat({1, 1, 1}, 3, 2));  // carries no values
    const Hit seen[] = {{1, id_of(0)}, {2, id_of(1)}, {3, id_of(2)}};
    EXPECT_EQ(values_of(seen, grids), (std::array<float, 4>{0, 0, 0, 0}));
    add_grids(grids, 1, 1, with_values(flat({0, 0, 0}, 3, 2), {8, 4, 2, 1}));  // black, but there
    const Hit held_out[] = {{1, id_of(0)}, {2, id_of(1)}, {3, id_of(3)}};
    EXPECT_EQ(values_of(held_out, grids), (std::array<float, 4>{4, 2, 1, 0.5f}));
}

TEST(ResolveAovs, AConstantMicropolygonHasItsFirstVertexsValueASmoothOneInterpolates) {
    GridLook look = flat({1, 1, 1}, 1, 0);
    look.aov_channels = 4;
    look.aov = [](int x, int y, int channel) { return static_cast<float>(x + 2 * y + channel); };
    Grids grids;
    add_grids(grids, 1, 1, look);
    look.smooth = true;
    add_grids(grids, 1, 1, look);
    const Hit constant[] = {{1, id_of(0)}}, smooth[] = {{1, id_of(1)}};
    const std::array<float, 4> held = values_of(constant, grids), varying = values_of(smooth, grids);
    for (int c = 0; c < 4; ++c) {
        EXPECT_EQ(held[c], static_cast<float>(3 + 2 * 5 + c));
        EXPECT_FLOAT_EQ(varying[c], 3.25f + 2 * 5.5f + static_cast<float>(c));  // linear in x and y
    }
}

}  // namespace
}  // namespace trapeze
