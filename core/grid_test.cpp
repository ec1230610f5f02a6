#include "core/grid.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <set>

#include "core/scene/scene.h"
#include "core/scene/shading_grid.h"

namespace trapeze {
namespace {

/// A shaded grid of known numbers: P at a key is (i, j, key) plus a tenth of the row number.
struct Shaded {
    Primitive primitive;
    std::shared_ptr<Attributes> attributes = std::make_shared<Attributes>();
    ShadingGrid grid;

    Shaded(int nu, int nv, int keys) {
        primitive.attributes = attributes;
        grid.shape = {static_cast<uint8_t>(nu), static_cast<uint8_t>(nv)};
        grid.key_count = keys;
        grid.primitive = &primitive;
        grid.primitive_index = 3;
        grid.ordinal = 77;
        const size_t n = grid.vertex_count();
        grid.P.resize(keys);
        for (int key = 0; key < keys; ++key) {
            grid.P[key].resize(n);
            for (int j = 0; j <= nv; ++j)
                for (int i = 0; i <= nu; ++i)
                    grid.P[key].set(grid.shape.row_index(i, j), expected(i, j, key));
        }
        grid.Ci.resize(n), grid.Oi.resize(n);
        for (size_t i = 0; i < n; ++i)
            grid.Ci.set(i, V3f(0.25f * static_cast<float>(i % 4), 0.5f, 1)), grid.Oi.set(i, V3f(1));
    }
    static V3f expected(int i, int j, int key) {
        return {static_cast<float>(i) + 0.125f * static_cast<float>(key * j), static_cast<float>(j),
                2 + static_cast<float>(key * key)};
    }
    Grid pack(GridArena& arena, int64_t* not_finite) { return pack_grid(grid, arena, not_finite); }
};

TEST(GridShape, TiledIndicesAreAllDifferentAndInThePlane) {
    for (int nu = 1; nu <= kMaxGridSide; ++nu)
        for (int nv = 1; nv <= kMaxGridSide; ++nv) {
            const GridShape shape{static_cast<uint8_t>(nu), static_cast<uint8_t>(nv)};
            std::set<int> seen;
            for (int j = 0; j <= nv; ++j)
                for (int i = 0; i <= nu; ++i) seen.insert(shape.tiled_index(i, j));
            ASSERT_EQ(seen.size(), static_cast<size_t>(shape.vertex_count()));
            ASSERT_GE(*seen.begin(), 0);
            ASSERT_LT(*seen.rbegin(), shape.plane_size());
        }
}

TEST(MicropolygonId, PackingIsReversibleAndOrdersByGrid) {
    for (const MicropolygonId id :
         {MicropolygonId{0, 0, 0}, MicropolygonId{5, 15, 3}, MicropolygonId{~0u, 15, 15}}) {
        const MicropolygonId back = MicropolygonId::unpack(id.packed());
        EXPECT_EQ(back.grid, id.grid);
        EXPECT_EQ(back.u, id.u);
        EXPECT_EQ(back.v, id.v);
        EXPECT_NE(id.packed(), MicropolygonId::kNone);
    }
    EXPECT_LT((MicropolygonId{1, 15, 15}.packed()), (MicropolygonId{2, 0, 0}.packed()));
}

TEST(PackGrid, KeepsEveryVertexAtEveryKey) {
    for (const int keys : {1, 2, 5})
        for (const auto& [nu, nv] : {std::pair{16, 16}, {1, 1}, {3, 7}, {4, 4}, {16, 1}}) {
            Shaded shaded(nu, nv, keys);
            GridArena arena;
            int64_t not_finite = 0;
            const Grid grid = shaded.pack(arena, &not_finite);
            EXPECT_EQ(not_finite, 0);
            EXPECT_EQ(grid.ordinal, 77u);
            EXPECT_EQ(grid.primitive, 3u);
            for (int key = 0; key < keys; ++key)
                for (int j = 0; j <= nv; ++j)
                    for (int i = 0; i <= nu; ++i)
                        ASSERT_EQ(grid.vertex_at_key(i, j, key, keys), Shaded::expected(i, j, key));
        }
}

TEST(PackGrid, MovesLinearlyBetweenKeysAndAlignsItsPlanes) {
    Shaded shaded(5, 6, 3);
    GridArena arena;
    int64_t not_finite = 0;
    const Grid grid = shaded.pack(arena, &not_finite);
    EXPECT_EQ(grid.vertex(2, 3, 0.25f), (Shaded::expected(2, 3, 0) + Shaded::expected(2, 3, 1)) * 0.5f);
    EXPECT_EQ(grid.vertex(2, 3, 0.75f), (Shaded::expected(2, 3, 1) + Shaded::expected(2, 3, 2)) * 0.5f);
    for (int segment = 0; segment < 2; ++segment)
        for (int component = 0; component < 6; ++component)
            EXPECT_EQ(reinterpret_cast<uintptr_t>(grid.plane(segment, component)) % 64, 0u);
}

TEST(PackGrid, LanesPastTheEndRepeatTheLastRowAndColumn) {
    Shaded shaded(5, 2, 1);
    GridArena arena;
    int64_t not_finite = 0;
    const Grid grid = shaded.pack(arena, &not_finite);
    for (int j = 0; j < grid.shape.tiles_v() * 4; ++j)
        for (int i = 0; i < grid.shape.tiles_u() * 4; ++i)
            ASSERT_EQ(grid.plane(0, 0)[grid.shape.tiled_index(i, j)],
                      Shaded::expected(std::min(i, 5), std::min(j, 2), 0).x);
}

TEST(PackGrid, LetsNothingPassThatIsNotFinite) {
    const float nan = std::numeric_limits<float>::quiet_NaN(),
                infinite = std::numeric_limits<float>::infinity();
    Shaded shaded(4, 4, 2);
    shaded.grid.P[0].set(7, {nan, 1, infinite});
    shaded.grid.P[1].set(24, {1, -infinite, 1});
    shaded.grid.Ci.set(3, {nan, 1e30f, 0});
    GridArena arena;
    int64_t not_finite = 0;
    const Grid grid = shaded.pack(arena, &not_finite);
    EXPECT_GE(not_finite, 4);
    for (int i = 0; i < grid.plane_count() * grid.shape.plane_size(); ++i)
        ASSERT_TRUE(std::isfinite(grid.positions[i]));
    EXPECT_EQ(grid.color(3, 0), V3f(0, 65504, 0));
}

TEST(PackGrid, OpaqueGridsHaveNoOpacityPlanes) {
    Shaded shaded(4, 4, 1);
    GridArena arena;
    int64_t not_finite = 0;
    EXPECT_TRUE(shaded.pack(arena, &not_finite).opaque);
    shaded.grid.Oi.set(24, {1, 1, 0.5f});
    const Grid glass = shaded.pack(arena, &not_finite);
    EXPECT_FALSE(glass.opaque);
    EXPECT_EQ(glass.opacity(4, 4), V3f(1, 1, 0.5f));
    EXPECT_EQ(glass.opacity(0, 0), V3f(1));
    EXPECT_EQ(glass.color(1, 0), V3f(0.25f, 0.5f, 1));
}

TEST(PackGrid, KeepsWholeFloatsWhereAskedTo) {
    Shaded shaded(3, 2, 1);  // 12 vertices
    for (int i = 0; i < 12; ++i) shaded.grid.Oi.set(i, V3f(0.3f));
    shaded.grid.Ci.set(5, {0.7f, 1e6f, 3e38f});
    shaded.grid.Oi.set(5, {0.7f, 1e6f, -3e38f});
    std::vector<float>& variable = shaded.grid.aovs.emplace_back(12);
    for (int i = 0; i < 12; ++i) variable[i] = 10.1f * i;
    GridArena arena;
    int64_t not_finite = 0;
    PackOptions options;
    options.float_colors = true;
    const Grid grid = pack_grid(shaded.grid, arena, &not_finite, options);
    EXPECT_EQ(grid.color(1, 1), V3f(0.7f, 1e6f, kInfinity));
    EXPECT_EQ(grid.opacity(1, 1), V3f(0.7f, 65504, -65504));
    EXPECT_EQ(grid.opacity(3, 2), V3f(0.3f));
    for (int i = 0; i < 12; ++i) ASSERT_EQ(grid.aov_plane(0)[i], 10.1f * i);
    EXPECT_EQ(grid.bytes(), shaded.pack(arena, &not_finite).bytes() + 12 * 6 * 2);
}

TEST(PackGrid, OutputVariablesFollowTheColoursAsFloats) {
    for (const float opacity : {1.0f, 0.5f}) {
        Shaded shaded(3, 2, 1);  // 12 vertices
        for (int i = 0; i < 12; ++i) shaded.grid.Oi.set(i, V3f(opacity));
        for (int channel = 0; channel < 4; ++channel) {
            std::vector<float>& plane = shaded.grid.aovs.emplace_back(12);
            for (int i = 0; i < 12; ++i) plane[i] = 1000.1f * static_cast<float>(channel + 1) + i;
        }
        shaded.grid.aovs[1][5] = std::numeric_limits<float>::quiet_NaN();
        shaded.grid.aovs[2][6] = -3e38f;
        GridArena arena;
        int64_t not_finite = 0;
        const Grid grid = shaded.pack(arena, &not_finite);
        EXPECT_EQ(not_finite, 1);
        ASSERT_EQ(grid.aov_channels, 4);
        EXPECT_EQ(grid.opaque, opacity == 1);
        for (int channel = 0; channel < 4; ++channel)
            for (int i = 0; i < 12; ++i) {
                if ((channel == 1 && i == 5) || (channel == 2 && i == 6)) continue;
                ASSERT_EQ(grid.aov_plane(channel)[i], 1000.1f * static_cast<float>(channel + 1) + i);
            }
        EXPECT_EQ(grid.aov_plane(1)[5], 0);
        EXPECT_EQ(grid.aov_plane(2)[6], -kInfinity);
        EXPECT_EQ(grid.color(1, 0), V3f(0.25f, 0.5f, 1));
        EXPECT_EQ(grid.opacity(3, 2), V3f(opacity));
        EXPECT_GE(reinterpret_cast<std::byte*>(grid.aov_plane(0)),
                  grid.colors + sizeof(Imath::half) * grid.color_count());
    }
}

TEST(PackGrid, SidesAndOrientationDecideTheFacing) {
    EXPECT_EQ(facing_for_sides(2, false), Facing::Both);
    EXPECT_EQ(facing_for_sides(2, true), Facing::Both);
    EXPECT_NE(facing_for_sides(1, false), facing_for_sides(1, true));
    // dPdu = +x, dPdv = +y in camera space: dPdu x dPdv = +z points away from the viewer, so that a ray along
    // +z sees the inside; the turn is counter-clockwise in (a, b).
    const Quad away{{0, 1, 0, 1}, {0, 0, 1, 1}, {2, 2, 2, 2}};
    float depth;
    EXPECT_FALSE(hit_micropolygon({0.3f, 0.6f, 0, 0, 0, 0}, away, facing_for_sides(1, false), &depth));
    EXPECT_TRUE(hit_micropolygon({0.3f, 0.6f, 0, 0, 0, 0}, away, facing_for_sides(1, true), &depth));
}

TEST(Grid, BytesOfAShadedMicropolygonAreWithinBounds) {
    Shaded still(16, 16, 1), moving(16, 16, 2);
    GridArena arena;
    int64_t not_finite = 0;
    EXPECT_LE(static_cast<double>(still.pack(arena, &not_finite).bytes()) / 256, 40);
    EXPECT_LE(static_cast<double>(moving.pack(arena, &not_finite).bytes()) / 256, 56);
}

TEST(GridArena, PlanesOfManyGridsAreApart) {
    GridArena arena;
    std::vector<Grid> grids(500);
    for (size_t g = 0; g < grids.size(); ++g) {
        grids[g].shape = {16, 16};
        arena.allocate(grids[g]);
        std::fill_n(grids[g].positions, grids[g].plane_count() * grids[g].shape.plane_size(),
                    static_cast<float>(g));
    }
    for (size_t g = 0; g < grids.size(); ++g) {
        ASSERT_EQ(grids[g].positions[0], static_cast<float>(g));
        ASSERT_EQ(grids[g].positions[3 * grids[g].shape.plane_size() - 1], static_cast<float>(g));
    }
}

}  // namespace
}  // namespace trapeze
