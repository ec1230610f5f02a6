/// What the papers on trees for what moves measured: interpolated boxes, spatial splits, the k-d tree, beside
/// the trees of Hou et al., on the same rays [Gruenschloss11 table 1 and figure 1; Yang17 tables 1 to 3 and
/// figures 4 and 5].
#include <fmt/format.h>

#include <algorithm>
#include <numeric>

#include "pipeline/compare/pictures.h"
#include "pipeline/compare/value_text.h"
#include "pipeline/study/lost_hits.h"
#include "pipeline/study/moving_checks.h"
#include "pipeline/study/refitting.h"
#include "pipeline/study/studies.h"

namespace trapeze {
namespace {

/// A row of the tables; rays go one by one where a tree lets them.
struct TreeRow {
    const char *name, *method;
};

constexpr TreeRow kBaseline{"interpolated boxes", "raytrace:tree=interpolated,bundle=off"},
    kSplits{"MSBVH", "raytrace:tree=msbvh,bundle=off"}, kKdTree{"MBKD", "raytrace:tree=mbkd"},
    kPaperTree{"hyper-trapezoids", "raytrace:tree=paper,bundle=off"},
    kWideTree{"Trapeze's wide tree", "raytrace"};

/// Rows, of which the first is interpolated boxes.
using TreeRows = std::vector<TreeRow>;

/// One of a paper's scenes; not one of them, where `of_paper` is kMovingScenes.
struct MovingStudyScene {
    StudyScene scene;
    paper::MovingScene of_paper;
};

/// A micropolygon is a primitive of the papers' where ShadingRate is this large.
std::vector<MovingStudyScene> moving_scenes(const StudyBench& bench) {
    std::vector<MovingStudyScene> scenes = {
        {bench.scene("Hairball", "hair", 2.2), paper::kHairball},
        {bench.scene("Hairball that swings far", "hair", 2.2), paper::kMovingScenes},
        {bench.scene("Rotated Sponza", "arcade", 1), paper::kRotatedSponza},
        {bench.scene("Falling triangles", "falling", 1), paper::kMovingScenes},
        {bench.scene("Turning pinwheels", "pinwheels", 1), paper::kMovingScenes},
        {bench.scene("Bubbles", "bubbles", 4), paper::kBubs},
        {bench.scene("Crocodile", "crocodile", 4), paper::kCroc},
        {bench.scene("Hand", "hand", 3), paper::kHand},
        {bench.scene("Snow crystals", "snowflakes", 1), paper::kFlake}};
    for (MovingStudyScene& s : scenes) {
        SceneParameters& p = s.scene.parameters;
        p.defocus = 0;
        if (s.scene.name == "hair") p.shading_rate = 44;
        p.width = bench.quick() ? 256 : 512, p.height = p.width;
    }
    scenes[0].scene.parameters.motion = scenes[2].scene.parameters.motion = .1;
    scenes[3].scene.parameters.time = 1;
    return scenes;
}

std::vector<std::string> labels_of(const std::vector<MovingStudyScene>& scenes) {
    std::vector<std::string> labels;
    for (const MovingStudyScene& scene : scenes) labels.push_back(scene.scene.label);
    return labels;
}

/// Whose costs are set beside a paper's: one ray a sample, or an occlusion ray from where it ends, too.
enum class RaysThatCount { Camera, CameraAndOcclusion };

/// What was measured on one scene, by row.
struct MovingRun {
    MovingStudyScene scene;
    std::vector<MethodResult> results;
    std::vector<HeatMap> heat;
    /// Pixels that are not as the first row has them, by row.
    std::vector<size_t> pixels_off;
    RaysThatCount rays;

    const std::string& label() const { return scene.scene.label; }
};

SampleRate rate_of_moving(const StudyBench& bench) {
    return bench.quick() ? SampleRate{2, 2} : SampleRate{4, 4};
}

MethodPicture picture_of(const StudyBench& bench, const SharedFrame& frame, const Sampler& sampler) {
    bench.go_on();
    auto picture = make_picture(frame, sampler, rate_of_moving(bench), bench.on_progress());
    if (!picture) throw StudyStopped();
    return std::move(*picture);
}

/// Figure 3, and whether it is as the paper says; `right`: what the first row shows.
void add_lost_hits(const StudyBench& bench, StudyResult& result, const SharedFrame& frame,
                   const MovingRun& run, const Image& right) {
    std::string error;
    const auto sampler = choose_sampler("raytrace:tree=msbvh,clip=naive,bundle=off", "", &error);
    const Image wrong = picture_of(bench, frame, sampler.value()).image;
    result.close_ups.push_back(pictures_of_lost_hits(run.label(), right, wrong));
    result.checks.push_back(check_of_naive_clipping(
        run.label(),
        {pixels_that_differ(right, wrong), *std::max_element(run.pixels_off.begin(), run.pixels_off.end()),
         right.rgba.size() / 4}));
}

MovingRun run_moving_scene(StudyBench& bench, StudyResult& result, const MovingStudyScene& scene,
                           const TreeRows& rows, RaysThatCount rays) {
    MovingRun run{scene, {}, {}, {}, rays};
    std::string methods;
    for (const TreeRow& row : rows) methods += std::string(row.method) + " ";
    const SharedFrame frame = bench.frame(scene.scene);
    run.results = bench.measure(frame, scene.scene, methods, {rate_of_moving(bench)}, {.occlusion = true});
    bench.stage("heat maps of " + run.label());
    Image right;
    for (const MethodResult& row : run.results) {
        MethodPicture picture = picture_of(bench, frame, row.sampler);
        run.heat.push_back(std::move(picture.heat));
        if (right.rgba.empty()) right = picture.image;
        run.pixels_off.push_back(pixels_that_differ(right, picture.image));
    }
    const bool is_figure_3 = scene.scene.name == "pinwheels" && rays == RaysThatCount::CameraAndOcclusion;
    if (is_figure_3) add_lost_hits(bench, result, frame, run, right);
    return run;
}

/// Sums of a pixel's rays, as the papers have them.
std::string maximum_and_average(const std::vector<float>& map, const std::vector<float>& samples) {
    double sum = 0;
    float most = 0;
    for (size_t i = 0; i < map.size(); ++i) {
        const float of_pixel = map[i] * samples[i];
        sum += static_cast<double>(of_pixel), most = std::max(most, of_pixel);
    }
    return fmt::format("{} / {}", number_text(static_cast<double>(most)),
                       number_text(sum / static_cast<double>(std::max<size_t>(1, map.size()))));
}

StudyTable tree_table(const MovingRun& run, const TreeRows& rows) {
    StudyTable table{run.label(),
                     {"", "references", "duplicates", "nodes", "splits", "SAH cost", "MB", "build", "trace",
                      "tests a ray", "nodes a ray", "tests a pixel, max / mean", "nodes a pixel, max / mean",
                      "trace occlusion", "tests an occlusion ray", "nodes an occlusion ray"},
                     {}};
    for (size_t r = 0; r < rows.size(); ++r) {
        const MethodResult& m = run.results[r];
        const auto count = [](uint64_t n) {
            return n == 0 ? std::string("-") : count_text(static_cast<double>(n));
        };
        table.rows.push_back(
            {rows[r].name, count(m.build.tree_references), count(m.build.tree_duplicates),
             count(m.build.tree_nodes), count(m.build.tree_splits), counted_text(m.build.tree_sah_cost),
             number_text(static_cast<double>(m.build.tree_bytes) / 1e6), seconds_text(m.build_median()),
             seconds_text(m.resolve_median()), number_text(m.tests_per_sample()),
             number_text(m.nodes_per_sample()), maximum_and_average(run.heat[r].tests, run.heat[r].samples),
             maximum_and_average(run.heat[r].nodes, run.heat[r].samples), seconds_text(m.occlusion_median()),
             number_text(m.tests_per_occlusion_ray()), number_text(m.nodes_per_occlusion_ray())});
    }
    return table;
}

/// Where the time of building goes, of trees that tell it.
StudyTable phase_table(const std::vector<MovingRun>& runs, const TreeRows& rows) {
    StudyTable table{
        "Phases of building",
        {"", "bounding micropolygons", "dividing", "of it cutting", "bounding nodes, making lists"},
        {}};
    const auto percent = [](double part) { return fmt::format("{:.0f} %", 100 * part); };
    for (const MovingRun& run : runs)
        for (size_t r = 0; r < rows.size(); ++r) {
            const BuildPhases& phases = run.results[r].build.phases;
            const double all = phases.told();
            if (!(all > 0)) continue;
            table.rows.push_back({run.label() + ", " + rows[r].name, percent(phases.prepare / all),
                                  percent(phases.divide / all),
                                  phases.divide_work > 0 ? percent(phases.cut_share()) : "-",
                                  percent(phases.bound / all)});
        }
    return table;
}

/// What moves across the planes of a k-d tree, and what it costs to build.
StudyTable incoherence_table(const std::vector<MovingRun>& runs, size_t row) {
    StudyTable table{"What moves across planes [Yang17 table 2]",
                     {"", "duplicated for it", "the paper's", "such duplicates a micropolygon",
                      "all duplicates a micropolygon", "putting on sides, of dividing",
                      "duplicating and propagating, the paper's"},
                     {}};
    const auto percent = [](double part) {
        return std::isnan(part) ? std::string("-") : fmt::format("{:.1f} %", 100 * part);
    };
    for (const MovingRun& run : runs) {
        const BuildStats& build = run.results[row].build;
        const auto each = [&](uint64_t n) {
            return static_cast<double>(n) /
                   static_cast<double>(std::max<uint64_t>(1, build.tree_references - build.tree_duplicates));
        };
        const bool in_paper = run.scene.of_paper != paper::kMovingScenes;
        const paper::Incoherence paper =
            in_paper ? paper::kIncoherence[run.scene.of_paper] : paper::kNoIncoherence;
        table.rows.push_back({run.label(), percent(each(build.tree_incoherent)), percent(paper.quantity),
                              number_text(each(build.tree_guests)), number_text(each(build.tree_duplicates)),
                              percent(build.phases.cut_share()),
                              percent(paper.duplicating + paper.propagating)});
    }
    return table;
}

/// A row's figures by those of interpolated boxes.
paper::TreeRatios ratios_of(const MovingRun& run, size_t row) {
    const MethodResult &one = run.results[row], &base = run.results[0];
    const auto of = [](uint64_t a, uint64_t b) { return static_cast<double>(a) / static_cast<double>(b); };
    const bool both = run.rays == RaysThatCount::CameraAndOcclusion;
    const auto sum = [&](const MethodResult& m, uint64_t SampleStats::*count) {
        return m.sample.*count + (both ? m.occlusion.*count : 0);
    };
    const auto seconds = [&](const MethodResult& m) {
        return m.resolve_median() + (both ? m.occlusion_median() : 0);
    };
    return {
        of(one.build.tree_references, base.build.tree_references),
        of(one.build.tree_nodes, base.build.tree_nodes),
        of(sum(one, &SampleStats::predicate_tests), sum(base, &SampleStats::predicate_tests)),
        of(sum(one, &SampleStats::nodes_visited), sum(base, &SampleStats::nodes_visited)),
        seconds(one) / seconds(base),
        one.build_median() / base.build_median(),
        of(one.build.tree_bytes, base.build.tree_bytes),
        one.build.tree_sah_cost > 0 ? one.build.tree_sah_cost / base.build.tree_sah_cost : paper::kNoFigure};
}

std::vector<std::string> ratio_cells(const std::string& name, const paper::TreeRatios& r) {
    std::vector<std::string> cells{name};
    for (const double ratio : {r.references, r.nodes, r.tests, r.steps, r.time, r.build, r.bytes, r.sah})
        cells.push_back(std::isnan(ratio) ? "-" : number_text(ratio) + "x");
    return cells;
}

/// Ratios to interpolated boxes, ours and the paper's in turn.
void add_ratios(StudyResult& result, const std::vector<MovingRun>& runs, size_t row, const char* name,
                const paper::TreeRatios* of_paper) {
    StudyTable table{
        fmt::format("{} beside interpolated boxes", name),
        {"", "references", "nodes", "tests", "steps", "render time", "build time", "bytes", "SAH cost"},
        {}};
    for (const MovingRun& run : runs) {
        table.rows.push_back(ratio_cells(run.label(), ratios_of(run, row)));
        if (run.scene.of_paper == paper::kMovingScenes) continue;
        const auto cells = ratio_cells(run.label() + ", the paper's", of_paper[run.scene.of_paper]);
        const auto has_figure = [](const std::string& cell) { return cell != "-"; };
        if (std::any_of(cells.begin() + 1, cells.end(), has_figure)) table.rows.push_back(cells);
    }
    result.tables.push_back(table);
}

/// Heat maps of some rows on one scale for tests, and on one for nodes.
void add_heat(StudyResult& result, MovingRun& run, const TreeRows& rows, const std::vector<size_t>& shown) {
    for (const bool of_tests : {true, false}) {
        StudyHeatMaps& maps = result.heat_maps.emplace_back();
        maps.title = fmt::format("{}: {} a ray", run.label(), of_tests ? "tests" : "nodes visited");
        maps.width = run.heat[0].pixels.width(), maps.height = run.heat[0].pixels.height();
        for (const size_t row : shown)
            maps.maps.emplace_back(
                rows[row].name, of_tests ? std::move(run.heat[row].tests) : std::move(run.heat[row].nodes));
    }
}

void add_moving_notes(const StudyBench& bench, StudyResult& result, RaysThatCount rays) {
    result.notes.push_back(fmt::format(
        "{} camera rays a pixel, and an occlusion ray from what each of them sees, in a random direction; "
        "what stands beside the paper's figures is of {}. Most of a pixel is of its camera rays alone.",
        bench.quick() ? 4 : 16, rays == RaysThatCount::Camera ? "camera rays alone" : "both kinds together"));
    result.notes.push_back(
        "A primitive is a micropolygon, of which a large ShadingRate makes one of each piece of geometry.");
    result.notes.push_back(
        "All but the wide tree take rays one by one; the scenes are made, in the kind of the papers'.");
}

/// Measures the rows on the scenes that are taken, and adds what is told of any structure, here that of one
/// row.
std::vector<MovingRun> run_all(StudyBench& bench, StudyResult& result, const TreeRows& rows, size_t row,
                               const paper::TreeRatios* of_paper, RaysThatCount rays) {
    add_moving_notes(bench, result, rays);
    std::vector<MovingRun> runs;
    for (const MovingStudyScene& scene : moving_scenes(bench))
        if (bench.takes(scene.scene.label))
            runs.push_back(run_moving_scene(bench, result, scene, rows, rays));
    for (const MovingRun& run : runs) result.tables.push_back(tree_table(run, rows));
    result.tables.push_back(phase_table(runs, rows));
    add_ratios(result, runs, row, rows[row].name, of_paper);
    for (MovingRun& run : runs) add_heat(result, run, rows, {0, row});
    return runs;
}

void add_checks(StudyResult& result, std::vector<StudyCheck> checks) {
    std::ranges::move(checks, std::back_inserter(result.checks));
}

}  // namespace

void study_msbvh(StudyBench& bench, StudyResult& result) {
    std::vector<std::string> labels = labels_of(moving_scenes(bench));
    labels.emplace_back(kHairOverFrames);
    bench.offer_scenes(labels);
    const TreeRows rows = {kBaseline,
                           kSplits,
                           {"MSBVH, equation 1", "raytrace:tree=msbvh,clip=box,bundle=off"},
                           {"linear, by Morton codes", "raytrace:tree=lbvh,bundle=off"},
                           kPaperTree,
                           kWideTree};
    for (const MovingRun& run :
         run_all(bench, result, rows, 1, paper::kMsbvh, RaysThatCount::CameraAndOcclusion))
        if (run.scene.of_paper != paper::kMovingScenes)
            add_checks(result, checks_of_spatial_splits(run.label(), ratios_of(run, 1),
                                                        paper::kMsbvh[run.scene.of_paper]));
    if (bench.takes(kHairOverFrames)) add_refitting(bench, result);
}

void study_mbkd(StudyBench& bench, StudyResult& result) {
    bench.offer_scenes(labels_of(moving_scenes(bench)));
    enum { kMsbvhRow = 1, kMbkdRow, kOpening, kClosing, kUnweighted };
    const TreeRows rows = {kBaseline,
                           kSplits,
                           kKdTree,
                           {"MBKD, planes for the opening", "raytrace:tree=mbkd,plane=0"},
                           {"MBKD, planes for the closing", "raytrace:tree=mbkd,plane=1"},
                           {"MBKD, no weight by time", "raytrace:tree=mbkd,weight=whole"},
                           {"MBKD, propagated guests vote", "raytrace:tree=mbkd,guests=return"},
                           {"MBKD, no mail-box", "raytrace:tree=mbkd,mailbox=off"},
                           kPaperTree,
                           kWideTree};
    const std::vector<MovingRun> runs =
        run_all(bench, result, rows, kMbkdRow, paper::kMbkd, RaysThatCount::Camera);
    result.tables.push_back(incoherence_table(runs, kMbkdRow));
    for (const MovingRun& run : runs) {
        if (run.scene.of_paper != paper::kMovingScenes)
            add_checks(result, checks_of_kd_tree(run.label(), ratios_of(run, kMbkdRow),
                                                 ratios_of(run, kMsbvhRow), paper::kMbkd[run.scene.of_paper],
                                                 paper::kMsbvh[run.scene.of_paper]));
        const auto tests = [&](size_t row) { return run.results[row].tests_per_sample(); };
        // Ordinary duplicates, of what planes cut, are not what the paper speaks of.
        const auto guests = [&](size_t row) {
            return static_cast<double>(run.results[row].build.tree_guests);
        };
        add_checks(result,
                   checks_of_kd_variants(run.label(), {tests(kMbkdRow), tests(kOpening), tests(kClosing),
                                                       guests(kMbkdRow), guests(kUnweighted)}));
    }
}

}  // namespace trapeze
