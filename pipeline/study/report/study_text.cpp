#include <fmt/format.h>

#include <algorithm>

#include "pipeline/compare/value_text.h"
#include "pipeline/study/report/study_report.h"

namespace trapeze {
namespace {

/// The first column to the left, the others to the right.
std::string line(const std::vector<std::string>& cells, const std::vector<size_t>& widths) {
    std::string text = "  " + fmt::format("{:<{}}", cells[0], widths[0]);
    for (size_t i = 1; i < cells.size(); ++i) text += fmt::format("  {:>{}}", cells[i], widths[i]);
    return text + "\n";
}

std::string table_of(const StudyTable& table) {
    std::vector<size_t> widths;
    for (const std::string& cell : table.columns) widths.push_back(cell.size());
    for (const auto& row : table.rows)
        for (size_t i = 0; i < row.size(); ++i) widths[i] = std::max(widths[i], row[i].size());
    std::string text = table.title + "\n" + line(table.columns, widths);
    for (const auto& row : table.rows) text += line(row, widths);
    return text + "\n";
}

}  // namespace

std::string study_text(const StudyResult& result) {
    std::string text = result.title + "\n\n";
    for (const StudySceneFacts& scene : result.scenes)
        text += fmt::format(
            "{}: {} micropolygons ({} a pixel), circles of confusion to {} px, motion to {} px\n    {}\n",
            scene.label, count_text(static_cast<double>(scene.micropolygons)),
            number_text(scene.micropolygons_per_pixel()), number_text(scene.largest_defocus),
            number_text(scene.largest_motion), scene.command);
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
