/// What a study found: values for the terminal, the JSON and the HTML report.
#pragma once

#include <cmath>
#include <cstdint>
#include <nlohmann/json.hpp>
#include <string>
#include <utility>
#include <vector>

#include "pipeline/checkpoint/run_record.h"
#include "pipeline/compare/machine.h"
#include "pipeline/compare/report/screen_pictures.h"

namespace trapeze {

/// A table as it is read: the first column names the rows.
struct StudyTable {
    std::string title;
    std::vector<std::string> columns;
    std::vector<std::vector<std::string>> rows;
};

/// Points joined by lines, in the plot's units.
struct PlotSeries {
    std::string name;
    std::vector<std::pair<double, double>> points;
};

/// A plot with linear axes.
struct LinePlot {
    std::string title, x_title, y_title;
    std::vector<PlotSeries> series;
};

/// Counts in equal bins, of which the first begins at `low`.
struct HistogramPlot {
    std::string title, x_title;
    double low = 0, bin = 1;
    std::vector<uint64_t> counts;
};

/// One place of several pictures, each with its name.
struct StudyCloseUps {
    std::string title;
    std::vector<std::pair<std::string, LinearPicture>> pictures;
    std::string about{};  ///< a sentence: what is to be seen
};

/// What pixels cost several methods, on one scale of colours; row by row.
struct StudyHeatMaps {
    std::string title;
    int width = 0, height = 0;
    std::vector<std::pair<std::string, std::vector<float>>> maps;
};

/// A shape that the paper's figures have, and whether those measured here have it too.
struct StudyCheck {
    std::string claim;
    std::string paper, here;  ///< the figures that it is about
    bool held = false;
    std::string why = {};  ///< what the counts say, where that explains more
};

/// What a scene was like as measured.
struct StudySceneFacts {
    std::string label, command;  ///< the paper's name of its counterpart; how to write the scene as RIB
    int width = 0, height = 0;
    uint64_t micropolygons = 0, grids = 0;
    float largest_defocus = 0, largest_motion = 0;  ///< pixels; not numbers where that was not measured

    bool blur_is_known() const { return !std::isnan(largest_defocus); }

    double micropolygons_per_pixel() const {
        return static_cast<double>(micropolygons) / (static_cast<double>(width) * height);
    }
};

/// Of all random numbers of a study: RenderSettings' own.
inline constexpr uint32_t kStudySeed = 0;

struct StudyResult {
    std::string name, title;
    std::string paper;                 ///< whose figures stand beside ours: authors, title, year
    std::vector<std::string> command;  ///< the command line's words, without the program's name
    std::vector<RecordedOption> options;
    std::vector<std::string> notes;  ///< sentences on how it was measured
    Machine machine;
    bool quick = false;
    int rounds = 0;
    double seconds = 0;  ///< all that the study took
    std::vector<StudySceneFacts> scenes;
    std::vector<StudyTable> tables;
    std::vector<LinePlot> plots;
    std::vector<HistogramPlot> histograms;
    std::vector<StudyCloseUps> close_ups;
    std::vector<StudyHeatMaps> heat_maps;
    std::vector<StudyCheck> checks;
    nlohmann::ordered_json figures = nlohmann::ordered_json::array();  ///< every single measurement
};

}  // namespace trapeze
