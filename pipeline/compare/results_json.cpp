#include "pipeline/compare/results_json.h"

#include <nlohmann/json.hpp>

#include "pipeline/compare/record/figures_csv.h"
#include "pipeline/compare/record/replay.h"

namespace trapeze {

nlohmann::ordered_json to_json(const MethodResult& r) {
    nlohmann::ordered_json figures{{"method", r.method},
                                   {"pattern", r.pattern},
                                   {"samples_x", r.rate.x},
                                   {"samples_y", r.rate.y},
                                   {"variance", r.variance},
                                   {"samples_per_pixel", r.samples_per_pixel()},
                                   {"build_seconds", r.build_median()},
                                   {"resolve_seconds", r.resolve_median()},
                                   {"total_seconds", r.total_median()},
                                   {"total_seconds_least", r.total_spread().least},
                                   {"total_seconds_most", r.total_spread().most},
                                   {"build_seconds_by_round", r.build_seconds},
                                   {"resolve_seconds_by_round", r.resolve_seconds},
                                   {"samples", r.sample.rays},
                                   {"samples_per_second", r.samples_per_second()},
                                   {"hits", r.hits},
                                   {"predicate_tests", r.sample.predicate_tests},
                                   {"predicate_hits", r.sample.predicate_hits},
                                   {"nodes_visited", r.sample.nodes_visited},
                                   {"leaves_visited", r.sample.leaves_visited},
                                   {"tests_per_sample", r.tests_per_sample()},
                                   {"tests_per_hit", r.tests_per_hit()},
                                   {"nodes_per_sample", r.nodes_per_sample()},
                                   {"tree_bytes", r.build.tree_bytes},
                                   {"tree_nodes", r.build.tree_nodes},
                                   {"tree_leaves", r.build.tree_leaves},
                                   {"tree_references", r.build.tree_references},
                                   {"tree_duplicates", r.build.tree_duplicates},
                                   {"tree_splits", r.build.tree_splits},
                                   {"tree_guests", r.build.tree_guests},
                                   {"tree_incoherent", r.build.tree_incoherent},
                                   {"tree_sah_cost", r.build.tree_sah_cost},
                                   {"build_prepare_seconds", r.build.phases.prepare},
                                   {"build_divide_seconds", r.build.phases.divide},
                                   {"build_cut_seconds", r.build.phases.divide * r.build.phases.cut_share()},
                                   {"build_bound_seconds", r.build.phases.bound},
                                   {"bytes_per_micropolygon", r.bytes_per_micropolygon()},
                                   {"micropolygons", r.micropolygons},
                                   {"tile_side", r.tile_side},
                                   {"parts", r.parts}};
    if (r.occlusion.rays == 0) return figures;
    figures["occlusion_seconds"] = r.occlusion_median();
    figures["occlusion_rays"] = r.occlusion.rays;
    figures["occluded"] = r.occluded;
    figures["occlusion_tests"] = r.occlusion.predicate_tests;
    figures["occlusion_nodes"] = r.occlusion.nodes_visited;
    return figures;
}

nlohmann::ordered_json to_json(const Machine& machine) {
    return {{"cpu", machine.cpu},          {"threads", machine.threads},   {"simd_target", machine.simd},
            {"system", machine.system},    {"compiler", machine.compiler}, {"trapeze", machine.trapeze},
            {"revision", machine.revision}};
}

nlohmann::ordered_json to_json(const Comparison& c) {
    using json = nlohmann::ordered_json;
    json results = json::array();
    for (const ComparedMethod& method : c.methods) {
        json result = to_json(method.result);
        result["ratio_to_baseline"] = method.ratio;
        if (const auto peak = method.picture.build_peak_bytes) result["build_peak_bytes"] = *peak;
        result["rmse"] = method.rmse;
        result["flip"] = method.flip;
        results.push_back(std::move(result));
    }
    const auto pixels = [](const BlurSize& blur) {
        return json{{"largest_pixels", blur.largest}, {"median_pixels", blur.median}};
    };
    return {{"program", kCompareProgram},
            {"scene", c.scene},
            {"scenes", c.scenes},
            {"command", c.command},
            {"options", to_json(c.options)},
            {"seed", c.seed},
            {"inputs", to_json(c.inputs)},
            {"machine", to_json(c.machine)},
            {"width", c.frame.width},
            {"height", c.frame.height},
            {"grids", c.frame.tessellate.grids},
            {"micropolygons", c.frame.tessellate.micropolygons},
            {"grid_bytes", c.frame.grid_bytes},
            {"tessellate_seconds", c.frame.seconds.tessellate},
            {"shade_seconds", c.frame.seconds.shade},
            {"circle_of_confusion", pixels(c.blur.defocus)},
            {"motion", pixels(c.blur.motion)},
            {"rounds", c.rounds},
            {"reference_samples", c.reference_side * c.reference_side},
            {"baseline", c.baseline},
            {"results", results},
            {"verdict", c.verdict},
            {"verdict_without_times", c.verdict_without_times}};
}

nlohmann::ordered_json run_columns(const Machine& machine) {
    return {{"trapeze", machine.trapeze},
            {"cpu", machine.cpu},
            {"threads", machine.threads},
            {"simd_target", machine.simd}};
}

std::string comparison_csv(const Comparison& comparison) {
    const auto json = to_json(comparison);
    nlohmann::ordered_json common = {{"scene", json["scene"]}, {"seed", json["seed"]}};
    common.update(run_columns(comparison.machine));
    return figures_csv(common, json["results"]);
}

}  // namespace trapeze
