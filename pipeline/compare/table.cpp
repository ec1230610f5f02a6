#include "pipeline/compare/table.h"

#include <fmt/format.h>

#include <algorithm>

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

/// The first cell to the left, the others to the right.
std::string line(const Cells& cells, const std::vector<size_t>& widths) {
    std::string text = fmt::format("{:<{}}", cells[0], widths[0]);
    for (size_t i = 1; i < cells.size(); ++i) text += fmt::format("  {:>{}}", cells[i], widths[i]);
    return text + "\n";
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
        {"ratio", "Total to the baseline's total at the same sample rate.",
         [](const M& m) { return m.ratio; }, number_text},
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
        {"RMSE", "Root of the mean squared difference to the reference, linear red, green, blue.",
         [](const M& m) { return m.rmse; }, number_text},
    };
    return columns;
}

std::string table_text(const Comparison& comparison) {
    const Cells header = header_cells();
    std::vector<size_t> widths;
    for (const std::string& cell : header) widths.push_back(cell.size());
    for (const ComparedMethod& method : comparison.methods) {
        const Cells cells = cells_of(method);
        for (size_t i = 0; i < cells.size(); ++i) widths[i] = std::max(widths[i], cells[i].size());
    }
    std::string text = line(header, widths);
    for (const SampleRate& rate : comparison.rates) {
        if (&rate != comparison.rates.data()) text += "\n";
        for (const ComparedMethod* method : comparison.at(rate)) text += line(cells_of(*method), widths);
    }
    return text;
}

}  // namespace trapeze
