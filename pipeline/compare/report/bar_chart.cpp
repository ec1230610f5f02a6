#include "pipeline/compare/report/bar_chart.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "pipeline/compare/report/encoded_text.h"
#include "pipeline/compare/value_text.h"

namespace trapeze {
namespace {

// In the units of the SVG's view box.
constexpr double kWidth = 580, kTexts = 140, kBars = kWidth - kTexts;
constexpr double kRow = 46, kLabelHeight = 19, kBarHeight = 16, kAxis = 46;
constexpr double kMargin = 4;  ///< left of the bars
/// Ratio of the largest to the smallest value from which on the axis is logarithmic.
constexpr double kLogarithmicFrom = 25;

/// Places of values along the bars.
struct Axis {
    bool logarithmic = false;
    double low = 0, high = 1;

    double place(double value) const {
        if (!logarithmic) return value / high * kBars;
        return value <= low ? 0 : std::log(value / low) / std::log(high / low) * kBars;
    }
    std::vector<double> ticks() const {
        std::vector<double> values;
        if (logarithmic) {
            for (double tick = low; tick <= high * 1.0001; tick *= 10) values.push_back(tick);
            return values;
        }
        const double rough = high / 4, power = std::pow(10, std::floor(std::log10(rough)));
        const double step = power * (rough < 2 * power ? 2 : rough < 5 * power ? 5 : 10);
        for (double tick = 0; tick <= high * 1.0001; tick += step) values.push_back(tick);
        return values;
    }
};

/// The axis for the bars' values; logarithmic where they differ much.
Axis axis_for(const std::vector<Bar>& bars) {
    double least = 0, most = 0;
    for (const Bar& bar : bars) {
        most = std::max(most, bar.value);
        if (bar.value > 0) least = least > 0 ? std::min(least, bar.value) : bar.value;
    }
    if (most <= 0) return {};
    if (most <= kLogarithmicFrom * least) return {false, 0, most};
    return {true, std::pow(10, std::floor(std::log10(least * 0.999))), most};
}

std::string tick_text(double value) {
    return fmt::format("{:.6g}", value);
}

std::string bar_element(const std::string& kind, double x, double y, double width) {
    return fmt::format(R"(<rect class="{}" x="{:.1f}" y="{:.1f}" width="{:.1f}" height="{}"/>)", kind,
                       kMargin + x, y, std::max(width, 0.0), kBarHeight);
}

/// A bar with its label above and its text behind, `index` rows from the top.
std::string row(const Bar& bar, const Axis& axis, size_t index) {
    const double top = static_cast<double>(index) * kRow, y = top + kLabelHeight, text_y = y + 13;
    const double end = axis.place(bar.value), first = axis.logarithmic ? 0 : axis.place(bar.first_part);
    std::string out =
        fmt::format(R"(<text class="label" x="{}" y="{:.1f}">{}</text>)", kMargin, y - 5, escaped(bar.label));
    if (first > 0) out += bar_element(bar.kind + " first", 0, y, first);
    out += bar_element(bar.kind, first, y, end - first);
    out += fmt::format(R"(<text class="value" x="{:.1f}" y="{:.1f}">{}</text>)", kMargin + end + 8, text_y,
                       escaped(bar.text));
    return out + "\n";
}

}  // namespace

std::string bar_chart(const std::vector<Bar>& bars, const std::string& axis_title,
                      const std::string& description) {
    const Axis axis = axis_for(bars);
    const double bottom = static_cast<double>(bars.size()) * kRow;
    std::string out = fmt::format(R"(<svg class="chart" viewBox="0 0 {} {}" role="img" aria-label="{}">)"
                                  "\n",
                                  kWidth, bottom + kAxis, escaped(description));
    for (const double tick : axis.ticks()) {
        const double x = kMargin + axis.place(tick);
        out += fmt::format(R"(<line class="grid" x1="{0:.1f}" y1="0" x2="{0:.1f}" y2="{1}"/>)"
                           R"(<text class="tick{4}" x="{0:.1f}" y="{2}">{3}</text>)",
                           x, bottom, bottom + 16, tick_text(tick), x < 2 * kMargin ? " start" : "");
    }
    out += "\n";
    for (size_t i = 0; i < bars.size(); ++i) out += row(bars[i], axis, i);
    out += fmt::format(R"(<text class="axis" x="{:.1f}" y="{}">{}{}</text></svg>)"
                       "\n",
                       kMargin + kBars / 2, bottom + 36, escaped(axis_title),
                       axis.logarithmic ? " (logarithmic scale)" : "");
    return out;
}

}  // namespace trapeze
