#include "pipeline/study/report/plots.h"

#include <fmt/format.h>

#include <algorithm>

#include "pipeline/compare/report/encoded_text.h"
#include "pipeline/compare/value_text.h"
#include "pipeline/study/report/plot_axis.h"

namespace trapeze {
namespace {

// In the units of the view box.
constexpr double kWidth = 580, kHeight = 340, kLeft = 62, kRight = 18, kTop = 34, kBottom = 50;

struct PlotAxes {
    PlotAxis x, y;
};

PlotAxes axes_for(double x_low, double x_high, double y_high) {
    return {plot_axis(x_low, x_high, kLeft, kWidth - kRight), plot_axis(0, y_high, kHeight - kBottom, kTop)};
}

std::string tick_text(double value) {
    return fmt::format("{:.4g}", value);
}

std::string open_svg(const std::string& description) {
    return fmt::format("<svg class=\"chart\" viewBox=\"0 0 {} {}\" role=\"img\" aria-label=\"{}\">\n", kWidth,
                       kHeight, escaped(description));
}

std::string draw_axes(const PlotAxes& axes, const std::string& x_title, const std::string& y_title) {
    std::string out;
    for (const double tick : axes.y.ticks(5)) {
        const double y = axes.y.place(tick);
        out += fmt::format(R"(<line class="grid" x1="{0}" y1="{2:.1f}" x2="{1}" y2="{2:.1f}"/>)"
                           R"(<text class="tick side" x="{3}" y="{4:.1f}">{5}</text>)",
                           kLeft, kWidth - kRight, y, kLeft - 8, y + 4, tick_text(tick));
    }
    for (const double tick : axes.x.ticks(7)) {
        const double x = axes.x.place(tick);
        out +=
            fmt::format(R"(<line class="grid" x1="{0:.1f}" y1="{1}" x2="{0:.1f}" y2="{2}"/>)"
                        R"(<text class="tick" x="{0:.1f}" y="{3}">{4}</text>)",
                        x, kHeight - kBottom, kHeight - kBottom + 5, kHeight - kBottom + 19, tick_text(tick));
    }
    out += fmt::format(R"(<text class="axis" x="{:.1f}" y="{}">{}</text>)", (kLeft + kWidth - kRight) / 2,
                       kHeight - 10, escaped(x_title));
    out += fmt::format(R"(<text class="axis start" x="4" y="16">{}</text>)", escaped(y_title));
    return out + "\n";
}

std::string draw_series(const PlotSeries& series, size_t index, const PlotAxes& axes) {
    std::string line, points;
    const size_t style = index % 3;
    for (const auto& [x, y] : series.points) {
        line += fmt::format("{}{:.1f} {:.1f}", line.empty() ? "M" : " L", axes.x.place(x), axes.y.place(y));
        points += fmt::format(
            R"(<circle class="point series{}" cx="{:.1f}" cy="{:.1f}" r="3.2"><title>{}: {}, {}</title></circle>)",
            style, axes.x.place(x), axes.y.place(y), escaped(series.name), number_text(x), number_text(y));
    }
    return fmt::format(R"(<path class="line series{}" d="{}"/>)", style, line) + points + "\n";
}

/// The names in a row above the plot, at its right end.
std::string draw_names(const std::vector<PlotSeries>& all) {
    std::string out;
    double x = kWidth - kRight;
    for (size_t i = all.size(); i-- > 0;) {
        x -= 8.2 * static_cast<double>(all[i].name.size());  // about the width of a capital
        out += fmt::format(R"(<text class="name" x="{:.1f}" y="16">{}</text>)", x, escaped(all[i].name));
        out += fmt::format(R"(<circle class="point series{}" cx="{:.1f}" cy="12" r="4"/>)", i % 3, x - 10);
        x -= 28;
    }
    return out + "\n";
}

}  // namespace

std::string line_plot(const LinePlot& plot) {
    double low = 1e300, high = -1e300, most = 0;
    for (const PlotSeries& series : plot.series)
        for (const auto& [x, y] : series.points)
            low = std::min(low, x), high = std::max(high, x), most = std::max(most, y);
    if (low > high) low = 0, high = 1;
    const PlotAxes axes = axes_for(low, high, most * 1.05);
    std::string out =
        open_svg(plot.title) + draw_axes(axes, plot.x_title, plot.y_title) + draw_names(plot.series);
    for (size_t i = 0; i < plot.series.size(); ++i) out += draw_series(plot.series[i], i, axes);
    return out + "</svg>\n";
}

std::string histogram_plot(const HistogramPlot& plot) {
    uint64_t most = 0;
    for (const uint64_t count : plot.counts) most = std::max(most, count);
    const double high = plot.low + plot.bin * static_cast<double>(plot.counts.size());
    const PlotAxes axes = axes_for(plot.low, high, static_cast<double>(most) * 1.05);
    std::string out = open_svg(plot.title) + draw_axes(axes, plot.x_title, "grids");
    for (size_t i = 0; i < plot.counts.size(); ++i) {
        const double from = plot.low + plot.bin * static_cast<double>(i), x = axes.x.place(from);
        const double y = axes.y.place(static_cast<double>(plot.counts[i]));
        out += fmt::format(
            R"(<rect class="{}" x="{:.2f}" y="{:.2f}" width="{:.2f}" height="{:.2f}"><title>{} to {}: {}</title></rect>)",
            from < 0 ? "tracer" : "raster", x + .5, y, std::max(.5, axes.x.place(from + plot.bin) - x - 1),
            axes.y.begin - y, number_text(from), number_text(from + plot.bin), plot.counts[i]);
    }
    if (plot.low < 0 && high > 0)
        out += fmt::format(R"(<line class="zero" x1="{0:.1f}" y1="{1}" x2="{0:.1f}" y2="{2}"/>)",
                           axes.x.place(0), kTop, kHeight - kBottom);
    return out + "\n</svg>\n";
}

}  // namespace trapeze
