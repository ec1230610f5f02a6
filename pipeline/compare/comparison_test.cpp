#include "pipeline/compare/comparison.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "pipeline/compare/compare_harness.h"
#include "pipeline/compare/report/html_report.h"
#include "pipeline/compare/results_json.h"
#include "pipeline/compare/table.h"
#include "pipeline/compare/value_text.h"

namespace trapeze {
namespace {

using ::testing::HasSubstr;
using testing::samplers_of;
using testing::SharedScene;

CompareSettings settings_of(const std::vector<std::string>& names, std::vector<SampleRate> rates) {
    CompareSettings settings;
    settings.samplers = samplers_of(names);
    settings.rates = std::move(rates);
    settings.measure.rounds = 1;
    settings.reference_side = 8;
    return settings;
}

TEST(Compare, MorePictureSamplesMeanLessError) {
    const SharedScene shared("defocus_motion.rib");
    const auto c = compare(*shared.frame, settings_of({"raytrace", "interval"}, {{1, 1}, {4, 4}}));
    ASSERT_TRUE(c);
    ASSERT_EQ(c->methods.size(), 4u);
    EXPECT_EQ(c->baseline, "raytrace");
    EXPECT_EQ(c->methods[0].ratio, 1);
    EXPECT_GT(c->methods[1].ratio, 0);
    EXPECT_LT(c->methods[2].rmse, 0.7 * c->methods[0].rmse);
    EXPECT_LT(c->methods[3].rmse, 0.7 * c->methods[1].rmse);
    for (const size_t few : {0, 1}) {
        EXPECT_GT(c->methods[few + 2].flip, 0);
        EXPECT_LT(c->methods[few + 2].flip, c->methods[few].flip);
        EXPECT_LT(c->methods[few].flip, 1);
    }
    EXPECT_GT(c->blur.motion.largest, 1);
    EXPECT_GT(c->blur.defocus.largest, 1);
    EXPECT_FALSE(c->verdict.empty());
}

TEST(Compare, TheReferenceTakesOtherSamplesThanTheMethods) {
    const SharedScene shared("defocus_motion.rib");
    const auto c = compare(*shared.frame, settings_of({"raytrace"}, {{8, 8}}));
    ASSERT_TRUE(c);
    EXPECT_GT(c->methods[0].rmse, 0) << "the same picture has no error to show";
}

TEST(Compare, HeatMapsAddUpToTheCounts) {
    // A box filter of a pixel takes no samples beyond the picture.
    const SharedScene shared("filter_box.rib");
    const auto c = compare(*shared.frame, settings_of({"raytrace", "interval"}, {{2, 2}}));
    ASSERT_TRUE(c);
    for (const ComparedMethod& m : c->methods) {
        const HeatMap& heat = m.picture.heat;
        ASSERT_EQ(heat.pixels, m.picture.image.window);
        double tests = 0;
        for (const float t : heat.tests) tests += static_cast<double>(t) * m.result.rate.per_pixel();
        EXPECT_EQ(shared.frame->pixels, heat.pixels);
        EXPECT_NEAR(tests, static_cast<double>(m.result.sample.predicate_tests), 0.5) << m.result.method;
    }
}

/// A row of its own where the rate has levels, which takes no part in the contest.
TEST(Compare, AdaptiveSamplesAreARowOfTheirOwn) {
    const SharedScene shared("filter_box.rib");
    CompareSettings settings = settings_of({"interval", "raytrace"}, {{1, 1}, {8, 8}});
    settings.measure.variance = 1e-3f;
    const auto c = compare(*shared.frame, settings);
    ASSERT_TRUE(c);
    ASSERT_EQ(c->methods.size(), 5u);
    const ComparedMethod &whole = c->methods[3], &adaptive = c->methods[4];
    EXPECT_EQ(adaptive.result.method, "raytrace adaptive");
    EXPECT_EQ(whole.result.samples_per_pixel(), 64);
    EXPECT_GT(adaptive.result.samples_per_pixel(), 16);
    EXPECT_LT(adaptive.result.samples_per_pixel(), 64);
    EXPECT_GT(adaptive.rmse, whole.rmse);
    EXPECT_LT(adaptive.rmse, 3 * whole.rmse);
    double samples = 0;
    for (const float count : adaptive.picture.heat.samples) {
        ASSERT_TRUE(count == 16 || count == 64) << count;
        samples += static_cast<double>(count);
    }
    EXPECT_EQ(samples, static_cast<double>(adaptive.result.sample.rays));
    for (const float count : whole.picture.heat.samples) ASSERT_EQ(count, 64);
    EXPECT_THAT(c->verdict, ::testing::Contains(HasSubstr("raytrace adaptive takes")));
    EXPECT_THAT(c->verdict.back(), ::testing::Not(HasSubstr("adaptive")));
    EXPECT_EQ(to_json(adaptive.result)["variance"].get<float>(), 1e-3f);
    EXPECT_THAT(html_report(*c), HasSubstr("data-kind=\"samples\""));
}

TEST(Compare, TheBaselineIsTheDefaultRayTracerIfItIsThere) {
    EXPECT_EQ(baseline_of(samplers_of({"interval", "raytrace:tree=paper", "raytrace"})), "raytrace");
    EXPECT_EQ(baseline_of(samplers_of({"interval", "raytrace:tree=paper"})), "raytrace:tree=paper");
    EXPECT_EQ(baseline_of(samplers_of({"interval", "bruteforce"})), "interval");
}

TEST(ValueText, ThreeDigitsAndTheUnitThatFits) {
    EXPECT_EQ(seconds_text(0.0123456), "12.3 ms");
    EXPECT_EQ(seconds_text(0.99999), "1.00 s");
    EXPECT_EQ(seconds_text(123.4), "123 s");
    EXPECT_EQ(number_text(0), "0");
    EXPECT_EQ(number_text(0.01234), "0.0123");
    EXPECT_EQ(number_text(12345), "12345");
    EXPECT_EQ(number_text(0.000123), "1.23e-04");
    EXPECT_EQ(counted_text(0), "-");
    EXPECT_EQ(counted_text(2), "2.00");
    EXPECT_EQ(count_text(2.5e6), "2.50 million");
}

TEST(Table, HasEveryFigureOfEveryMethod) {
    const SharedScene shared("quadric_sphere.rib");
    const auto c =
        compare(*shared.frame, settings_of({"raytrace:tree=paper,bundle=off", "interval"}, {{2, 1}}));
    ASSERT_TRUE(c);
    const std::string text = table_text(*c);
    for (const ComparedMethod& m : c->methods) {
        EXPECT_THAT(text, HasSubstr(m.result.method));
        for (const TableColumn& column : table_columns())
            EXPECT_THAT(text, HasSubstr(column.text(column.value(m)))) << column.title;
    }
    EXPECT_THAT(text, HasSubstr("2x1"));
}

TEST(ComparisonJson, HasTheFiguresAndTheVerdict) {
    const SharedScene shared("quadric_sphere.rib");
    auto c = compare(*shared.frame, settings_of({"raytrace"}, {{2, 2}}));
    ASSERT_TRUE(c);
    c->scene = "a \"name\"";
    c->command = {"compare", "--seed", "7"}, c->seed = 7, c->machine.revision = "v1-2-gabc";
    const auto json = nlohmann::json::parse(to_json(*c).dump());
    EXPECT_EQ(json["scene"], c->scene);
    EXPECT_EQ(json["command"], (std::vector<std::string>{"compare", "--seed", "7"}));
    EXPECT_EQ(json["seed"], 7);
    EXPECT_EQ(json["machine"]["revision"], "v1-2-gabc");
    EXPECT_EQ(json["results"][0]["rmse"].get<double>(), c->methods[0].rmse);
    EXPECT_EQ(json["results"][0]["flip"].get<double>(), c->methods[0].flip);
    EXPECT_EQ(json["results"][0]["ratio_to_baseline"].get<double>(), 1);
    EXPECT_EQ(json["reference_samples"], 64);
    EXPECT_EQ(json["verdict"].size(), c->verdict.size());
    EXPECT_EQ(json["machine"]["threads"], c->machine.threads);
    EXPECT_GT(json["micropolygons"].get<int>(), 100);
}

}  // namespace
}  // namespace trapeze
