#include "composite/layers/hit_layers.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <bit>
#include <random>
#include <string>

#include "core/simd/simd_limit.h"

namespace trapeze {
namespace {

/// Grids of all kinds with random vertices and colours, in floats or in halves; rays that meet them anywhere,
/// or nowhere.
class HitLayersOfRandomGrids : public ::testing::TestWithParam<bool> {
  protected:
    HitLayersOfRandomGrids() {
        grids_.arenas.emplace_back();
        for (int kind = 0; kind < 24; ++kind) add_grid(kind);
        make_samples();
    }

    float between(float low, float high) { return std::uniform_real_distribution<float>(low, high)(random_); }
    int below(int end) { return std::uniform_int_distribution<int>(0, end - 1)(random_); }

    void add_grid(int kind) {
        Grid grid;
        grid.shape = {static_cast<uint8_t>(1 + below(kMaxGridSide)),
                      static_cast<uint8_t>(1 + below(kMaxGridSide))};
        grid.smooth = kind % 2 == 0, grid.opaque = kind / 2 % 2 == 0;
        grid.key_count = static_cast<uint8_t>(std::array{1, 2, 5}[static_cast<size_t>(kind) / 4 % 3]);
        grid.float_colors = GetParam();
        grids_.arenas[0].allocate(grid);
        const int floats = grid.plane_count() * grid.shape.plane_size();
        for (int i = 0; i < floats; ++i) grid.positions[i] = between(-2, 2);
        if (kind == 0) std::fill_n(grid.positions, floats, 1.0f);  // all in one point
        for (size_t i = 0; i < grid.color_count(); ++i) {
            const float color = below(8) ? between(0, 1) : between(0, 1e-6f);  // some subnormal, as halves
            if (grid.float_colors)
                grid.full_colors()[i] = color;
            else
                grid.half_colors()[i] = color;
        }
        grids_.grids.push_back(grid);
    }

    /// 0 to 3 hits a sample, one in thirty on a grid that is not there. The latter half meets few
    /// micropolygons.
    void make_samples() {
        samples_.resize(400);
        hits_.first.push_back(0);
        for (AxisRay& ray : samples_.rays) {
            ray = {between(-2, 2), between(-2, 2), 0, between(-1, 1), between(-1, 1), between(0, 0.999f)};
            for (int n = below(4); n > 0; --n) {
                const auto at = static_cast<uint32_t>(below(static_cast<int>(grids_.grids.size())));
                const GridShape shape = grids_.grids[at].shape;
                MicropolygonId id{at, static_cast<uint8_t>(below(shape.nu)),
                                  static_cast<uint8_t>(below(shape.nv))};
                if (&ray >= &samples_.rays[200]) id = {static_cast<uint32_t>(below(10)), 0, 0};
                if (below(30) == 0) id.grid = 1000;
                hits_.hits.push_back({between(1, 9), id.packed()});
            }
            hits_.first.push_back(static_cast<uint32_t>(hits_.hits.size()));
        }
    }

    static void expect_same_bits(const V3f& a, const V3f& b, size_t hit) {
        for (int c = 0; c < 3; ++c)
            EXPECT_EQ(std::bit_cast<uint32_t>(a[c]), std::bit_cast<uint32_t>(b[c])) << hit;
    }

    void check(size_t begin, size_t end) {
        HitLayers layers;
        layers.interpolate(samples_, hits_, begin, end, grids_);
        for (size_t s = begin; s < end; ++s)
            for (size_t i = hits_.first[s]; i < hits_.first[s + 1]; ++i) {
                const MicropolygonId id = MicropolygonId::unpack(hits_.hits[i].id);
                if (id.grid >= grids_.grids.size()) continue;
                const Layer expected = layer_at(samples_.rays[s], grids_.grids[id.grid], id);
                expect_same_bits(layers[i].color, expected.color, i);
                expect_same_bits(layers[i].opacity, expected.opacity, i);
            }
    }

    std::mt19937 random_{7};
    Grids grids_;
    SampleTile samples_;
    HitBuffer hits_;
};

TEST_P(HitLayersOfRandomGrids, AreThoseOfEachHitAloneOnAllTargets) {
    std::string error;
    for (const std::string_view name : simd_names()) {
        if (!limit_simd(name, &error)) continue;
        check(0, samples_.size());
        check(17, 18), check(50, 50), check(100, 161);
    }
    ASSERT_TRUE(limit_simd("best", &error));
}

/// What is flat stays flat, wherever rays meet it.
TEST_P(HitLayersOfRandomGrids, OfOneColorShowItToTheLastBit) {
    for (Grid& grid : grids_.grids)
        for (size_t i = 0; i < grid.color_count(); ++i)
            if (grid.float_colors)
                grid.full_colors()[i] = 0.3f;
            else
                grid.half_colors()[i] = 0.3f;
    const float color = GetParam() ? 0.3f : static_cast<float>(Imath::half(0.3f));
    HitLayers layers;
    layers.interpolate(samples_, hits_, 0, samples_.size(), grids_);
    for (size_t i = 0; i < hits_.hits.size(); ++i) {
        const MicropolygonId id = MicropolygonId::unpack(hits_.hits[i].id);
        if (id.grid >= grids_.grids.size()) continue;
        EXPECT_EQ(layers[i].color, V3f(color)) << i;
        EXPECT_EQ(layers[i].opacity, V3f(grids_.grids[id.grid].opaque ? 1 : color)) << i;
    }
}

/// One hit a sample on opaque grids that hold nothing out; then one on glass, a second hit, none.
TEST_P(HitLayersOfRandomGrids, CoverWhereEachSampleSeesOneSurfaceThatHidesAllElse) {
    const uint32_t opaque = 0, glass = 2;
    const auto all_cover = [&](std::vector<uint32_t> grids, std::vector<uint32_t> first) {
        HitBuffer hits{std::move(first), {}};
        for (const uint32_t grid : grids) hits.hits.push_back({1, MicropolygonId{grid}.packed()});
        HitLayers layers;
        layers.interpolate(samples_, hits, 0, hits.size(), grids_);
        return layers.all_cover();
    };
    EXPECT_TRUE(all_cover({opaque, opaque, opaque}, {0, 1, 2, 3}));
    EXPECT_FALSE(all_cover({opaque, glass, opaque}, {0, 1, 2, 3}));
    EXPECT_FALSE(all_cover({opaque, opaque, 1000}, {0, 1, 2, 3}));
    EXPECT_FALSE(all_cover({opaque, opaque, opaque}, {0, 2, 3}));
    EXPECT_FALSE(all_cover({opaque, opaque, opaque}, {0, 2, 2, 3}));
    grids_.grids[opaque].matte = 1;
    EXPECT_FALSE(all_cover({opaque, opaque, opaque}, {0, 1, 2, 3}));
}

TEST_P(HitLayersOfRandomGrids, AreTheLastOnesAskedFor) {
    HitLayers layers;
    layers.interpolate(samples_, hits_, 0, 300, grids_);
    layers.interpolate(samples_, hits_, 300, 400, grids_);
    const size_t i = hits_.first[350];
    const MicropolygonId id = MicropolygonId::unpack(hits_.hits[i].id);
    const auto owner = static_cast<size_t>(std::upper_bound(hits_.first.begin(), hits_.first.end(), i) -
                                           hits_.first.begin() - 1);
    ASSERT_LT(id.grid, grids_.grids.size());
    expect_same_bits(layers[i].color, layer_at(samples_.rays[owner], grids_.grids[id.grid], id).color, i);
}

INSTANTIATE_TEST_SUITE_P(All, HitLayersOfRandomGrids, ::testing::Bool(),
                         [](const auto& row) { return row.param ? "Floats" : "Halves"; });

}  // namespace
}  // namespace trapeze
