/// Table 3: whole frames, by stage [Hou10 sec. 5].
#include <fmt/format.h>

#include <algorithm>

#include "pipeline/compare/comparison.h"
#include "pipeline/compare/value_text.h"
#include "pipeline/study/paper_figures.h"
#include "pipeline/study/shape_checks.h"
#include "pipeline/study/studies.h"
#include "pipeline/study/study_scenes.h"

namespace trapeze {
namespace {

/// A frame's seconds under the paper's headings.
paper::FrameParts parts_of(const StageSeconds& s) {
    return {s.tessellate, s.shade + s.rays + s.cull, s.build + s.trace, s.composite, s.total};
}

/// The round whose total is the median of all.
FrameStats median_of(std::vector<FrameStats> rounds) {
    std::ranges::sort(rounds, {}, [](const FrameStats& stats) { return stats.seconds.total; });
    return rounds[rounds.size() / 2];
}

using Row = std::pair<const char*, double paper::FrameParts::*>;
constexpr Row kRows[] = {{"tessellation", &paper::FrameParts::tessellation},
                         {"shading", &paper::FrameParts::shading},
                         {"sampling", &paper::FrameParts::sampling},
                         {"composition", &paper::FrameParts::composition},
                         {"total", &paper::FrameParts::total}};

StudyTable table_of(const std::string& title, const std::vector<std::string>& columns,
                    const std::vector<paper::FrameParts>& frames) {
    StudyTable table{title, columns, {}};
    for (const auto& [name, part] : kRows) {
        std::vector<std::string> row{name};
        for (const paper::FrameParts& frame : frames) row.push_back(seconds_text(frame.*part));
        table.rows.push_back(row);
    }
    return table;
}

/// What a frame is made of, and the memory that it took.
StudyTable facts_table(const std::vector<std::string>& columns, const std::vector<FrameStats>& frames) {
    StudyTable table{"Sizes and memory", columns, {}};
    const auto add = [&](const char* name, auto&& text) {
        std::vector<std::string> row{name};
        for (const FrameStats& stats : frames) row.push_back(text(stats));
        table.rows.push_back(row);
    };
    add("micropolygons, millions", [](const FrameStats& stats) {
        return fmt::format("{:.1f}", static_cast<double>(stats.tessellate.micropolygons) / 1e6);
    });
    std::vector<std::string> printed{"micropolygons of the paper's, millions"};
    for (const double millions : paper::kMicropolygons) printed.push_back(fmt::format("{:.1f}", millions));
    table.rows.push_back(printed);
    add("samples, millions", [](const FrameStats& stats) {
        return fmt::format("{:.0f}", static_cast<double>(stats.samples) / 1e6);
    });
    add("regions", [](const FrameStats& stats) { return std::to_string(stats.regions); });
    add("grids and tree, MiB",
        [](const FrameStats& stats) { return std::to_string(stats.peak_region_bytes >> 20); });
    return table;
}

nlohmann::ordered_json figure_of(const StudyScene& scene, const SampleRate& rate,
                                 const std::vector<FrameStats>& rounds) {
    const FrameStats& stats = rounds.front();
    nlohmann::ordered_json figure = {{"scene", scene_command_line(scene)},
                                     {"stands_for", scene.label},
                                     {"samples_x", rate.x},
                                     {"samples_y", rate.y},
                                     {"micropolygons", stats.tessellate.micropolygons},
                                     {"samples", stats.samples},
                                     {"regions", stats.regions}};
    for (const auto& [name, part] : kRows) {
        auto& seconds = figure[std::string(name) + "_seconds_by_round"] = nlohmann::ordered_json::array();
        for (const FrameStats& round : rounds) seconds.push_back(parts_of(round.seconds).*part);
    }
    return figure;
}

StudyCheck check_of_total(const std::string& scene, const std::string& than, double here, double printed) {
    StudyCheck check{scene + ": the whole frame takes less time than " + than, paper_seconds(printed),
                     seconds_text(here)};
    check.held = here < printed;
    return check;
}

}  // namespace

void study_table3(StudyBench& bench, StudyResult& result) {
    result.notes.push_back(
        "Furball: 495,000 half transparent hairs on a mirror, at most five layers. Ladybug: a lens of six "
        "blades, and a glow. Fairy is one frame, and the Car is without occlusion, mirrors and lights that "
        "glow: its shading is not comparable, and neither are totals but to the paper's less its shading, "
        "45.2 s.");
    if (bench.quick())
        result.notes.push_back(
            "A sixteenth of the micropolygons and pixels at 4x4 samples: totals say nothing "
            "against the paper's.");
    std::vector<std::string> columns{"stage"};
    std::vector<FrameStats> frames;
    std::vector<paper::FrameParts> here;
    size_t s = 0;
    for (const StudyScene& scene : frames_of_the_paper(bench)) {
        const int side = bench.quick() ? 4 : paper::kReferenceSide[s++];
        std::vector<FrameStats> rounds;
        for (int round = 0; round < bench.rounds(); ++round)
            rounds.push_back(bench.render(scene, {side, side}));
        result.figures.push_back(figure_of(scene, {side, side}, rounds));
        columns.push_back(fmt::format("{} ({}, {}x{})", scene.label, scene.name, side, side));
        frames.push_back(median_of(std::move(rounds)));
        here.push_back(parts_of(frames.back().seconds));
    }
    result.tables.push_back(table_of("Whole frames, measured here", columns, here));
    result.tables.push_back(table_of("Whole frames, the paper's", columns,
                                     {std::begin(paper::kTable3), std::end(paper::kTable3)}));
    result.tables.push_back(facts_table(columns, frames));
    if (bench.quick()) return;
    constexpr size_t kCar = 3;
    for (size_t i = 0; i < here.size(); ++i) {
        const paper::FrameParts& printed = paper::kTable3[i];
        const bool unshaded = i == kCar;  // its occlusion is not here
        result.checks.push_back(
            check_of_total(columns[i + 1], unshaded ? "the paper's without its shading" : "the paper's",
                           here[i].total, unshaded ? printed.total - printed.shading : printed.total));
    }
}

}  // namespace trapeze
