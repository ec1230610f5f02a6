#include "pipeline/compare/verdict.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace trapeze {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

/// A result of given times and tests for 1000 samples and hits.
ComparedMethod method(const std::string& name, SampleRate rate, double build, double resolve,
                      uint64_t tests) {
    ComparedMethod m;
    std::string error;
    m.result.sampler = *choose_sampler(name, "", &error);
    m.result.method = name;
    m.result.pattern = m.result.sampler.pattern.name;
    m.result.rate = rate;
    m.result.build_seconds = {build, build, build};
    m.result.resolve_seconds = {resolve, resolve * 1.01, resolve * 0.99};
    m.result.sample.rays = m.result.sample.predicate_hits = 1000;
    m.result.sample.predicate_tests = tests;
    m.rmse = 0.01;
    return m;
}

Comparison comparison_of(std::vector<ComparedMethod> methods) {
    Comparison c;
    for (const ComparedMethod& m : methods)
        if (c.rates.empty() || !(c.rates.back() == m.result.rate)) c.rates.push_back(m.result.rate);
    c.methods = std::move(methods);
    c.frame.tessellate.micropolygons = 1234567;
    return c;
}

std::string joined(const Comparison& c) {
    std::string text;
    for (const std::string& sentence : judge(c)) text += sentence + "\n";
    return text;
}

constexpr SampleRate kOne{1, 1}, kMany{8, 8};

TEST(Verdict, SaysThatTheRayTracerWinsAndThatMissesAreWhy) {
    auto c =
        comparison_of({method("raytrace", kMany, 0.1, 0.4, 3000), method("interval", kMany, 0, 2, 41000)});
    c.blur.motion = {80, 20};
    const std::string text = joined(c);
    EXPECT_THAT(text, HasSubstr("1.23 million micropolygons"));
    EXPECT_THAT(text, HasSubstr("up to 80.0 pixels (median 20.0)"));
    EXPECT_THAT(text, HasSubstr("raytrace (500 ms) is the fastest, 4.00 times as fast as interval (2.00 s)"));
    EXPECT_THAT(text, HasSubstr("interval tests 40.0 micropolygons that miss, raytrace 2.00"));
    EXPECT_THAT(text, HasSubstr("For this scene take raytrace."));
}

TEST(Verdict, SaysWhereARasterizerWins) {
    const auto c =
        comparison_of({method("raytrace", kOne, 0.3, 0.1, 3000), method("interval", kOne, 0, 0.2, 9000),
                       method("raytrace", kMany, 0.3, 0.7, 3000), method("interval", kMany, 0, 4, 9000)});
    const std::string text = joined(c);
    EXPECT_THAT(text, HasSubstr("At 1x1 samples a pixel interval (200 ms) is the fastest"));
    EXPECT_THAT(text, HasSubstr("Building takes 75% of the time of raytrace; 1 samples a pixel"));
    EXPECT_THAT(text, HasSubstr("From 1x1 to 8x8 samples, 64.0 times as many"));
    EXPECT_THAT(text, HasSubstr("For this scene take interval at 1x1, raytrace from 8x8 on."));
}

TEST(Verdict, GivesNoReasonThatTheFiguresDoNotHold) {
    auto tracer =
        comparison_of({method("raytrace", kMany, 0, 1, 3000), method("interval", kMany, 0, 2, 3000)});
    EXPECT_THAT(joined(tracer), HasSubstr("Misses do not explain it"));
    auto raster =
        comparison_of({method("raytrace", kMany, 0, 2, 3000), method("interval", kMany, 0, 1, 9000)});
    EXPECT_THAT(joined(raster), HasSubstr("although it misses more often"));
    EXPECT_THAT(joined(raster), Not(HasSubstr("Building takes")));
}

TEST(Verdict, WhatIsNotCountedIsNotNamed) {
    const auto c = comparison_of({method("raytrace", kMany, 0, 1, 0), method("interval", kMany, 0, 2, 9000)});
    EXPECT_THAT(joined(c), HasSubstr("the fastest rasterizer.\n"));
}

TEST(Verdict, TimesWithinTheirSpreadAreNotToldApart) {
    auto c = comparison_of({method("raytrace", kMany, 0, 1, 3000), method("interval", kMany, 0, 1.2, 9000)});
    c.methods[0].result.resolve_seconds = {0.8, 1, 1.3};
    EXPECT_THAT(joined(c), HasSubstr("cannot be told apart"));
}

TEST(Verdict, WhereTimesAreEqualTheBaselineIsTaken) {
    auto c = comparison_of({method("raytrace", kOne, 0, 1.02, 3000), method("interval", kOne, 0, 1, 9000),
                            method("raytrace", kMany, 0, 1, 3000), method("interval", kMany, 0, 2, 9000)});
    EXPECT_THAT(joined(c), HasSubstr("For this scene take interval at 1x1, raytrace from 8x8 on."));
    c.baseline = "raytrace";
    EXPECT_THAT(joined(c), HasSubstr("For this scene take raytrace at every sample rate."));
    c.baseline = "interval";
    EXPECT_THAT(joined(c), HasSubstr("For this scene take interval at 1x1, raytrace from 8x8 on."));
}

TEST(Verdict, BruteForceTakesNoPart) {
    const auto c =
        comparison_of({method("raytrace", kMany, 0, 1, 3000), method("bruteforce", kMany, 0, 0.1, 9000)});
    EXPECT_THAT(joined(c), HasSubstr("For this scene take raytrace."));
    const auto alone = comparison_of({method("bruteforce", kMany, 0, 0.1, 9000)});
    EXPECT_THAT(joined(alone), HasSubstr("Nothing was compared"));
}

TEST(Verdict, AMethodThatSeesOtherThingsTakesNoPart) {
    auto c = comparison_of({method("raytrace", kMany, 0, 1, 3000), method("bruteforce", kMany, 0, 9, 3000),
                            method("raytrace:tree=paper", kMany, 0, 0.1, 3000)});
    c.baseline = "raytrace";
    for (ComparedMethod& m : c.methods) m.result.hits = 1000;
    EXPECT_THAT(joined(c), HasSubstr("For this scene take raytrace:tree=paper."));
    c.methods[2].result.hits = 0;
    EXPECT_THAT(joined(c), HasSubstr("raytrace:tree=paper finds 0 hits where raytrace finds 1000"));
    EXPECT_THAT(joined(c), HasSubstr("For this scene take raytrace."));
}

TEST(Verdict, ErrorsAreComparedWithTheirPatterns) {
    auto c = comparison_of({method("raytrace", kMany, 0, 1, 3000), method("interval", kMany, 0, 2, 9000)});
    EXPECT_THAT(joined(c), HasSubstr("differ by less than 5%"));
    c.methods[1].rmse = 0.02;
    EXPECT_THAT(joined(c), HasSubstr("least with raytrace (RMSE 0.0100, pattern stratified) and largest with "
                                     "interval (0.0200, interval)"));
}

}  // namespace
}  // namespace trapeze
