#include "pipeline/study/study.h"
#include "pipeline/study/study_names.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>

#include "pipeline/study/paper_figures.h"
#include "pipeline/study/study_scenes.h"

namespace trapeze {
namespace {

struct Bench {
    std::string messages;
    Diagnostics diagnostics{[this](const Diagnostic& d) { messages += to_string(d) + "\n"; }};
    StudySettings settings;
    StudyResult result;
};

StudyScene tiny() {
    StudyScene scene{"Furball", "hair", {}};
    scene.parameters.scale = .05, scene.parameters.width = 64, scene.parameters.height = 36;
    return scene;
}

TEST(StudyBench, MeasuresAMadeSceneAndKeepsTheFigures) {
    Bench b;
    b.settings.rounds = 2;
    std::vector<std::string> lines;
    b.settings.on_figure = [&](const std::string& line) { lines.push_back(line); };
    StudyBench bench(b.settings, b.diagnostics, b.result);
    const SharedFrame frame = bench.frame(tiny());
    EXPECT_EQ(b.messages, "");
    EXPECT_GT(bench.last_facts().micropolygons, 1000u);
    EXPECT_GT(bench.last_facts().largest_motion, 0.5f);
    const auto results = bench.measure(frame, tiny(), "raytrace interval", {{1, 1}, {2, 2}});
    ASSERT_EQ(results.size(), 4u);
    EXPECT_EQ(results[3].method, "interval");
    EXPECT_EQ(results[3].build_seconds.size(), 2u);
    ASSERT_EQ(b.result.figures.size(), 4u);
    EXPECT_EQ(b.result.figures[2]["scene"], "trapeze scene hair -r 64x36 --scale 0.05");
    ASSERT_EQ(lines.size(), 4u);
    EXPECT_TRUE(lines[3].starts_with("Furball, 2x2 interval: build ")) << lines[3];
}

TEST(StudyBench, RendersWholeFramesAndKeepsTheirFacts) {
    Bench b;
    StudyBench bench(b.settings, b.diagnostics, b.result);
    const FrameStats stats = bench.render(tiny(), {3, 2});
    EXPECT_EQ(b.messages, "");
    EXPECT_EQ(stats.samples, 66u * 38 * 6) << "the filter's margin, too";
    EXPECT_GE(stats.seconds.total, stats.seconds.tessellate + stats.seconds.trace);
    EXPECT_GT(bench.last_facts().micropolygons, 1000u);
    EXPECT_FALSE(bench.last_facts().blur_is_known());
}

/// Frames as large as the paper's would take a test too long: those of quick studies.
TEST(StudyScenes, FramesHaveThePapersProportions) {
    Bench b;
    b.settings.quick = true;
    StudyBench bench(b.settings, b.diagnostics, b.result);
    size_t i = 0;
    for (const StudyScene& scene : frames_of_the_paper(bench)) {
        const FrameStats stats = bench.render(scene, {1, 1});
        EXPECT_EQ(scene.label, paper::kScenes[i]);
        EXPECT_EQ(stats.width, 1280 / 4);
        EXPECT_EQ(stats.height, paper::kHeight[i++] / 4);
    }
    EXPECT_EQ(b.messages, "");
}

TEST(StudyBench, StopsWhenCancelledOrOutOfMemory) {
    Bench b;
    std::atomic<bool> cancelled = true;
    b.settings.cancelled = &cancelled;
    StudyBench bench(b.settings, b.diagnostics, b.result);
    EXPECT_THROW(bench.frame(tiny()), StudyStopped);
    cancelled = false;
    b.settings.memory_bytes = 1000;
    EXPECT_THROW(bench.frame(tiny()), StudyStopped);
    EXPECT_NE(b.messages.find("budget"), std::string::npos) << b.messages;
}

TEST(StudyScenes, AllCanBeMade) {
    Bench b;
    const StudyBench bench(b.settings, b.diagnostics, b.result);
    const auto names = scene_names();
    for (const StudyScene& scene : scenes_of_the_paper(bench))
        EXPECT_EQ(std::count(names.begin(), names.end(), scene.name), 1) << scene.label;
    EXPECT_EQ(std::count(names.begin(), names.end(), halberd_scene(bench).name), 1);
}

TEST(StudyBench, TakesTheScenesThatAreAskedFor) {
    Bench b;
    b.settings.scenes = {"hAIR", "sponza"};
    StudyBench bench(b.settings, b.diagnostics, b.result);
    bench.offer_scenes({"Hairball", "Hairball that swings far", "Rotated Sponza", "Hand"});
    EXPECT_TRUE(bench.takes("Hairball"));
    EXPECT_TRUE(bench.takes("Hairball that swings far"));
    EXPECT_TRUE(bench.takes("Rotated Sponza"));
    EXPECT_FALSE(bench.takes("Hand"));
    EXPECT_EQ(b.messages, "");
    EXPECT_NO_THROW(bench.frame(tiny()));
    EXPECT_THROW(bench.offer_scenes({"Hairball", "Hand"}), StudyStopped);
    EXPECT_EQ(b.messages, "error: study  has no scene \"sponza\"; it has: Hairball, Hand\n");
}

TEST(StudyBench, TakesAllScenesUnlessAskedForSome) {
    Bench b;
    StudyBench bench(b.settings, b.diagnostics, b.result);
    EXPECT_TRUE(bench.takes("Hand"));
}

/// Before anything is measured.
TEST(Study, UnknownScenesAreErrors) {
    for (const StudyName& study : study_names()) {
        Bench b;
        b.settings.scenes = {"nowhere"};
        EXPECT_FALSE(run_study(study.name, b.settings, b.diagnostics)) << study.name;
        EXPECT_TRUE(b.diagnostics.kinds().contains(kNoSuchScene)) << study.name << b.messages;
    }
}

TEST(Study, UnknownNamesGiveNothing) {
    Bench b;
    EXPECT_FALSE(run_study("table6", b.settings, b.diagnostics));
}

TEST(Study, CancelledStudiesGiveNothing) {
    Bench b;
    std::atomic<bool> cancelled = true;
    b.settings.cancelled = &cancelled;
    for (const StudyName& study : study_names())
        EXPECT_FALSE(run_study(study.name, b.settings, b.diagnostics));
}

}  // namespace
}  // namespace trapeze
