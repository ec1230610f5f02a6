/// All trees on all scenes: still, moving, and moving with defocus; and on one scene from few micropolygons
/// to many.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "pipeline/compare/value_text.h"
#include "pipeline/study/structure_words.h"
#include "pipeline/study/studies.h"

namespace trapeze {
namespace {

/// A tree that took longer, to be built and for its rays, takes no other turn in that scene, and has no part
/// in the same scene with more blur or more micropolygons: it would take hours.
double longest_turn(const StudyBench& bench) {
    return bench.quick() ? 10 : 60;
}

struct Blur {
    const char* name;
    float motion, defocus;
};
constexpr Blur kBlurs[] = {{"still", 0, 0}, {"moving", 1, 0}, {"moving and out of focus", 1, 1}};
constexpr const Blur& kBothBlurs = kBlurs[2];

/// A scene, and what its own micropolygons are multiplied by.
struct StructureScene {
    const char *label, *name;
    double scale;
};
constexpr StructureScene kStructureScenes[] = {
    {"Halberd", "halberd", 1}, {"Car", "car-study", .25}, {"Flowers", "flowers", 1},
    {"Hair", "hair", .5},      {"Building", "arcade", 4}, {"Falling flakes", "falling", 4},
};
/// Of the halberd, times its own micropolygons: from some tenth of a million to tens of millions at full
/// size.
constexpr const char* kSizesLabel = "Sizes of the halberd";
constexpr double kSizes[] = {.1, .5, 2, 8, 20};

/// The trees that the program offers, each as it is by default.
std::vector<std::string> all_trees() {
    std::vector<std::string> trees;
    for (const SpecOption& option : find_named(visibility_methods(), "raytrace")->options)
        if (option.name == "tree") trees.assign(option.values.begin(), option.values.end());
    return trees;
}

StudyScene study_scene(const StudyBench& bench, const StructureScene& scene, const Blur& blur, double times) {
    StudyScene made =
        bench.scene(fmt::format("{}, {}", scene.label, blur.name), scene.name, scene.scale * times);
    made.parameters.motion = blur.motion, made.parameters.defocus = blur.defocus;
    if (made.name == "falling") made.parameters.time = 1;
    return made;
}

/// Measures trees on a scene, whose facts are then the bench's last.
StructureRun run_structures(StudyBench& bench, const StructureScene& scene, const Blur& blur, double times,
                            const std::vector<std::string>& trees) {
    const StudyScene made = study_scene(bench, scene, blur, times);
    const SharedFrame frame = bench.frame(made);
    std::string methods;
    for (const std::string& tree : trees) methods += "raytrace:tree=" + tree + " ";
    const SampleRate rate = bench.quick() ? SampleRate{1, 1} : SampleRate{2, 2};
    StructureRun run{scene.label, blur.name, 0, {}};
    const auto results = bench.measure(frame, made, methods, {rate}, {.longest_turn = longest_turn(bench)});
    for (size_t i = 0; i < results.size(); ++i) {
        const MethodResult& m = results[i];
        run.rays_per_micropolygon = static_cast<double>(m.sample.rays) / static_cast<double>(m.micropolygons);
        run.trees.push_back({trees[i], m.build_median(), m.resolve_median(), m.bytes_per_micropolygon(),
                             m.tests_per_sample(), m.nodes_per_sample()});
    }
    return run;
}

StudyTable table_of(const StructureRun& run, const StudySceneFacts& facts) {
    StudyTable table{fmt::format("{}, {}: {} micropolygons, {} rays each", run.scene, run.blur,
                                 count_text(static_cast<double>(facts.micropolygons)),
                                 number_text(run.rays_per_micropolygon)),
                     {"", "build", "trace", "total", "bytes a micropolygon", "tests a ray", "nodes a ray"},
                     {}};
    for (const StructureCosts& tree : run.trees)
        table.rows.push_back({tree.tree, seconds_text(tree.build), seconds_text(tree.trace),
                              seconds_text(tree.total()), number_text(tree.bytes), number_text(tree.tests),
                              number_text(tree.nodes)});
    return table;
}

/// Takes those out of the trees that were too slow, and says so.
void leave_slow_ones(const StudyBench& bench, const StructureRun& run, std::vector<std::string>& trees,
                     StudyResult& result) {
    for (const StructureCosts& tree : run.trees) {
        // All are measured beside the wide tree, which is the program's own.
        if (tree.tree == "wide" || tree.total() <= longest_turn(bench)) continue;
        std::erase(trees, tree.tree);
        result.notes.push_back(
            fmt::format("{} took {} on {}, {}, of {} micropolygons, and has no part in what follows of "
                        "that scene.",
                        tree.tree, seconds_text(tree.total()), run.scene, run.blur,
                        count_text(static_cast<double>(bench.last_facts().micropolygons))));
    }
}

/// The halberd at all sizes.
std::vector<StructureRun> run_sizes(StudyBench& bench, StudyResult& result) {
    std::vector<std::string> trees = all_trees();
    LinePlot build{
        "Building against micropolygons", "log10 of micropolygons", "nanoseconds a micropolygon", {}},
        trace{"Rays against micropolygons", "log10 of micropolygons", "nanoseconds a ray", {}};
    for (const std::string& tree : trees)
        build.series.push_back({tree, {}}), trace.series.push_back({tree, {}});
    std::vector<StructureRun> runs;
    for (const double size : kSizes) {
        const StructureRun& run =
            runs.emplace_back(run_structures(bench, kStructureScenes[0], kBothBlurs, size, trees));
        const StudySceneFacts& facts = bench.last_facts();
        result.tables.push_back(table_of(run, facts));
        const auto micropolygons = static_cast<double>(facts.micropolygons);
        for (const StructureCosts& tree : run.trees) {
            const auto add = [&](LinePlot& plot, double seconds, double count) {
                std::ranges::find(plot.series, tree.tree, &PlotSeries::name)
                    ->points.emplace_back(std::log10(micropolygons), 1e9 * seconds / count);
            };
            add(build, tree.build, micropolygons);
            add(trace, tree.trace, micropolygons * run.rays_per_micropolygon);
        }
        leave_slow_ones(bench, run, trees, result);
    }
    result.plots = {std::move(build), std::move(trace)};
    return runs;
}

/// Whether the tree that the program takes by itself is the right one for a kind of blur.
StudyCheck check_of_own_tree(const std::vector<StructureRun>& runs, const Blur& blur) {
    double least = std::numeric_limits<double>::infinity();
    std::string where;
    for (const StructureRun& run : runs) {
        if (run.blur != blur.name) continue;
        const auto own = std::ranges::find(run.trees, "wide", &StructureCosts::tree);
        for (const StructureCosts& tree : run.trees)
            if (tree.tree != own->tree && tree.total() / own->total() < least)
                least = tree.total() / own->total(), where = fmt::format("{} on {}", tree.tree, run.scene);
    }
    return {fmt::format("{}: no tree takes less for building and rays than wide", blur.name), "-",
            fmt::format("{}x ({})", number_text(least), where), least >= 1};
}

}  // namespace

void study_structures(StudyBench& bench, StudyResult& result) {
    result.notes.push_back(
        "Each tree as it is by default. wide takes bundles of rays in vectors; paper, interpolated, msbvh, lbvh "
        "and refit leave out for each tile what its beam does not meet, then take rays one by one; mbkd, gs, "
        "dynamic and loose take rays one by one.");
    std::vector<std::string> labels;
    for (const StructureScene& scene : kStructureScenes) labels.emplace_back(scene.label);
    labels.emplace_back(kSizesLabel);
    bench.offer_scenes(labels);
    std::vector<StructureRun> runs;
    for (const StructureScene& scene : kStructureScenes) {
        if (!bench.takes(scene.label)) continue;
        std::vector<std::string> trees = all_trees();
        for (const Blur& blur : kBlurs) {
            runs.push_back(run_structures(bench, scene, blur, 1, trees));
            result.tables.push_back(table_of(runs.back(), bench.last_facts()));
            leave_slow_ones(bench, runs.back(), trees, result);
        }
    }
    if (!runs.empty())
        for (const Blur& blur : kBlurs) result.checks.push_back(check_of_own_tree(runs, blur));
    if (bench.takes(kSizesLabel))
        for (StructureRun& run : run_sizes(bench, result)) runs.push_back(std::move(run));
    for (std::string& words : words_on_structures(runs)) result.notes.push_back(std::move(words));
}

}  // namespace trapeze
