/// Instances' shared points: the same bits as without sharing, evaluated once, within the budget, from many
/// threads.
#include "tessellate/shared_grids.h"

#include <gtest/gtest.h>
#include <tbb/parallel_for.h>

#include <vector>

namespace trapeze {
namespace {

/// Counts how often it is asked; only its points matter here.
class Counted final : public Surface {
  public:
    int face_count() const override { return 2; }
    uint32_t edge_count() const override { return 0; }
    uint32_t vertex_count() const override { return 0; }
    std::array<SurfaceSide, 4> sides(int) const override { return {}; }
    EdgeLine edge(uint32_t) const override { return {}; }
    SurfacePoint vertex(uint32_t) const override { return {}; }
    void evaluate(int face, std::span<const V2f> uv, int key, SurfaceScratch*, std::span<V3f> P,
                  std::span<V3f> dPdu, std::span<V3f> dPdv) const override {
        ++calls;
        for (size_t i = 0; i < uv.size(); ++i)
            P[i] = {uv[i].x, uv[i].y, static_cast<float>(face + 10 * key) + uv[i].x * uv[i].y};
        for (size_t i = 0; i < dPdu.size(); ++i) dPdu[i] = {1, 0, uv[i].y};
        for (size_t i = 0; i < dPdv.size(); ++i) dPdv[i] = {0, 1, uv[i].x};
    }
    bool evaluate_variables(int, std::span<const V2f>, SurfaceScratch*, ShadingGrid&) const override {
        return false;
    }

    mutable std::atomic<int> calls{0};
};

/// A grid's parameters; `shift` moves inner rows alone, so that first and last points stay the same.
std::vector<V2f> grid_of(int n, float shift = 0) {
    std::vector<V2f> uv;
    for (int j = 0; j <= n; ++j)
        for (int i = 0; i <= n; ++i)
            uv.push_back({static_cast<float>(i) / static_cast<float>(n),
                          (static_cast<float>(j) + (j > 0 && j < n ? shift : 0)) / static_cast<float>(n)});
    return uv;
}

struct SharedPoints {
    std::vector<V3f> P, dPdu, dPdv;
    bool operator==(const SharedPoints&) const = default;
};
SharedPoints points_of(const Surface& surface, int face, const std::vector<V2f>& uv, int key = 0,
                       bool derivatives = true) {
    const size_t d = derivatives ? uv.size() : 0;
    SharedPoints points{std::vector<V3f>(uv.size()), std::vector<V3f>(d), std::vector<V3f>(d)};
    surface.evaluate(face, uv, key, nullptr, points.P, points.dPdu, points.dPdv);
    return points;
}

struct Shared {
    std::shared_ptr<const Counted> inner = std::make_shared<Counted>();
    SharedGridBudget budget;
    std::unique_ptr<Surface> surface;

    explicit Shared(size_t bytes = 1 << 20) {
        budget.bytes_left = bytes;
        surface = share_grids(inner, budget);
    }
};

TEST(SharedGrids, TheSecondInstanceTakesTheFirstOnes) {
    Shared shared;
    const SharedPoints first = points_of(*shared.surface, 1, grid_of(8));
    EXPECT_EQ(shared.inner->calls, 1);
    EXPECT_EQ(points_of(*shared.surface, 1, grid_of(8)), first);
    EXPECT_EQ(shared.inner->calls, 1);
    EXPECT_EQ(points_of(Counted(), 1, grid_of(8)), first);
}

TEST(SharedGrids, WhatDiffersInAnythingIsAnother) {
    Shared shared;
    const Counted plain;
    const auto check = [&](int face, const std::vector<V2f>& uv, int key, bool derivatives) {
        for (int again = 0; again < 2; ++again)
            EXPECT_EQ(points_of(*shared.surface, face, uv, key, derivatives),
                      points_of(plain, face, uv, key, derivatives));
    };
    check(0, grid_of(4), 0, true);
    check(1, grid_of(4), 0, true);
    check(0, grid_of(4), 1, true);
    check(0, grid_of(5), 0, true);
    check(0, grid_of(4, .25f), 0, true);  // ends and middle row alike, others moved
    check(0, grid_of(4), 0, false);
    EXPECT_EQ(shared.inner->calls, 6);
}

TEST(SharedGrids, AFullBudgetKeepsNoMore) {
    Shared shared(3000);
    const SharedPoints first = points_of(*shared.surface, 0, grid_of(4)),
                       second = points_of(*shared.surface, 1, grid_of(4));
    EXPECT_EQ(shared.inner->calls, 2);
    for (int n = 0; n < 3; ++n) {
        EXPECT_EQ(points_of(*shared.surface, 0, grid_of(4)), first);
        EXPECT_EQ(points_of(*shared.surface, 1, grid_of(16)), points_of(Counted(), 1, grid_of(16)));
        EXPECT_EQ(points_of(*shared.surface, 1, grid_of(4)), second);
    }
    EXPECT_GE(shared.inner->calls, 2 + 3);
    EXPECT_LT(shared.budget.bytes_left, 3000u);
}

TEST(SharedGrids, ManyThreadsGetTheSame) {
    Shared shared;
    const Counted plain;
    tbb::parallel_for(0, 400, [&](int i) {
        const auto uv = grid_of(1 + i % 7);
        EXPECT_EQ(points_of(*shared.surface, i & 1, uv), points_of(plain, i & 1, uv));
    });
}

}  // namespace
}  // namespace trapeze
