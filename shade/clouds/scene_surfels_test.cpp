#include "shade/clouds/scene_surfels.h"

#include <gtest/gtest.h>

#include <array>
#include <atomic>
#include <thread>
#include <tuple>

#include "shade/clouds/surfels_harness.h"

namespace trapeze::testing {
namespace {

/// A sheet of discs, of which each has its number for an id.
struct Sheet final : RayScene {
    static constexpr int kSide = 60;

    Sheet() {
        add_sheet(discs, kSide, {-1, -1, 3}, {2, 0, 0}, {0, 2, 0});
        for (size_t i = 0; i < discs.size(); ++i) discs.ids.push_back(i);
        primitive.attributes = std::make_shared<Attributes>();
    }
    bool has(RayKind) const override { return true; }
    void closest(std::span<const RaySegment* const>, RayKind,
                 std::span<std::optional<RaySurfaceHit>>) const override {}
    void blocked(std::span<const RaySegment* const>, RayKind, std::span<std::optional<bool>>) const override {
    }
    size_t rays_at_once() const override { return 0; }
    int dice(const RaySurfaceHit&, ShadingGrid&) const override { return 0; }
    float spacing(const V3f&) const override { return .01f; }
    std::optional<Surfels> surfels(RayKind, size_t most_bytes) const override {
        return discs.bytes() <= most_bytes ? std::optional(discs) : std::nullopt;
    }
    int dice_surfel(uint64_t id, ShadingGrid& grid) const override {
        grid.shape = {1, 1}, grid.primitive = &primitive;
        grid.P.resize(1);
        grid.P[0].fill(4, discs.positions[id]), grid.Os.fill(4, V3f(1));
        return 0;
    }

    Surfels discs;
    Primitive primitive;
};

/// Every disc is shaded once for each side, whoever asks how often, and is told from where it is seen.
TEST(SceneSurfels, AreShadedOnceByAllWhoAsk) {
    const Sheet sheet;
    CloudLibrary library({}, nullptr, kEverything);
    SceneSurfels surfels(library);
    std::atomic<size_t> shaded{0};
    surfels.set_scene(&sheet, [&] {
        return [&](std::span<ShadingGrid* const> grids, const HitVisit& visit) {
            EXPECT_EQ(visit.kind, RayKind::Diffuse);
            for (ShadingGrid* const grid : grids)
                grid->Ci.fill(4, V3f(grid->P[0].at(0).x, grid->P[0].at(0).y, grid->I.at(0).z));
            shaded += grids.size();
        };
    });
    std::vector<std::thread> threads;
    std::array<const SurfelTree*, 5> found{};
    for (const SurfelTree*& tree : found)
        threads.emplace_back([&] {
            std::string problem;
            tree = surfels.find_colored(&problem);
        });
    for (std::thread& thread : threads) thread.join();
    ASSERT_TRUE(found[0]);
    EXPECT_EQ(std::ranges::count(found, found[0]), 5);
    EXPECT_EQ(shaded, 2 * sheet.discs.size());
    const Surfels& discs = found[0]->surfels();
    ASSERT_EQ(discs.radiosities.size(), sheet.discs.size());
    for (size_t i = 0; i < discs.size(); ++i)
        EXPECT_LT((discs.radiosities[i] - V3f(discs.positions[i].x, discs.positions[i].y, -.01f)).length(),
                  1e-6f);
    // After they are forgotten they are made anew.
    surfels.forget_colors();
    std::string problem;
    EXPECT_EQ(surfels.find_colored(&problem), found[0]);
    EXPECT_EQ(shaded, 4 * sheet.discs.size());
}

/// Discs and their colours keep to the memory of clouds; discs may fit where colours do not.
TEST(SceneSurfels, KeepToTheMemoryOfClouds) {
    const Sheet sheet;
    const SurfelTree tree(sheet.discs);
    const size_t with_colors = tree.bytes() + tree.bytes_of_radiosities();
    for (const auto& [limit, fits, colors_fit] :
         {std::tuple(size_t{1000}, false, false), std::tuple(tree.bytes(), true, false),
          std::tuple(with_colors - 1, true, false), std::tuple(with_colors, true, true)}) {
        CloudLibrary library({}, nullptr, kEverything);
        library.set_limit(limit);
        SceneSurfels surfels(library);
        surfels.set_scene(&sheet, [] { return [](std::span<ShadingGrid* const>, const HitVisit&) {}; });
        std::string problem;
        EXPECT_EQ(surfels.find(&problem) != nullptr, fits);
        EXPECT_EQ(problem.empty(), fits);
        EXPECT_EQ(surfels.find_colored(&problem) != nullptr, colors_fit);
        EXPECT_EQ(problem.empty(), colors_fit);
    }
}

}  // namespace
}  // namespace trapeze::testing
