#include "pipeline/compare/report/html_report.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "pipeline/compare/compare_harness.h"
#include "pipeline/compare/report/encoded_text.h"
#include "pipeline/compare/results_json.h"
#include "pipeline/compare/table.h"

namespace trapeze {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

const Comparison& comparison() {
    static const Comparison made = [] {
        const testing::SharedScene shared("defocus_motion.rib");
        CompareSettings settings;
        settings.samplers = testing::samplers_of({"raytrace", "interval"});
        settings.rates = {{1, 1}, {2, 2}};
        settings.measure.rounds = 1;
        settings.reference_side = 4;
        Comparison c = *compare(*shared.frame, settings);
        c.scene = "<script>alert('x')</script> & \"co\".rib";
        c.machine.trapeze = "1.2.3";
        return c;
    }();
    return made;
}

size_t count_of(const std::string& text, const std::string& what) {
    size_t count = 0;
    for (size_t at = text.find(what); at != std::string::npos; at = text.find(what, at + 1)) ++count;
    return count;
}

TEST(HtmlReport, HasEveryFigureOfTheTable) {
    const std::string html = html_report(comparison());
    for (const ComparedMethod& m : comparison().methods)
        for (const TableColumn& column : table_columns())
            EXPECT_THAT(html, HasSubstr(">" + escaped(column.text(column.value(m))) + "</td>"))
                << column.title;
    for (const std::string& sentence : comparison().verdict) EXPECT_THAT(html, HasSubstr(escaped(sentence)));
    for (const std::string& text :
         {comparison().machine.cpu, comparison().machine.compiler, std::string("1.2.3")})
        EXPECT_THAT(html, HasSubstr(escaped(text)));
}

TEST(HtmlReport, TheJsonInItIsTheComparisons) {
    const std::string html = html_report(comparison()),
                      begin = "<script type=\"application/json\" id=\"figures\">";
    const size_t at = html.find(begin) + begin.size();
    ASSERT_GT(at, begin.size());
    const auto json = nlohmann::ordered_json::parse(html.substr(at, html.find("</script>", at) - at));
    EXPECT_EQ(json, to_json(comparison()));
}

TEST(HtmlReport, NamesAreEscaped) {
    const std::string html = html_report(comparison());
    EXPECT_THAT(html, Not(HasSubstr("<script>alert")));
    EXPECT_THAT(html, HasSubstr("&lt;script&gt;alert(&#39;x&#39;)&lt;/script&gt; &amp; &quot;co&quot;.rib"));
}

TEST(HtmlReport, LoadsNothing) {
    const std::string html = html_report(comparison());
    for (const char* load : {"http://", "https://", "@import", "url(", "<link", "src=\"//", "file:"})
        EXPECT_THAT(html, Not(HasSubstr(load)));
    EXPECT_EQ(count_of(html, "src=\""), count_of(html, "src=\"data:image/png;base64,iVBORw0KGgo"));
}

TEST(HtmlReport, TablesScrollWithinThePage) {
    const std::string html = html_report(comparison());
    EXPECT_GT(count_of(html, "<table"), 0u);
    EXPECT_EQ(count_of(html, "<table"), count_of(html, "<div class=\"scroll\"><table"));
    EXPECT_THAT(html, HasSubstr(".scroll { overflow-x: auto; max-width: 100%;"));
}

TEST(HtmlReport, HasThePicturesAndTheWorstPlaces) {
    const std::string html = html_report(comparison());
    const size_t methods = comparison().methods.size();
    for (const char* kind : {"picture", "difference", "tests", "nodes"})
        EXPECT_EQ(count_of(html, std::string("<img data-kind=\"") + kind), methods) << kind;
    EXPECT_GE(count_of(html, "crop of raytrace"), comparison().rates.size());
    EXPECT_EQ(count_of(html, "<svg"), 2 * comparison().rates.size());
    EXPECT_THAT(html, HasSubstr("logarithmic, the same scale for all"));
}

}  // namespace
}  // namespace trapeze
