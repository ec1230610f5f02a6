#include "pipeline/compare/table.h"

#include "pipeline/compare/text_table.h"
#include "pipeline/compare/value_text.h"

namespace trapeze {
namespace {

std::string rate_per_second(double value) {
    return number_text(value * 1e-6) + " M";
}

using Cells = std::vector<std::string>;

Cells header_cells() {
    Cells cells{"method", "samples"};
    for (const TableColumn& column : table_columns()) cells.push_back(column.title);
    return cells;
}

Cells cells_of(const ComparedMethod& method) {
    Cells cells{method.result.method, rate_text(method.result.rate)};
    for (const TableColumn& column : table_columns()) cells.push_back(column.text(column.value(method)));
    return cells;
}

}  // namespace

const std::vector<TableColumn>& table_columns() {
    using M = ComparedMethod;
    static const std::vector<TableColumn> columns = {
        {"build", "Median time to build what the method needs.",
         [](const M& m) { return m.result.build_median(); }, seconds_text},
        {"trace/raster", "Median time to find what all samples see.",
         [](const M& m) { return m.result.resolve_median(); }, seconds_text},
        {"total", "Median sampling time: build and trace or raster.",
         [](const M& m) { return m.result.total_median(); }, seconds_text},
        {"least", "Least sampling time of a round.", [](const M& m) { return m.result.total_spread().least; },
         seconds_text},
        {"most", "Most sampling time of a round.", [](const M& m) { return m.result.total_spread().most; },
         seconds_text},
        {"ratio", "Total to the baseline's total at the same sample rate.",
         [](const M& m) { return m.ratio; }, number_text},
        {"samples/pixel", "Samples a pixel, the mean: adaptive sampling takes as many as each needs.",
         [](const M& m) { return m.result.samples_per_pixel(); }, number_text},
        {"samples/s", "Millions of samples a second of trace or raster time.",
         [](const M& m) { return m.result.samples_per_second(); }, rate_per_second},
        {"tests/sample", "Micropolygons tested exactly, a sample.",
         [](const M& m) { return m.result.tests_per_sample(); }, counted_text},
        {"tests/hit", "Exact tests for one that hits.", [](const M& m) { return m.result.tests_per_hit(); },
         counted_text},
        {"nodes/ray", "Nodes visited, a sample (ray tracers), or boxes met (rasterizers).",
         [](const M& m) { return m.result.nodes_per_sample(); }, counted_text},
        {"B/mpoly", "Bytes built, a micropolygon.",
         [](const M& m) { return m.result.bytes_per_micropolygon(); }, counted_text},
        {"peak B/mpoly", "The most bytes taken while building, a micropolygon.",
         [](const M& m) {
             const double peak = static_cast<double>(m.picture.build_peak_bytes.value_or(0));
             return m.result.micropolygons > 0 ? peak / static_cast<double>(m.result.micropolygons) : 0;
         },
         counted_text},
        {"RMSE", "Root of the mean squared difference to the reference, linear red, green, blue.",
         [](const M& m) { return m.rmse; }, number_text},
        {"FLIP",
         "How different an observer would find the picture and the reference, shown in turns: 0 is the same, 1 "
         "the most.",
         [](const M& m) { return m.flip; }, number_text},
    };
    return columns;
}

std::string table_text(const Comparison& comparison) {
    std::vector<Cells> rows{header_cells()};
    for (const SampleRate& rate : comparison.rates) {
        if (&rate != comparison.rates.data()) rows.emplace_back();
        for (const ComparedMethod* method : comparison.at(rate)) rows.push_back(cells_of(*method));
    }
    return text_table(rows);
}

}  // namespace trapeze
