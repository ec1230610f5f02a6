#include <fmt/format.h>

#include <algorithm>

#include "pipeline/compare/report/encoded_text.h"
#include "pipeline/compare/report/html_page.h"
#include "pipeline/compare/report/report_pictures.h"
#include "pipeline/compare/value_text.h"
#include "pipeline/frame/json_text.h"
#include "pipeline/study/report/plots.h"
#include "pipeline/study/report/study_report.h"

namespace trapeze {
namespace {

long held_of(const StudyResult& r) {
    return std::count_if(r.checks.begin(), r.checks.end(),
                         [](const StudyCheck& check) { return check.held; });
}

std::string title(const StudyResult& r) {
    std::string out = fmt::format(
        "<header>\n<p class=\"kicker\">Trapeze {} &middot; study {}</p>\n<h1>{}</h1>\n<p "
        "class=\"lead\">After {}. The scenes are ours; the paper&rsquo;s figures are of its own.</p>\n<div "
        "class=\"facts\">\n",
        escaped(r.machine.trapeze), escaped(r.name), escaped(r.title), escaped(r.paper));
    out += html_fact(fmt::format("{} of {}", held_of(r), r.checks.size()), "checks held");
    out += html_fact(r.quick ? "quick" : "full size", "size");
    out += html_fact(std::to_string(r.rounds), r.rounds == 1 ? "round" : "interleaved rounds, medians");
    out += html_fact(seconds_text(r.seconds), "the whole study");
    return out + "</div>\n</header>\n<main>\n";
}

std::string plots(const StudyResult& r) {
    if (r.plots.empty() && r.histograms.empty()) return {};
    std::string out = "<section id=\"plots\">\n<h2>Plots</h2>\n<div class=\"charts\">\n";
    const auto figure = [&](const std::string& caption, const std::string& svg) {
        out += fmt::format("<figure><figcaption>{}</figcaption>\n{}</figure>\n", escaped(caption), svg);
    };
    for (const HistogramPlot& plot : r.histograms) figure(plot.title, histogram_plot(plot));
    for (const LinePlot& plot : r.plots) figure(plot.title, line_plot(plot));
    return out + "</div>\n</section>\n";
}

std::string tables(const StudyResult& r) {
    std::string out = "<section id=\"tables\">\n<h2>Figures</h2>\n";
    for (const StudyTable& table : r.tables) {
        out += fmt::format("<h3>{}</h3>\n<div class=\"scroll\"><table>\n<thead><tr>", escaped(table.title));
        for (const std::string& cell : table.columns) out += "<th>" + escaped(cell) + "</th>";
        out += "</tr></thead>\n<tbody>\n";
        for (const auto& row : table.rows) {
            out += "<tr>";
            for (size_t i = 0; i < row.size(); ++i)
                out += i == 0 ? "<th scope=\"row\">" + escaped(row[i]) + "</th>"
                              : "<td>" + escaped(row[i]) + "</td>";
            out += "</tr>\n";
        }
        out += "</tbody></table></div>\n";
    }
    for (const std::string& note : r.notes) out += "<p>" + escaped(note) + "</p>\n";
    return out + "</section>\n";
}

std::string close_ups(const StudyResult& r) {
    if (r.close_ups.empty()) return {};
    constexpr int kMagnified = 5;
    std::string out = fmt::format(
        "<section id=\"places\">\n<h2>Close-ups</h2>\n<p>Every pixel {} times as large.</p>\n", kMagnified);
    for (const StudyCloseUps& row : r.close_ups) {
        out +=
            "<h3>" + escaped(row.title) + "</h3>\n<p>" + escaped(row.about) + "</p>\n<div class=\"crops\">\n";
        for (const auto& [name, picture] : row.pictures) out += close_up_figure(picture, name, kMagnified);
        out += "</div>\n";
    }
    return out + "</section>\n";
}

/// Maps of one kind are shown on one scale.
std::string heat_maps(const StudyResult& r) {
    if (r.heat_maps.empty()) return {};
    std::string out =
        "<section id=\"heat\">\n<h2>Heat maps</h2>\n<p>Means of a pixel, logarithmic from 1 (dark) to what "
        "all but a thousandth of the pixels stay below (yellow); the same scale in a row.</p>\n";
    for (const StudyHeatMaps& row : r.heat_maps) {
        std::vector<const std::vector<float>*> maps;
        for (const auto& [name, map] : row.maps) maps.push_back(&map);
        const HeatScale scale = heat_scale(maps);
        out += fmt::format("<h3>{}; yellow: {}</h3>\n<div class=\"crops\">\n", escaped(row.title),
                           number_text(static_cast<double>(scale.top)));
        for (const auto& [name, map] : row.maps)
            out += fmt::format(
                "<figure><img alt=\"{0}, {1}\" src=\"{2}\"><figcaption>{1}</figcaption></figure>\n",
                escaped(row.title), escaped(name), png_url(map, row.width, row.height, 1, scale));
        out += "</div>\n";
    }
    return out + "</section>\n";
}

std::string checks(const StudyResult& r) {
    std::string out =
        "<section id=\"checks\">\n<h2>Checks</h2>\n<p>Shapes that the paper&rsquo;s figures have, whatever "
        "the "
        "machine.</p>\n<ul class=\"checks\">\n";
    for (const StudyCheck& check : r.checks) {
        out += fmt::format(
            "<li class=\"{}\"><span class=\"verdict-word\">{}</span><strong>{}</strong><span>here: "
            "{}</span><span>the paper: {}</span>",
            check.held ? "held" : "missed", check.held ? "held" : "not held", escaped(check.claim),
            escaped(check.here), escaped(check.paper));
        if (!check.why.empty()) out += "<span>" + escaped(check.why) + "</span>";
        out += "</li>\n";
    }
    return out + "</ul>\n</section>\n";
}

std::string scenes(const StudyResult& r) {
    std::string out =
        "<section id=\"scenes\">\n<h2>Scenes</h2>\n<div class=\"scroll\"><table>\n<thead><tr><th>stands "
        "for</th><th>pixels</th>"
        "<th>micropolygons</th><th>a pixel</th><th>grids</th><th>largest circle of confusion</th><th>longest "
        "motion</th><th>written by</th></tr></thead>\n<tbody>\n";
    for (const StudySceneFacts& s : r.scenes) {
        const auto pixels = [&](float value) {
            return s.blur_is_known() ? number_text(value) + " px" : std::string("-");
        };
        out += fmt::format(
            "<tr><th scope=\"row\">{}</th><td>{} &times; {}</td><td>{}</td><td>{}</td><td>{}</td><td>{}"
            "</td><td>{}</td><td><code>{}</code></td></tr>\n",
            escaped(s.label), s.width, s.height, count_text(static_cast<double>(s.micropolygons)),
            number_text(s.micropolygons_per_pixel()), s.grids, pixels(s.largest_defocus),
            pixels(s.largest_motion), escaped(s.command));
    }
    return out + "</tbody></table></div>\n</section>\n";
}

}  // namespace

std::string study_html(const StudyResult& r) {
    return html_head("Trapeze study: " + r.title) + title(r) + plots(r) + tables(r) + close_ups(r) +
           heat_maps(r) + checks(r) + scenes(r) +
           "<section id=\"machine\">\n<h2>Machine</h2>\n<dl class=\"machine\">\n" + html_machine(r.machine) +
           "</dl>\n</section>\n</main>\n<script type=\"application/json\" id=\"figures\">" +
           script_safe(json_text(study_json(r), -1)) + "</script>\n</body>\n</html>\n";
}

}  // namespace trapeze
