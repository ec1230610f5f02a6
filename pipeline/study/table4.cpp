/// Table 4: the paper's structure against others, and without each of its parts [Hou10 sec. 5.1].
#include <fmt/format.h>

#include "pipeline/compare/comparison.h"
#include "pipeline/compare/value_text.h"
#include "pipeline/study/paper_figures.h"
#include "pipeline/study/shape_checks.h"
#include "pipeline/study/studies.h"
#include "pipeline/study/study_scenes.h"

namespace trapeze {
namespace {

/// A row of the table: the methods that stand for one of the paper's structures, for moving and for still
/// scenes; empty where the paper has no figure.
struct Alternative {
    const char *name, *moving, *still;
};

// Every ray from the root, as in the paper.
#define PAPER_TREE "raytrace:tree=paper,bundle=off"
constexpr Alternative kAlternatives[] = {
    {"Ours: OBB hyper-trapezoids", PAPER_TREE, PAPER_TREE},
    {"AABB hyper-trapezoids", PAPER_TREE ",bounds=aabb", ""},
    {"3D/4D AABB", PAPER_TREE ",bounds=aabb4d", PAPER_TREE ",bounds=aabb"},
    {"No parametric-space split", PAPER_TREE ",split=sah", PAPER_TREE ",split=sah"},
    {"No orientation-aware split", PAPER_TREE ",orient_split=off", PAPER_TREE ",orient_split=off"},
    {"No orientation propagation", PAPER_TREE ",orient_propagation=off",
     PAPER_TREE ",orient_propagation=off"},
    {"No ray sort", PAPER_TREE ",ray_sort=off", PAPER_TREE ",ray_sort=off"}};
#undef PAPER_TREE
constexpr size_t kOurs = 0, kAxisAlignedHyper = 1, kWholeMotion = 2, kGreedySah = 3;

/// Ours, the wide tree, is not of the paper: a row for orientation.
constexpr const char* kWide = "raytrace";

/// What was measured on one scene.
struct SceneRun {
    std::string label;
    bool moves = false;
    std::vector<MethodResult> results;  ///< of the alternatives that there are; the wide tree's last
    std::vector<int> index;             ///< alternative -> result, or -1

    const MethodResult* of(size_t alternative) const {
        return index[alternative] < 0 ? nullptr : &results[static_cast<size_t>(index[alternative])];
    }
};

SceneRun run_scene(StudyBench& bench, const StudyScene& scene, SampleRate rate) {
    SceneRun run{scene.label, scene.parameters.motion > 0, {}, {}};
    std::string methods;
    int count = 0;
    for (const Alternative& alternative : kAlternatives) {
        const std::string method = run.moves ? alternative.moving : alternative.still;
        run.index.push_back(method.empty() ? -1 : count++);
        if (!method.empty()) methods += method + " ";
    }
    const SharedFrame frame = bench.frame(scene);
    run.results = bench.measure(frame, scene, methods + kWide, {rate});
    return run;
}

void add_times(StudyResult& result, const std::vector<SceneRun>& runs, bool of_paper) {
    StudyTable table{
        of_paper ? "Build and trace times, the paper's" : "Build and trace times, measured here", {""}, {}};
    for (const SceneRun& run : runs) table.columns.push_back(run.label);
    for (size_t a = 0; a < std::size(kAlternatives); ++a)
        for (const bool trace : {false, true}) {
            std::vector<std::string> row{kAlternatives[a].name + std::string(trace ? ", trace" : ", build")};
            for (size_t s = 0; s < runs.size(); ++s) {
                const MethodResult* here = runs[s].of(a);
                const paper::BuildTrace& printed = paper::kTable4[a][s];
                if (of_paper)
                    row.push_back(paper_seconds(trace ? printed.trace : printed.build));
                else
                    row.push_back(
                        !here ? "-" : seconds_text(trace ? here->resolve_median() : here->build_median()));
            }
            table.rows.push_back(row);
        }
    if (!of_paper)
        for (const bool trace : {false, true}) {
            std::vector<std::string> row{trace ? "Trapeze's wide tree, trace" : "Trapeze's wide tree, build"};
            for (const SceneRun& run : runs) {
                const MethodResult& wide = run.results.back();
                row.push_back(seconds_text(trace ? wide.resolve_median() : wide.build_median()));
            }
            table.rows.push_back(row);
        }
    result.tables.push_back(table);
}

void add_counts(StudyResult& result, const std::vector<SceneRun>& runs) {
    StudyTable table{"Nodes visited and micropolygons tested, a ray", {""}, {}};
    for (const SceneRun& run : runs) table.columns.push_back(run.label);
    for (size_t a = 0; a < std::size(kAlternatives); ++a) {
        std::vector<std::string> row{kAlternatives[a].name};
        for (const SceneRun& run : runs) {
            const MethodResult* here = run.of(a);
            row.push_back(!here ? "-"
                                : fmt::format("{} / {}", number_text(here->nodes_per_sample()),
                                              number_text(here->tests_per_sample())));
        }
        table.rows.push_back(row);
    }
    result.tables.push_back(table);
}

/// What the counts say of why one structure traces as fast as another.
std::string why(const MethodResult& ours, const MethodResult& other) {
    const auto a_node = [](const MethodResult& r) {
        return r.resolve_median() / static_cast<double>(std::max<uint64_t>(1, r.sample.nodes_visited));
    };
    return fmt::format(
        "it visits {}x the nodes and tests {}x the micropolygons of ours; a node visited takes {}x the "
        "time of one of ours, tests included",
        number_text(other.nodes_per_sample() / ours.nodes_per_sample()),
        number_text(other.tests_per_sample() / ours.tests_per_sample()),
        number_text(a_node(other) / a_node(ours)));
}

/// That the alternative traces more slowly, by at least the paper's ratio.
StudyCheck bounds_check(const SceneRun& run, size_t scene, size_t alternative) {
    const MethodResult &ours = *run.of(kOurs), &other = *run.of(alternative);
    const paper::BuildTrace &printed = paper::kTable4[alternative][scene],
                            &printed_ours = paper::kTable4[kOurs][scene];
    const double here = other.resolve_median() / ours.resolve_median(),
                 there = printed.trace / printed_ours.trace;
    const std::string name =
        alternative == kWholeMotion ? (run.moves ? "4D AABBs" : "3D AABBs") : "AABB hyper-trapezoids";
    StudyCheck check = check_of_bounds(run.label, name, here, there);
    check.why = why(ours, other);
    return check;
}

StudyCheck parametric_check(const SceneRun& run, size_t scene) {
    const MethodResult &ours = *run.of(kOurs), &greedy = *run.of(kGreedySah);
    const paper::BuildTrace &printed = paper::kTable4[kGreedySah][scene],
                            &printed_ours = paper::kTable4[kOurs][scene];
    StudyCheck check = check_of_parametric_splits(
        run.label,
        {greedy.build_median() / ours.build_median(), greedy.resolve_median() / ours.resolve_median()},
        {printed.build / printed_ours.build, printed.trace / printed_ours.trace});
    check.why = why(ours, greedy);
    return check;
}

}  // namespace

void study_table4(StudyBench& bench, StudyResult& result) {
    const SampleRate rate = bench.quick() ? SampleRate{2, 2} : SampleRate{4, 4};
    result.notes.push_back(
        "At " + rate_text(rate) +
        " samples a pixel (the paper's are at 13x13 and 23x23): trace time is in proportion to rays.");
    result.notes.push_back(
        "All but the wide tree are the paper's binary tree over micropolygons, every ray from its root.");
    std::vector<SceneRun> runs;
    for (const StudyScene& scene : scenes_of_the_paper(bench)) runs.push_back(run_scene(bench, scene, rate));
    add_times(result, runs, false);
    add_times(result, runs, true);
    add_counts(result, runs);
    for (size_t s = 0; s < runs.size(); ++s) {
        if (runs[s].moves) result.checks.push_back(bounds_check(runs[s], s, kAxisAlignedHyper));
        result.checks.push_back(bounds_check(runs[s], s, kWholeMotion));
        result.checks.push_back(parametric_check(runs[s], s));
    }
}

}  // namespace trapeze
