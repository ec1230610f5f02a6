#include "pipeline/cli/support/stats_json.h"

#include "pipeline/cli/support/revision.h"
#include "pipeline/frame/json_text.h"
#include "pipeline/frame/version.h"

namespace trapeze {
namespace {

using json = nlohmann::ordered_json;

json to_json(const FrameStats::Output& output) {
    return {{"path", output.path}, {"bytes", output.bytes}, {"seconds", output.seconds}};
}

json to_json(const FrameStats& s) {
    const auto stage = [](double seconds) { return json{{"seconds", seconds}}; };
    json out = {{"frame", s.frame},
                {"width", s.width},
                {"height", s.height},
                {"stages",
                 {{"read", stage(s.seconds.read)},
                  {"tessellate", stage(s.seconds.tessellate)},
                  {"shade", stage(s.seconds.shade)},
                  {"rays", stage(s.seconds.rays)},
                  {"cull", stage(s.seconds.cull)},
                  {"build", stage(s.seconds.build)},
                  {"trace", stage(s.seconds.trace)},
                  {"composite", stage(s.seconds.composite)},
                  {"total", stage(s.seconds.total)}}},
                {"primitives", s.tessellate.primitives},
                {"subpatches", s.tessellate.subpatches},
                {"culled_subpatches", s.tessellate.culled_subpatches},
                {"grids", s.tessellate.grids},
                {"micropolygons", s.tessellate.micropolygons},
                {"shaded_vertices", s.shade.shaded_vertices},
                {"unshaded_grids", s.unshaded_grids},
                {"unshaded_vertices", s.unshaded_vertices},
                {"not_finite_values", s.shade.not_finite_values},
                {"rays",
                 {{"secondary",
                   {{"diffuse", s.shade.rays.diffuse},
                    {"specular", s.shade.rays.specular},
                    {"transmission", s.shade.rays.transmission}}},
                  {"shaded_hits", s.shade.rays.shaded_hits},
                  {"micropolygons", s.ray_micropolygons},
                  {"micropolygons_made", s.ray_micropolygons_made},
                  {"bytes", s.ray_bytes},
                  {"list_bytes", s.ray_list_bytes}}},
                {"samples", s.samples},
                {"layer_passes", s.layer_passes},
                {"rays_per_second", s.rays_per_second()},
                {"predicate_tests", s.sample.predicate_tests},
                {"predicate_hits", s.sample.predicate_hits},
                {"nodes_visited", s.sample.nodes_visited},
                {"leaves_visited", s.sample.leaves_visited},
                {"bytes",
                 {{"grids", s.grid_bytes},
                  {"tree", s.tree_bytes},
                  {"hit_lists", s.hit_list_bytes},
                  {"peak_rss", peak_resident_bytes()}}},
                {"regions", s.regions},
                {"threads", s.threads},
                {"simd_target", s.simd_target},
                {"sampler", s.sampler},
                {"outputs", json::array()}};
    if (s.tile) out["tile"] = name_of(*s.tile);
    for (const FrameStats::Output& output : s.outputs) out["outputs"].push_back(to_json(output));
    return out;
}

}  // namespace

std::string stats_json(const std::vector<FrameStats>& frames, const RunFacts& facts) {
    json run = {{"version", kVersion},
                {"revision", revision()},
                {"command", facts.words},
                {"scene_files", facts.files},
                {"messages", {{"errors", facts.errors}, {"warnings", facts.warnings}}}};
    run["maps"] = json::array();
    for (const FrameStats::Output& map : facts.maps) run["maps"].push_back(to_json(map));
    if (frames.empty()) return json_text(run) + "\n";
    json all = json::array();
    for (const FrameStats& stats : frames) {
        json frame = to_json(stats);
        frame.update(run);
        all.push_back(std::move(frame));
    }
    return json_text(frames.size() == 1 ? all[0] : all) + "\n";
}

}  // namespace trapeze
