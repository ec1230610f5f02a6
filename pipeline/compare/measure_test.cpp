#include "pipeline/compare/measure.h"

#include <gtest/gtest.h>
#include <tbb/task_arena.h>
#include <nlohmann/json.hpp>

#include <atomic>
#include <fstream>

#include "pipeline/compare/compare_harness.h"
#include "pipeline/compare/occlusion_rays.h"
#include "pipeline/compare/peak_memory.h"
#include "pipeline/compare/pictures.h"
#include "pipeline/compare/results_json.h"
#include "pipeline/compare/sample_groups.h"

namespace trapeze {
namespace {

using testing::samplers_of;
using testing::SharedScene;

TEST(Median, IsTheMiddleOrTheMeanOfTwo) {
    EXPECT_EQ(median({}), 0);
    EXPECT_EQ(median({3}), 3);
    EXPECT_EQ(median({9, 1, 2}), 2);
    EXPECT_EQ(median({4, 1, 2, 9}), 3);
}

TEST(MethodResult, TheTotalIsTheMedianOfTheRoundsSums) {
    MethodResult r;
    r.build_seconds = {1, 5, 2};
    r.resolve_seconds = {9, 1, 3};
    EXPECT_EQ(r.build_median(), 2);
    EXPECT_EQ(r.resolve_median(), 3);
    EXPECT_EQ(r.total_median(), 6);  // of 10, 6, 5
    EXPECT_EQ(r.total_spread().least, 5);
    EXPECT_EQ(r.total_spread().most, 10);
    EXPECT_EQ(r.tests_per_sample(), 0) << "nothing was sampled";
}

TEST(Measure, OcclusionRaysMeetTheSameByEveryTree) {
    const SharedScene shared("defocus_motion.rib");
    const auto samplers = samplers_of({"raytrace", "interval", "bruteforce", "raytrace:tree=paper",
                                       "raytrace:tree=msbvh", "raytrace:tree=mbkd"});
    MeasureSettings settings;
    settings.rounds = 2;
    settings.occlusion = true;
    const auto results = measure(*shared.frame, samplers, {{2, 2}}, settings);
    ASSERT_EQ(results.size(), samplers.size());
    const MethodResult& truth = results[2];
    EXPECT_GT(truth.occlusion.rays, 0u);
    EXPECT_LE(truth.occlusion.rays, truth.sample.rays);
    EXPECT_GT(truth.occluded, 0u);
    EXPECT_LT(truth.occluded, truth.occlusion.rays);
    for (const MethodResult& r : results) {
        if (r.method == "interval") {
            EXPECT_TRUE(r.occlusion_seconds.empty()) << "a rasterizer takes none";
            EXPECT_FALSE(to_json(r).contains("occlusion_rays"));
            continue;
        }
        EXPECT_EQ(r.occlusion_seconds.size(), 2u) << r.method;
        EXPECT_EQ(r.occlusion.rays, truth.occlusion.rays) << r.method;
        EXPECT_EQ(r.occluded, truth.occluded) << r.method;
        EXPECT_EQ(to_json(r)["occluded"], r.occluded);
        if (&r == &truth) continue;
        EXPECT_LT(r.tests_per_occlusion_ray(), truth.tests_per_occlusion_ray()) << r.method;
    }
}

TEST(Measure, OcclusionRaysAreAlikeForAnyNumberOfThreads) {
    const SharedScene shared("defocus_motion.rib");
    const auto rays = occlusion_rays(*shared.frame, {2, 2}, 1 << 20);
    tbb::task_arena one(1);
    const auto again = one.execute([&] { return occlusion_rays(*shared.frame, {2, 2}, 1 << 30); });
    ASSERT_EQ(rays.size(), again.size());
    for (size_t i = 0; i < rays.size(); ++i) {
        EXPECT_EQ(rays[i].origin, again[i].origin);
        EXPECT_EQ(rays[i].direction, again[i].direction);
        EXPECT_EQ(rays[i].time, again[i].time);
    }
}

TEST(Measure, EveryMethodAtEveryRateInOrder) {
    const SharedScene shared("defocus_motion.rib");
    const auto samplers = samplers_of({"raytrace", "interval", "bruteforce"});
    const auto results = measure(*shared.frame, samplers, {{1, 1}, {2, 2}}, {2, 1 << 30});
    ASSERT_EQ(results.size(), 6u);
    EXPECT_EQ(results[0].method, "raytrace");
    EXPECT_EQ(results[1].method, "interval");
    EXPECT_EQ(results[1].pattern, "interval");
    EXPECT_EQ(results[5].method, "bruteforce");
    EXPECT_EQ(results[3].rate, (SampleRate{2, 2}));
    const PixelRect& pixels = shared.frame->pixels;
    for (const MethodResult& r : results) {
        EXPECT_EQ(r.build_seconds.size(), 2u);
        EXPECT_EQ(r.resolve_seconds.size(), 2u);
        EXPECT_GT(r.total_median(), 0);
        EXPECT_EQ(r.sample.rays,
                  static_cast<uint64_t>(pixels.width()) * pixels.height() * r.rate.per_pixel());
        EXPECT_GT(r.hits, 0u);
        EXPECT_EQ(r.micropolygons, shared.frame->grids.micropolygon_count());
    }
    // Same pattern, same samples: the same hits.
    EXPECT_EQ(results[3].hits, results[5].hits);
    EXPECT_LT(results[3].tests_per_sample(), results[5].tests_per_sample());
}

TEST(Measure, SmallGroupsOfTilesChangeNothingButTime) {
    const SharedScene shared("defocus_motion.rib");
    const auto samplers = samplers_of({"raytrace", "interval"});
    const auto whole = measure(*shared.frame, samplers, {{2, 2}}, {1, 1 << 30});
    const auto groups = measure(*shared.frame, samplers, {{2, 2}}, {1, 1});
    ASSERT_EQ(whole.size(), groups.size());
    for (size_t i = 0; i < whole.size(); ++i) {
        EXPECT_EQ(whole[i].hits, groups[i].hits);
        EXPECT_EQ(whole[i].sample.rays, groups[i].sample.rays);
        EXPECT_EQ(whole[i].sample.predicate_hits, groups[i].sample.predicate_hits);
    }
}

TEST(Measure, ProgressEndsAtOneAndCancellationLeavesNothing) {
    SharedScene shared("quadric_sphere.rib");
    std::vector<double> progress;
    measure(*shared.frame, samplers_of({"raytrace"}), {{1, 1}},
            {2, 1 << 30, [&](double part) { progress.push_back(part); }});
    EXPECT_EQ(progress, (std::vector<double>{0.5, 1}));
    const std::atomic<bool> cancelled{true};
    shared.frame->context.cancelled = &cancelled;
    EXPECT_TRUE(measure(*shared.frame, samplers_of({"raytrace"}), {{1, 1}}, {}).empty());
}

TEST(SampleGroups, CoverEveryPixelOnce) {
    const SharedScene shared("quadric_sphere.rib");
    const auto sampler = samplers_of({"raytrace"}).front();
    const auto pattern = sampler.make_pattern(shared.frame->context_at({1, 1}));
    const PixelRect pixels{-3, -2, 70, 50};
    SampleGroups groups(pixels, 16, 1, 7 * 16 * 16 * kBytesPerSample);
    EXPECT_GT(groups.count(), 2u);
    std::vector<int> seen(static_cast<size_t>(pixels.width() * pixels.height()), 0);
    for (size_t g = 0; g < groups.count(); ++g) {
        const auto tiles = groups.make(g, *pattern);
        EXPECT_LE(tiles.size(), 7u);
        for (const SampleTile& tile : tiles)
            for (int y = tile.pixels.y0; y < tile.pixels.y1; ++y)
                for (int x = tile.pixels.x0; x < tile.pixels.x1; ++x)
                    ++seen[static_cast<size_t>((y - pixels.y0) * pixels.width() + (x - pixels.x0))];
    }
    EXPECT_EQ(std::count(seen.begin(), seen.end(), 1), static_cast<long>(seen.size()));
}

TEST(SharedFrame, TooLittleMemoryIsAnErrorThatSaysWhatHelps) {
    RenderSettings settings;
    settings.memory_bytes = 1;
    const SharedScene shared("quadric_sphere.rib", settings);
    EXPECT_FALSE(shared.frame);
    EXPECT_EQ(shared.diagnostics.count(Severity::Error), 1u);
    EXPECT_NE(shared.messages.find("--memory"), std::string::npos) << shared.messages;
}

TEST(Measure, AMethodWhoseTurnTookTooLongTakesNoOther) {
    const SharedScene shared("quadric_sphere.rib");
    const auto samplers = samplers_of({"raytrace", "raytrace:tree=paper"});
    MeasureSettings settings;
    settings.rounds = 3;
    settings.longest_turn = 1e-12;
    for (const MethodResult& result : measure(*shared.frame, samplers, {{1, 1}}, settings)) {
        EXPECT_EQ(result.build_seconds.size(), 1u);
        EXPECT_EQ(result.resolve_seconds.size(), 1u);
        EXPECT_GT(result.sample.rays, 0u);
    }
    settings.longest_turn = 1e6;
    for (const MethodResult& result : measure(*shared.frame, samplers, {{1, 1}}, settings))
        EXPECT_EQ(result.resolve_seconds.size(), 3u);
}

/// What the grids and the default tree take, and a budget that holds hardly more.
size_t bytes_for_few(const SharedFrame& frame, const std::vector<Sampler>& samplers) {
    return frame.grids.bytes() + samplers[0].build_memory().bytes(frame.grids);
}

TEST(Measure, AMethodThatTakesTooMuchMemoryIsMeasuredInParts) {
    SharedScene shared("defocus_motion.rib");
    const SharedFrame& frame = *shared.frame;
    const auto samplers = samplers_of({"raytrace", "raytrace:tree=mbkd", "interval"});
    MeasureSettings settings;
    settings.rounds = 2;
    settings.occlusion = true;
    const auto whole = measure(frame, samplers, {{2, 2}}, settings);
    EXPECT_EQ(shared.messages.find("measured in"), std::string::npos) << shared.messages;
    shared.frame->memory_budget = bytes_for_few(frame, samplers);
    const auto parts = measure(frame, samplers, {{2, 2}}, settings);
    EXPECT_NE(shared.messages.find("raytrace:tree=mbkd is measured in"), std::string::npos)
        << shared.messages;
    ASSERT_EQ(parts.size(), whole.size());
    EXPECT_EQ(parts[0].parts, 1u);
    EXPECT_GT(parts[1].parts, 1u);
    for (size_t i = 0; i < parts.size(); ++i) {
        EXPECT_EQ(whole[i].parts, 1u);
        EXPECT_EQ(parts[i].build_seconds.size(), 2u);
        EXPECT_EQ(parts[i].hits, whole[i].hits) << parts[i].method;
        EXPECT_EQ(parts[i].sample.rays, whole[i].sample.rays);
        EXPECT_EQ(parts[i].sample.predicate_hits > 0, true);
    }
    EXPECT_LT(parts[1].build.tree_bytes, whole[1].build.tree_bytes);
    EXPECT_FALSE(whole[1].occlusion_seconds.empty());
    EXPECT_TRUE(parts[1].occlusion_seconds.empty()) << "they go anywhere";
    EXPECT_EQ(to_json(parts[1])["parts"], parts[1].parts);
}

TEST(Measure, PicturesOfPartsAreThoseOfTheWhole) {
    SharedScene shared("defocus_motion.rib");
    const auto samplers = samplers_of({"raytrace", "raytrace:tree=mbkd"});
    for (const float variance : {0.0f, 1e-3f}) {
        shared.frame->memory_budget = ~size_t{0};
        const auto whole = make_picture(*shared.frame, samplers[1], {4, 4}, {}, variance);
        shared.frame->memory_budget = bytes_for_few(*shared.frame, samplers);
        const auto parts = make_picture(*shared.frame, samplers[1], {4, 4}, {}, variance);
        ASSERT_TRUE(whole && parts);
        EXPECT_EQ(whole->image.rgba, parts->image.rgba) << variance;
        EXPECT_EQ(whole->heat.samples, parts->heat.samples);
    }
}

/// What is freed meanwhile counts.
TEST(PeakMemory, IsOfWhatWasThereAtOnce) {
    {
        const PeakMemory none;
        const bool tells = std::ofstream("/proc/self/clear_refs").is_open();
        ASSERT_EQ(none.bytes().has_value(), tells);
        if (!tells) GTEST_SKIP() << "a process may not set back its mark here";
        EXPECT_LT(*none.bytes(), size_t{1} << 20);
    }
    constexpr size_t kBytes = size_t{64} << 20;
    const PeakMemory peak;
    { std::vector<char> large(kBytes, 1); }
    EXPECT_GT(*peak.bytes(), kBytes * 9 / 10);
    EXPECT_LT(*peak.bytes(), kBytes * 3 / 2);
}

TEST(Measure, AMethodThatMayTakeTooMuchMemoryIsNamedBefore) {
    SharedScene shared("quadric_sphere.rib");
    const SharedFrame& frame = *shared.frame;
    const auto samplers = samplers_of({"raytrace", "raytrace:tree=loose"});  // voxels are there in any case
    const size_t few = bytes_for_few(frame, samplers);
    shared.frame->memory_budget = few;
    EXPECT_EQ(measure(frame, samplers, {{1, 1}}, {1}).size(), 2u);
    EXPECT_EQ(shared.diagnostics.count(Severity::Warning), 1u) << shared.messages;
    EXPECT_NE(shared.messages.find("raytrace:tree=loose may take"), std::string::npos) << shared.messages;
    shared.frame->memory_budget = frame.grids.bytes();
    measure(frame, samplers, {{1, 1}}, {1});
    EXPECT_EQ(shared.diagnostics.count(Severity::Warning), 3u);
}

TEST(ResultsJson, HasWhatTheResultSays) {
    const SharedScene shared("quadric_sphere.rib");
    const auto results = measure(*shared.frame, samplers_of({"raytrace"}), {{2, 2}}, {3});
    const auto json = to_json(results.at(0));
    EXPECT_EQ(json["method"], "raytrace");
    EXPECT_EQ(json["build_seconds_by_round"].size(), 3u);
    EXPECT_EQ(json["total_seconds"].get<double>(), results[0].total_median());
    EXPECT_EQ(json["total_seconds_least"].get<double>(), results[0].total_spread().least);
    EXPECT_EQ(json["total_seconds_most"].get<double>(), results[0].total_spread().most);
    EXPECT_EQ(json["predicate_tests"].get<uint64_t>(), results[0].sample.predicate_tests);
    EXPECT_GT(json["bytes_per_micropolygon"].get<double>(), 0);
}

}  // namespace
}  // namespace trapeze
