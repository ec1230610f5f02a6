#include "pipeline/study/refitting.h"

#include <fmt/format.h>

#include <memory>
#include <optional>

#include "pipeline/compare/value_text.h"
#include "pipeline/frame/cost/stopwatch.h"
#include "pipeline/study/moving_checks.h"

namespace trapeze {
namespace {

constexpr int kFollowed = 11;
/// Of the scene's motion: shutters follow each other without a gap.
constexpr double kShutter = .1;

/// A kind of tree, by the method that is refitted, and the one that is not.
struct RefittedTree {
    const char *name, *refitted, *anew;
};

constexpr RefittedTree kTrees[] = {
    {"MSBVH", "raytrace:tree=msbvh,refit=on,bundle=off", "raytrace:tree=msbvh,bundle=off"},
    {"interpolated boxes", "raytrace:tree=refit,bundle=off", "raytrace:tree=interpolated,bundle=off"}};

/// One row's tree, its costs and its seconds, by frame.
struct FollowedTree {
    std::string name;
    Sampler sampler;
    std::unique_ptr<Visibility> tree = nullptr;
    std::vector<double> costs = {}, seconds = {};

    FollowedTree(std::string of_name, const char* method) : name(std::move(of_name)) {
        std::string error;
        sampler = choose_sampler(method, "", &error).value();
    }
    void take(const SharedFrame& frame) {
        const RenderContext context = frame.context_at({1, 1});
        Stopwatch watch;
        if (!tree || !tree->update(frame.grids)) tree = sampler.prepare(context, frame.grids);
        seconds.push_back(watch.lap());
        costs.push_back(tree->build_stats().tree_sah_cost);
    }
    double mean_seconds() const {
        double sum = 0;
        for (size_t f = 1; f < seconds.size(); ++f) sum += seconds[f];
        return sum / static_cast<double>(seconds.size() - 1);
    }
};

StudyScene frame_scene(const StudyBench& bench, int frame) {
    StudyScene scene = bench.scene(fmt::format("Hairball, frame {}", frame), "hair", 2.2);
    SceneParameters& p = scene.parameters;
    // A micropolygon a hair: dicing that sees how far hairs are away would make others in each frame.
    p.defocus = 0, p.shading_rate = 1000, p.motion = kShutter, p.time = kShutter * frame;
    return scene;
}

}  // namespace

void add_refitting(StudyBench& bench, StudyResult& result) {
    std::vector<FollowedTree> trees;
    for (const RefittedTree& tree : kTrees) {
        trees.emplace_back(std::string(tree.name) + ", refitted", tree.refitted);
        trees.emplace_back(std::string(tree.name) + ", built anew", tree.anew);
    }
    // What is refitted needs the frame before, too.
    std::optional<SharedFrame> last;
    bool same_objects = true;
    for (int f = 0; f < kFollowed; ++f) {
        SharedFrame frame = bench.frame(frame_scene(bench, f));
        for (FollowedTree& tree : trees) {
            bench.go_on();
            bench.stage(fmt::format("refitting, frame {}: {}", f, tree.name));
            tree.take(frame);
            bench.figure(fmt::format("refitting, frame {}, {}: {}, cost {}", f, tree.name,
                                     seconds_text(tree.seconds.back()), number_text(tree.costs.back())));
        }
        same_objects &= !last || frame.grids.micropolygon_count() == last->grids.micropolygon_count();
        last = std::move(frame);
    }
    if (!same_objects)
        result.notes.push_back(
            "Not all frames of the hairball have the same objects: trees are built there.");
    const std::string label = kHairOverFrames;
    LinePlot plot{
        label + ": cost by the surface area heuristic", "frame", "expected tests and steps of a line", {}};
    StudyTable table{
        label, {"", "a frame's mean, but the first's", "cost, first frame", "cost, last frame"}, {}};
    for (const FollowedTree& tree : trees) {
        PlotSeries& series = plot.series.emplace_back();
        series.name = tree.name;
        for (size_t f = 0; f < tree.costs.size(); ++f)
            series.points.emplace_back(static_cast<double>(f), tree.costs[f]);
        table.rows.push_back({tree.name, seconds_text(tree.mean_seconds()), number_text(tree.costs.front()),
                              number_text(tree.costs.back())});
        result.figures.push_back({{"sequence", label},
                                  {"method", tree.name},
                                  {"tree_sah_cost", tree.costs},
                                  {"update_seconds", tree.seconds}});
    }
    result.plots.push_back(std::move(plot));
    result.tables.push_back(std::move(table));
    result.checks.push_back(check_of_refitting(label, trees[0].costs, trees[1].costs));
}

}  // namespace trapeze
