#include "sample/visibility.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/simd/simd_limit.h"

#include <algorithm>
#include <random>
#include <set>

#include "core/grids_harness.h"
#include "sample/every_method_harness.h"
#include "sample/frame_harness.h"
#include "sample/patterns/stratified_pattern.h"
#include "sample/swept_bound.h"

namespace trapeze {
namespace {

using testing::GridMaker;
using testing::TestFrame;

/// A wall across the whole picture.
void add_wall(GridMaker& maker, float z, int side = 4) {
    maker.add(side, side, 1, [=](int i, int j, float) {
        return V3f(20 * (static_cast<float>(i) / static_cast<float>(side) - 0.5f),
                   20 * (static_cast<float>(j) / static_cast<float>(side) - 0.5f), z);
    });
}

class EveryMethod : public ::testing::TestWithParam<std::string> {
  protected:
    HitBuffer resolve(const TestFrame& frame, const Grids& grids) {
        std::string error;
        const auto sampler = choose_sampler(GetParam(), "", &error);
        const auto pattern = sampler->make_pattern(frame.context);
        const auto visibility = sampler->prepare(frame.context, grids);
        SampleTile samples;
        pattern->make_tile({0, 0, 16, 16}, samples);
        HitBuffer hits;
        visibility->resolve(samples, hits, scratch_, stats_);
        EXPECT_EQ(hits.size(), samples.size());
        return hits;
    }
    SampleScratch scratch_;
    SampleStats stats_;
};

TEST_P(EveryMethod, SeesNothingInAnEmptyScene) {
    EXPECT_TRUE(resolve(TestFrame(16, 16, 2, false, false), Grids{}).hits.empty());
}

/// What the wide tree visits of a wall of small grids that parallel rays see at some depth.
size_t nodes_of_parallel_rays(float z) {
    constexpr int kSide = 16;
    GridMaker maker;
    for (int n = 0; n < kSide * kSide; ++n)
        maker.add(4, 4, 1, [=](int i, int j, float) {
            return V3f((static_cast<float>(n % kSide * 4 + i) / (kSide * 2) - 1),
                       (static_cast<float>(n / kSide * 4 + j) / (kSide * 2) - 1), z);
        });
    TestFrame frame(64, 64, 4, false, false);
    frame.options.projection = "orthographic";
    frame.update();
    std::string error;
    const auto sampler = choose_sampler("raytrace", "", &error);
    const auto pattern = sampler->make_pattern(frame.context);
    const auto visibility = sampler->prepare(frame.context, maker.grids());
    SampleTile samples;
    pattern->make_tile({16, 16, 32, 32}, samples);
    HitBuffer hits;
    SampleScratch scratch;
    SampleStats stats;
    visibility->resolve(samples, hits, scratch, stats);
    EXPECT_EQ(stats.predicate_hits, samples.size());
    return stats.nodes_visited;
}

TEST(WideRaytrace, ParallelRaysStayAsCloseHoweverFarTheyGo) {
    const size_t near = nodes_of_parallel_rays(2);
    EXPECT_GT(near, 0u);
    EXPECT_LE(nodes_of_parallel_rays(50), near + near / 10);
}

TEST_P(EveryMethod, SeesTheNearestWallEverywhere) {
    GridMaker maker;
    add_wall(maker, 7);
    add_wall(maker, 3);
    add_wall(maker, 5);
    const HitBuffer hits = resolve(TestFrame(16, 16, 2, false, true), maker.grids());
    for (size_t s = 0; s < hits.size(); ++s) {
        ASSERT_EQ(hits.of(s).size(), 1u);
        ASSERT_EQ(hits.of(s)[0].depth, 3);
        ASSERT_EQ(MicropolygonId::unpack(hits.of(s)[0].id).grid, 1u);
    }
}

TEST_P(EveryMethod, ListsLayersFrontToBackAsFarAsTheOpaqueOne) {
    GridMaker maker;
    maker.opaque = false;
    add_wall(maker, 7);
    add_wall(maker, 3);
    add_wall(maker, 2);
    maker.opaque = true;
    add_wall(maker, 5);
    const HitBuffer hits = resolve(TestFrame(16, 16, 2, true, true), maker.grids());
    for (size_t s = 0; s < hits.size(); ++s) {
        ASSERT_EQ(hits.of(s).size(), 3u);
        ASSERT_EQ(hits.of(s)[0].depth, 2);
        ASSERT_EQ(hits.of(s)[1].depth, 3);
        ASSERT_EQ(hits.of(s)[2].depth, 5);
    }
}

TEST_P(EveryMethod, EqualDepthsGoToTheSmallerId) {
    GridMaker maker;
    for (int n = 0; n < 5; ++n) add_wall(maker, 4);
    const HitBuffer hits = resolve(TestFrame(16, 16, 2, false, false), maker.grids());
    for (size_t s = 0; s < hits.size(); ++s) ASSERT_EQ(MicropolygonId::unpack(hits.of(s)[0].id).grid, 0u);
}

TEST_P(EveryMethod, ClipsByDepth) {
    GridMaker maker;
    add_wall(maker, 2);
    add_wall(maker, 50);
    TestFrame frame(16, 16, 2, false, false);
    frame.options.near_clip = 3, frame.options.far_clip = 40;
    frame.update();
    EXPECT_TRUE(resolve(frame, maker.grids()).hits.empty());
    frame.options.near_clip = 2, frame.options.far_clip = 50;  // inclusive
    frame.update();
    EXPECT_EQ(resolve(frame, maker.grids()).of(0)[0].depth, 2);
}

TEST_P(EveryMethod, OneSidedGridsShowOneSide) {
    GridMaker maker;
    maker.facing = Facing::PositiveOnly;
    add_wall(maker, 5);
    maker.facing = Facing::NegativeOnly;
    add_wall(maker, 4);
    const HitBuffer hits = resolve(TestFrame(16, 16, 2, false, false), maker.grids());
    for (size_t s = 0; s < hits.size(); ++s) ASSERT_EQ(hits.of(s)[0].depth, 5);
}

TEST_P(EveryMethod, CountsWhatItDoes) {
    GridMaker maker;
    add_wall(maker, 4, 16);
    const HitBuffer hits = resolve(TestFrame(16, 16, 2, false, false), maker.grids());
    EXPECT_EQ(stats_.rays, hits.size());
    EXPECT_GE(stats_.predicate_tests, stats_.predicate_hits);
    EXPECT_GE(stats_.predicate_hits, hits.hits.size());
}

TEST_P(EveryMethod, ScratchMayComeFromLargerTilesAndOtherGrids) {
    GridMaker one, other;
    add_wall(one, 4);
    other.opaque = false;
    for (int n = 0; n < 40; ++n) add_wall(other, 3 + 0.1f * static_cast<float>(n));
    const TestFrame frame(16, 16, 2, false, false);
    const HitBuffer fresh = resolve(frame, one.grids());
    resolve(TestFrame(16, 16, 4, true, true), other.grids());
    EXPECT_TRUE(resolve(frame, one.grids()) == fresh);
}

std::vector<std::string> methods_to_test() {
    std::vector<std::string> names = {"raytrace:tree=paper,split=sah,bounds=aabb4d",
                                      "raytrace:tree=paper,bounds=aabb,leaf=32"};
    for (const testing::MethodForm& form : testing::every_method()) names.push_back(form.name);
    return names;
}

INSTANTIATE_TEST_SUITE_P(Table, EveryMethod, ::testing::ValuesIn(methods_to_test()), [](const auto& tested) {
    std::string name(tested.param);
    std::erase_if(name, [](char c) { return !std::isalnum(c); });
    return name;
});

/// What tests call every method is every row of the table, and every value of every option.
TEST(VisibilityMethods, AreAllInEveryMethod) {
    std::set<std::string> named;
    for (const auto& [name, pattern] : testing::every_method({.exact_only = false})) {
        EXPECT_TRUE(named.insert(name).second) << name << " twice";
        EXPECT_FALSE(pattern.empty());
    }
    for (const VisibilityMethod& method : visibility_methods()) {
        EXPECT_TRUE(named.contains(std::string(method.name))) << method.name;
        for (const SpecOption& option : method.options)
            for (size_t i = 1; i < option.values.size(); ++i) {
                const std::string choice = std::string(option.name) + "=" + std::string(option.values[i]);
                EXPECT_TRUE(std::ranges::any_of(named,
                                                [&](const std::string& name) {
                                                    return name.starts_with(std::string(method.name) + ":") &&
                                                           (name + ",").find(choice + ",") !=
                                                               std::string::npos;
                                                }))
                    << method.name << ":" << choice;
            }
    }
}

TEST(VisibilityMethods, ThatAreWrongOnPurposeAreNotAmongExactOnes) {
    size_t wrong = 0;
    for (const VisibilityMethod& method : visibility_methods()) {
        if (method.wrong_choice.empty()) continue;
        const auto is_wrong = [&](const testing::MethodForm& form) {
            return form.name.find(method.wrong_choice) != std::string::npos;
        };
        EXPECT_TRUE(std::ranges::any_of(testing::every_method({.exact_only = false}), is_wrong));
        EXPECT_FALSE(std::ranges::any_of(testing::every_method(), is_wrong));
        ++wrong;
    }
    EXPECT_EQ(wrong, 1u);  // raytrace:tree=msbvh,clip=naive
}

TEST(VisibilityMethods, AreChosenByName) {
    std::string error;
    for (const VisibilityMethod& method : visibility_methods()) {
        const auto sampler = choose_sampler(method.name, "", &error);
        ASSERT_TRUE(sampler) << error;
        EXPECT_EQ(sampler->name(), method.name);
    }
    EXPECT_EQ(choose_sampler("raytrace:tree=paper,bundle=off", "", &error)->name(),
              "raytrace:tree=paper,bundle=off");
    EXPECT_EQ(choose_sampler("raytrace:bundle=on", "", &error)->name(), "raytrace");
    EXPECT_EQ(choose_sampler("interleaveuvt:k=4", "", &error)->pattern["k"], "4");
    EXPECT_FALSE(simd_target_name().empty());
}

TEST(VisibilityMethods, WrongNamesAreExplained) {
    const auto error_of = [](std::string_view method, std::string_view pattern) {
        std::string error;
        EXPECT_FALSE(choose_sampler(method, pattern, &error)) << method;
        return error;
    };
    EXPECT_THAT(error_of("raytrac", ""), ::testing::HasSubstr("no visibility method \"raytrac\"; there are"));
    EXPECT_THAT(error_of("", ""), ::testing::HasSubstr("no visibility method \"\""));
    EXPECT_THAT(error_of("raytrace:bundle=maybe", ""), ::testing::HasSubstr("is one of on, off"));
    EXPECT_THAT(error_of("raytrace:bundles=on", ""), ::testing::HasSubstr("no option \"bundles\""));
    EXPECT_THAT(error_of("raytrace:bundle", ""), ::testing::HasSubstr("key=value"));
    EXPECT_THAT(error_of("raytrace:bundle=off", ""),
                ::testing::HasSubstr("option \"bundle\" is for tree=paper"));
    EXPECT_THAT(error_of("raytrace:bounds=aabb", ""),
                ::testing::HasSubstr("option \"bounds\" is for tree=paper"));
    EXPECT_THAT(error_of("interleaveuvt:k=4", "interleaved:k=2"),
                ::testing::HasSubstr("cannot resolve samples"));
    EXPECT_THAT(error_of("interleaveuvt", "stratified"),
                ::testing::HasSubstr("its own is \"interleaved:k=2\""));
    EXPECT_THAT(error_of("raytrace", "scattered"), ::testing::HasSubstr("no sample pattern \"scattered\""));
}

TEST(PaperRayTraced, HeatIsWhatSamplesCost) {
    GridMaker maker;
    add_wall(maker, 4, 16);
    const TestFrame frame(16, 16, 2, true, true);
    for (const char* method :
         {"raytrace:tree=paper,bundle=off", "raytrace:tree=paper,bundle=off,split=sah,leaf=4"}) {
        std::string error;
        const auto sampler = choose_sampler(method, "", &error);
        const auto pattern = sampler->make_pattern(frame.context);
        const auto visibility = sampler->prepare(frame.context, maker.grids());
        SampleTile samples;
        pattern->make_tile({0, 0, 16, 16}, samples);
        SampleHeat heat{std::vector<uint32_t>(samples.size()), std::vector<uint32_t>(samples.size())};
        SampleScratch scratch;
        scratch.heat = &heat;
        SampleStats stats;
        HitBuffer hits;
        visibility->resolve(samples, hits, scratch, stats);
        uint64_t tests = 0, nodes = 0;
        for (size_t s = 0; s < samples.size(); ++s) {
            EXPECT_GE(heat.tests[s], 1u);
            tests += heat.tests[s], nodes += heat.nodes[s];
        }
        EXPECT_EQ(tests, stats.predicate_tests) << method;
        EXPECT_EQ(nodes, stats.nodes_visited) << method;
    }
}

TEST(SweptBound, HoldsWhereAnyPartOfTheLensSeesAPointAtAnyTime) {
    std::mt19937 engine(8);
    const auto noise = [&](float from, float to) {
        return std::uniform_real_distribution<float>(from, to)(engine);
    };
    for (const char* projection : {"perspective", "orthographic"}) {
        TestFrame frame(100, 80, 1, true, true);
        frame.options.projection = projection;
        frame.update();
        const Camera& camera = frame.context.camera;
        for (int round = 0; round < 2000; ++round) {
            const V3f from(noise(-3, 3), noise(-3, 3), noise(0.5f, 20)),
                to(noise(-3, 3), noise(-3, 3), noise(0.5f, 20));
            SweptBound bound;
            bound.add(from.x, from.y, from.z);
            bound.add(to.x, to.y, to.z);
            const RasterBox box = bound.raster(camera);
            for (int i = 0; i < 20; ++i) {
                const V3f p = from + (to - from) * noise(0, 1);
                const float angle = noise(0, 6.28f), lens_x = camera.lens_radius * std::cos(angle),
                            lens_y = camera.lens_radius * std::sin(angle);
                // The ray from that lens point through p crosses the focal plane at what the raster shows
                // there.
                const float f = camera.focal_distance;
                const V3f lens(lens_x, lens_y, 0);
                V3f in_focus = lens + (p - lens) * (f / p.z);
                if (!camera.perspective) {  // the lens is a parallel shift there
                    const float k = 1 - p.z / f;
                    in_focus = V3f(p.x - lens_x * k, p.y - lens_y * k, f);
                }
                const V2f raster = camera.raster_from_camera(in_focus);
                ASSERT_GE(raster.x, box.min_x - 1e-3);
                ASSERT_LE(raster.x, box.max_x + 1e-3);
                ASSERT_GE(raster.y, box.min_y - 1e-3);
                ASSERT_LE(raster.y, box.max_y + 1e-3);
            }
        }
    }
}

TEST(SweptBound, IsEverythingAcrossTheNearPlaneAndNothingOutsideTheClippingRange) {
    const TestFrame frame(100, 80, 1, false, false);
    SweptBound crossing, behind, beyond;
    crossing.add(0, 0, -1), crossing.add(0, 0, 1);
    behind.add(0, 0, -1), behind.add(0, 0, 0.05f);
    beyond.add(0, 0, 1001), beyond.add(0, 0, 2000);
    EXPECT_EQ(crossing.raster(frame.context.camera).min_x, -std::numeric_limits<double>::infinity());
    EXPECT_GT(behind.raster(frame.context.camera).min_x, behind.raster(frame.context.camera).max_x);
    EXPECT_GT(beyond.raster(frame.context.camera).min_x, beyond.raster(frame.context.camera).max_x);
}

TEST(SimdTarget, AskingForTheLimitDoesNotLiftIt) {
    std::string error;
    for (const std::string_view name : simd_names()) {
        if (name == "best" || !limit_simd(name, &error)) continue;
        const std::string limited(simd_target_name());
        EXPECT_EQ(simd_limit(), name);
        EXPECT_EQ(simd_target_name(), limited);
    }
    ASSERT_TRUE(limit_simd("best", &error));
}

}  // namespace
}  // namespace trapeze
