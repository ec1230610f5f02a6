#include "pipeline/compare/record/figures_csv.h"
#include "pipeline/compare/results_json.h"
#include "pipeline/study/report/study_report.h"

namespace trapeze {

nlohmann::ordered_json study_json(const StudyResult& r) {
    using json = nlohmann::ordered_json;
    json checks = json::array(), tables = json::array(), scenes = json::array();
    for (const StudyCheck& c : r.checks)
        checks.push_back(
            {{"claim", c.claim}, {"here", c.here}, {"paper", c.paper}, {"held", c.held}, {"why", c.why}});
    for (const StudyTable& t : r.tables)
        tables.push_back({{"title", t.title}, {"columns", t.columns}, {"rows", t.rows}});
    for (const StudySceneFacts& s : r.scenes)
        scenes.push_back({{"stands_for", s.label},
                          {"command", s.command},
                          {"width", s.width},
                          {"height", s.height},
                          {"micropolygons", s.micropolygons},
                          {"grids", s.grids},
                          {"largest_circle_of_confusion_pixels", s.largest_defocus},
                          {"largest_motion_pixels", s.largest_motion}});
    return {{"program", "trapeze study"},
            {"study", r.name},
            {"title", r.title},
            {"after", r.paper},
            {"machine", to_json(r.machine)},
            {"command", r.command},
            {"options", to_json(r.options)},
            {"seed", kStudySeed},
            {"inputs", json::array()},  // the scenes are the program's own: "scenes" says how they are made
            {"quick", r.quick},
            {"rounds", r.rounds},
            {"seconds", r.seconds},
            {"notes", r.notes},
            {"scenes", scenes},
            {"tables", tables},
            {"checks", checks},
            {"figures", r.figures}};
}

std::string study_csv(const StudyResult& r) {
    nlohmann::ordered_json common = {{"study", r.name}, {"quick", r.quick}};
    common.update(run_columns(r.machine));
    return figures_csv(common, r.figures);
}

}  // namespace trapeze
