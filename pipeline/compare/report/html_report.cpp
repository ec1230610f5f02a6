#include "pipeline/compare/report/html_report.h"

#include <fmt/format.h>

#include "pipeline/compare/report/bar_chart.h"
#include "pipeline/compare/report/encoded_text.h"
#include "pipeline/compare/report/html_page.h"
#include "pipeline/compare/report/report_pictures.h"
#include "pipeline/compare/results_json.h"
#include "pipeline/compare/table.h"
#include "pipeline/compare/value_text.h"
#include "pipeline/frame/json_text.h"

namespace trapeze {

extern const char* const kReportScript;  // report.js, embedded by CMake

namespace {

const char* style_class(const MethodResult& result) {
    switch (kind_of(result)) {
        case MethodKind::RayTracer:
            return "tracer";
        case MethodKind::Rasterizer:
            return "raster";
        case MethodKind::Reference:
            return "other";
    }
    return "";
}

/// The report's head: scene, verdict and the frame's figures.
std::string title(const Comparison& c) {
    std::string out = fmt::format(
        "<header>\n<p class=\"kicker\">Trapeze {} &middot; compare</p>\n<h1>{}</h1>\n<p "
        "class=\"lead\">{}</p>\n"
        "<div class=\"facts\">\n",
        escaped(c.machine.trapeze), escaped(c.scene), c.verdict.empty() ? "" : escaped(c.verdict.back()));
    out += html_fact(fmt::format("{} \u00d7 {}", c.frame.width, c.frame.height), "pixels");
    out += html_fact(count_text(static_cast<double>(c.frame.tessellate.micropolygons)), "micropolygons");
    out += html_fact(number_text(c.blur.defocus.largest) + " px", "largest circle of confusion");
    out += html_fact(number_text(c.blur.motion.largest) + " px", "longest motion");
    out += html_fact(std::to_string(c.rounds), c.rounds == 1 ? "round" : "interleaved rounds, medians");
    return out +
           "</div>\n<nav><a href=\"#times\">Times</a><a href=\"#table\">Table</a><a "
           "href=\"#pictures\">Pictures</a><a href=\"#places\">Worst places</a><a "
           "href=\"#machine\">Machine</a><a href=\"#verdict\">Verdict</a></nav>\n</header>\n<main>\n";
}

std::string times(const Comparison& c) {
    std::string out =
        "<section id=\"times\">\n<h2>Sampling time</h2>\n<p>Building what a method needs (a bar's first "
        "part) and "
        "finding what every sample sees, on the same shaded grids. Making samples and filtering pixels are "
        "not "
        "in it.</p>\n<p class=\"legend\"><span class=\"tracer\"></span>ray tracers<span "
        "class=\"raster\"></span>"
        "rasterizers<span class=\"other\"></span>brute force</p>\n<div class=\"charts\">\n";
    for (const SampleRate& rate : c.rates) {
        std::vector<Bar> bars;
        for (const ComparedMethod* m : c.at(rate)) {
            const double total = m->result.total_median(), build = std::min(total, m->result.build_median());
            bars.push_back({m->result.method,
                            fmt::format("{}  ({}\u00d7)", seconds_text(total), number_text(m->ratio)),
                            style_class(m->result), total * 1e3, build * 1e3});
        }
        out +=
            fmt::format("<figure><figcaption>{} samples a pixel</figcaption>\n{}</figure>\n", rate_text(rate),
                        bar_chart(bars, "milliseconds", "sampling time at " + rate_text(rate)));
    }
    return out + "</div>\n</section>\n";
}

std::string tests(const Comparison& c) {
    std::string out =
        "<section id=\"tests\">\n<h2>Exact tests</h2>\n<p>Micropolygons tested exactly for each sample. A "
        "method "
        "that does not count its tests is left out.</p>\n<div class=\"charts\">\n";
    for (const SampleRate& rate : c.rates) {
        std::vector<Bar> bars;
        for (const ComparedMethod* m : c.at(rate))
            if (m->result.tests_per_sample() > 0)
                bars.push_back({m->result.method,
                                fmt::format("{}  ({} a hit)", number_text(m->result.tests_per_sample()),
                                            number_text(m->result.tests_per_hit())),
                                style_class(m->result), m->result.tests_per_sample(), 0});
        if (bars.empty()) continue;
        out +=
            fmt::format("<figure><figcaption>{} samples a pixel</figcaption>\n{}</figure>\n", rate_text(rate),
                        bar_chart(bars, "tests per sample", "tests per sample at " + rate_text(rate)));
    }
    return out + "</div>\n</section>\n";
}

std::string table(const Comparison& c) {
    std::string out =
        "<section id=\"table\">\n<h2>All figures</h2>\n<p>Click a heading to sort. Ratios are to " +
        escaped(c.baseline) +
        ".</p>\n<div class=\"scroll\"><table>\n<thead><tr><th><button>method</button></th><th>"
        "<button>samples</button></th>";
    for (const TableColumn& column : table_columns())
        out += fmt::format("<th title=\"{}\"><button>{}</button></th>", escaped(column.meaning),
                           escaped(column.title));
    out += "</tr></thead>\n<tbody>\n";
    for (const ComparedMethod& m : c.methods) {
        out += fmt::format(
            "<tr><th scope=\"row\"><span class=\"dot {}\"></span>{}</th><td data-value=\"{}\">{}</td>",
            style_class(m.result), escaped(m.result.method), m.result.rate.per_pixel(),
            rate_text(m.result.rate));
        for (const TableColumn& column : table_columns()) {
            const double value = column.value(m);
            out += fmt::format("<td data-value=\"{}\">{}</td>", value, escaped(column.text(value)));
        }
        out += "</tr>\n";
    }
    out += "</tbody>\n</table></div>\n<dl class=\"meanings\">\n";
    for (const TableColumn& column : table_columns())
        out += fmt::format("<div><dt>{}</dt><dd>{}</dd></div>\n", escaped(column.title),
                           escaped(column.meaning));
    return out + "</dl>\n</section>\n";
}

std::string machine(const Comparison& c) {
    return "<section id=\"machine\">\n<h2>Machine</h2>\n<dl class=\"machine\">\n" + html_machine(c.machine) +
           html_entry("Tessellation", seconds_text(c.frame.seconds.tessellate)) +
           html_entry("Shading", seconds_text(c.frame.seconds.shade)) +
           html_entry("Grids",
                      fmt::format("{} ({} MiB)", c.frame.tessellate.grids, c.frame.grid_bytes >> 20)) +
           "</dl>\n</section>\n";
}

std::string verdict(const Comparison& c) {
    std::string out = "<section id=\"verdict\">\n<h2>Verdict</h2>\n";
    for (size_t i = 0; i < c.verdict.size(); ++i)
        out += fmt::format("<p{}>{}</p>\n", i + 1 == c.verdict.size() ? " class=\"conclusion\"" : "",
                           escaped(c.verdict[i]));
    return out + "</section>\n";
}

}  // namespace

std::string html_report(const Comparison& c) {
    return html_head("Trapeze compare: " + c.scene) + title(c) + times(c) + tests(c) + table(c) +
           report_pictures(c) + machine(c) + verdict(c) +
           "</main>\n<dialog><img alt=\"\"><p></p></dialog>\n"
           "<script type=\"application/json\" id=\"figures\">" +
           script_safe(json_text(to_json(c), -1)) + "</script>\n<script>\n" + kReportScript +
           "</script>\n</body>\n</html>\n";
}

}  // namespace trapeze
