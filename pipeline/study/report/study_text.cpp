#include <fmt/format.h>

#include <algorithm>

#include "pipeline/compare/text_table.h"
#include "pipeline/compare/value_text.h"
#include "pipeline/study/report/study_report.h"

namespace trapeze {
namespace {

std::string table_of(const StudyTable& table) {
    std::vector<std::vector<std::string>> rows{table.columns};
    rows.insert(rows.end(), table.rows.begin(), table.rows.end());
    return table.title + "\n" + text_table(rows, "  ") + "\n";
}

}  // namespace

std::string study_text(const StudyResult& result) {
    std::string text = result.title + "\n\n";
    for (const StudySceneFacts& scene : result.scenes) {
        std::string blur;
        if (scene.blur_is_known())
            blur = fmt::format(", circles of confusion to {} px, motion to {} px",
                               number_text(scene.largest_defocus), number_text(scene.largest_motion));
        text += fmt::format("{}: {} micropolygons ({} a pixel){}\n    {}\n", scene.label,
                            count_text(static_cast<double>(scene.micropolygons)),
                            number_text(scene.micropolygons_per_pixel()), blur, scene.command);
    }
    text += "\n";
    for (const StudyTable& table : result.tables) text += table_of(table);
    for (const std::string& note : result.notes) text += note + "\n";
    if (!result.notes.empty()) text += "\n";
    for (const StudyCheck& check : result.checks) {
        text += fmt::format("{} {}\n         here: {}; the paper: {}\n", check.held ? "held    " : "NOT HELD",
                            check.claim, check.here, check.paper);
        if (!check.why.empty()) text += "         " + check.why + "\n";
    }
    const auto held =
        std::count_if(result.checks.begin(), result.checks.end(), [](const StudyCheck& c) { return c.held; });
    return text + fmt::format("\n{} of {} checks held.\n", held, result.checks.size());
}

}  // namespace trapeze
