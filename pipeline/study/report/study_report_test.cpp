#include "pipeline/study/report/study_report.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "pipeline/study/report/plot_axis.h"
#include "pipeline/study/report/plots.h"

namespace trapeze {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::Not;

StudyResult small_study() {
    StudyResult result;
    result.name = "table0", result.title = "A <small> study", result.paper = "Hu & al., 2010";
    result.scenes.push_back({"Car", "trapeze scene car-study", 100, 50, 10000, 3, 12.5f, 60.0f});
    result.tables.push_back({"Times", {"method", "Car"}, {{"raytrace", "1.00 s"}, {"a&b", "2.00 s"}}});
    result.plots.push_back({"Plot", "x", "y", {{"one", {{0, 1}, {10, 2}}}, {"two", {{0, 3}, {10, 4}}}}});
    result.histograms.push_back({"Histogram", "difference", -.1, .05, {1, 5, 2, 0, 1}});
    result.close_ups.push_back(
        {"x 1 to <3", {{"reference", {2, 1, {0, 0, 0, 1, 1, 1}}}, {"a&b", {1, 1, {1, 0, 0}}}}});
    result.heat_maps.push_back({"tests <a ray", 2, 1, {{"p&q", {100, 100}}, {"other", {1, 10}}}});
    result.checks.push_back({"holds", "2x", "3x", true});
    result.checks.push_back({"misses", "2x", "1x", false, "because"});
    return result;
}

TEST(PlotAxis, PlacesAndRoundTicks) {
    const PlotAxis axis = plot_axis(-.12, .31, 0, 430);
    EXPECT_NEAR(axis.place(0), 120, 1e-9);
    const auto ticks = axis.ticks(5);
    ASSERT_EQ(ticks.size(), 5u);
    EXPECT_NEAR(ticks.front(), -.1, 1e-12);
    EXPECT_NEAR(ticks.back(), .3, 1e-12);
    EXPECT_THAT(plot_axis(0, 10, 0, 1).ticks(5), ElementsAre(0, 2, 4, 6, 8, 10));
}

TEST(PlotAxis, OnePointHasAnAxis) {
    const PlotAxis axis = plot_axis(3, 3, 0, 100);
    EXPECT_NEAR(axis.place(3), 50, 1e-9);
}

TEST(Plots, EverySeriesIsALineAndEveryPointIsThere) {
    const std::string svg = line_plot(small_study().plots[0]);
    size_t points = 0;
    for (size_t at = svg.find("<title>"); at != std::string::npos; at = svg.find("<title>", at + 1)) ++points;
    EXPECT_EQ(points, 4u);
    EXPECT_THAT(svg, HasSubstr("line series1"));
    EXPECT_THAT(line_plot({"empty", "x", "y", {}}), Not(HasSubstr("nan")));
}

TEST(Plots, HistogramsHaveABarABinAndALineAtZero) {
    const std::string svg = histogram_plot(small_study().histograms[0]);
    EXPECT_THAT(svg, HasSubstr("class=\"zero\""));
    EXPECT_THAT(svg, HasSubstr(": 5</title>"));
    EXPECT_THAT(svg, HasSubstr("class=\"tracer\""));
    EXPECT_THAT(svg, HasSubstr("class=\"raster\""));
}

TEST(StudyReport, TextSaysWhatHeld) {
    const std::string text = study_text(small_study());
    EXPECT_THAT(text, HasSubstr("held     holds"));
    EXPECT_THAT(text, HasSubstr("NOT HELD misses"));
    EXPECT_THAT(text, HasSubstr("because"));
    EXPECT_THAT(text, HasSubstr("1 of 2 checks held"));
    EXPECT_THAT(text, HasSubstr("a&b"));
}

TEST(StudyReport, HtmlIsOneFileAndEscapesText) {
    const std::string html = study_html(small_study());
    EXPECT_THAT(html, HasSubstr("A &lt;small&gt; study"));
    EXPECT_THAT(html, HasSubstr("a&amp;b"));
    EXPECT_THAT(html, HasSubstr("class=\"missed\""));
    EXPECT_THAT(html, HasSubstr("x 1 to &lt;3"));
    EXPECT_THAT(html, HasSubstr("alt=\"crop of a&amp;b\" src=\"data:image/png;base64,"));
    EXPECT_THAT(html, HasSubstr("After Hu &amp; al., 2010"));
    EXPECT_THAT(html, HasSubstr("alt=\"tests &lt;a ray, p&amp;q\" src=\"data:image/png;base64,"));
    EXPECT_THAT(html, HasSubstr("yellow: 100"));
    EXPECT_THAT(html, Not(HasSubstr("http://")));
    EXPECT_THAT(html, Not(HasSubstr("https://")));
}

TEST(StudyReport, JsonHasEverything) {
    const auto json = study_json(small_study());
    EXPECT_EQ(json["checks"][1]["held"], false);
    EXPECT_EQ(json["tables"][0]["rows"][1][1], "2.00 s");
    EXPECT_EQ(json["scenes"][0]["micropolygons"], 10000);
}

}  // namespace
}  // namespace trapeze
