#include "pipeline/study/shape_checks.h"

#include <gtest/gtest.h>

#include "pipeline/study/paper_figures.h"

namespace trapeze {
namespace {

RateSeries furball() {
    RateSeries series{"Furball", {1, 16, 64, 169}, {}};
    for (const auto& row : paper::kTable5[0]) series.seconds.emplace_back(row, row + 4);
    return series;
}

TEST(ShapeChecks, ExponentOfAPower) {
    EXPECT_NEAR(growth_exponent(2, 3 * 4, 5, 3 * 25), 2, 1e-12);
    EXPECT_NEAR(growth_exponent(1, 7, 100, 7), 0, 1e-12);
}

TEST(ShapeChecks, SpreadIsLargestToSmallest) {
    EXPECT_DOUBLE_EQ(spread({3, 2, 8}), 4);
    EXPECT_EQ(spread({}), 0);
}

/// Expects that of some checks all hold but one.
void expect_only_missed(const std::vector<StudyCheck>& checks, size_t missed) {
    ASSERT_LT(missed, checks.size());
    for (size_t i = 0; i < checks.size(); ++i)
        EXPECT_EQ(checks[i].held, i != missed) << checks[i].claim << ": " << checks[i].here;
}

void expect_held(const std::vector<StudyCheck>& checks) {
    for (const StudyCheck& check : checks) EXPECT_TRUE(check.held) << check.claim << ": " << check.here;
}

TEST(ShapeChecks, ThePapersOwnFiguresHoldThem) {
    for (const StudyCheck& check : checks_of_rates(furball(), furball())) {
        EXPECT_TRUE(check.held) << check.claim << ": " << check.here;
        EXPECT_EQ(check.here, check.paper);
    }
}

TEST(ShapeChecks, CanMiss) {
    RateSeries flat = furball();
    flat.seconds[2] = flat.seconds[3] = {9, 9, 9, 9};  // k = 2 and 4: not linear, equal, behind at 1x1
    flat.seconds[1] = {1, 16, 64, 169};                // INTERVAL linear
    for (const StudyCheck& check : checks_of_rates(flat, furball())) EXPECT_FALSE(check.held) << check.claim;
}

TEST(ShapeChecks, CoarserShadingAndOrder) {
    const std::vector<double> reference = {10, 20, 30, 40}, helps_rasterizers = {9, 5, 6, 7},
                              helps_all = {1, 5, 6, 7};
    EXPECT_TRUE(check_of_coarser_shading("", reference, helps_rasterizers, reference, reference).held);
    EXPECT_FALSE(check_of_coarser_shading("", reference, helps_all, reference, reference).held);
    EXPECT_TRUE(check_of_order("", reference, reference).held);
    EXPECT_FALSE(check_of_order("", helps_rasterizers, reference).held);
}

TEST(ShapeChecks, GrowthLikeTheLogarithm) {
    const std::vector<double> counts = {1e5, 1e6, 1e7};
    const GrowthSeries logarithmic{"", counts, {500, 600, 700}, {20, 24, 28}},
        flat{"", counts, {9, 9, 9}, {3, 3, 3}}, root{"", counts, {500, 1000, 2000}, {20, 24, 28}};
    for (const StudyCheck& check : checks_of_growth(flat, logarithmic))
        EXPECT_TRUE(check.held) << check.claim;
    for (const StudyCheck& check : checks_of_growth(root, {"", counts, {400, 800, 1600}, {20, 24, 28}}))
        EXPECT_FALSE(check.held) << check.claim;
    EXPECT_FALSE(
        checks_of_growth(flat, {"", counts, {500, 600, 700}, {20, 40, 80}}).front().held);  // by nodes
    for (const std::vector<double>& time : {std::vector<double>{500, 400, 300}, {500, 1200, 700}})
        EXPECT_FALSE(checks_of_growth(flat, {"", counts, time, {20, 24, 28}}).front().held);
    // The logarithm of few more grows by less than the factor that is allowed; yet what falls does not grow.
    const std::vector<double> near = {1e5, 2e5, 4e5};
    EXPECT_TRUE(checks_of_growth(flat, {"", near, {500, 500, 510}, {20, 21, 22}}).front().held);
    for (const std::vector<double>& time : {std::vector<double>{500, 480, 490}, {500, 540, 530}}) {
        EXPECT_FALSE(checks_of_growth(flat, {"", near, time, {20, 21, 22}}).front().held) << "by time";
        EXPECT_FALSE(checks_of_growth(flat, {"", near, {500, 520, 540}, time}).front().held) << "by nodes";
    }
}

/// Each check of the rates by itself: what is planted in the paper's own figures is missed by it alone.
TEST(ShapeChecks, EachOfRatesMissesWhatIsPlanted) {
    constexpr size_t kTraced = 0, kInterval = 1, kUvt2 = 2, kUvt4 = 3;
    const RateSeries paper = furball();
    const auto planted = [&](size_t method, size_t rate, double seconds) {
        RateSeries series = paper;
        series.seconds[method][rate] = seconds;
        return checks_of_rates(series, paper);
    };
    const auto& seconds = paper.seconds;
    expect_only_missed(planted(kUvt2, 1, 3 * seconds[kUvt2][1]), 0);  // less than linear from there on
    expect_only_missed(planted(kUvt2, 1, seconds[kUvt2][1] / 3), 0);  // more
    expect_only_missed(planted(kInterval, 3, 100 * seconds[kInterval][3]), 1);
    expect_only_missed(planted(kUvt4, 3, 4.1 * seconds[kUvt2][3]), 2);
    expect_only_missed(planted(kUvt4, 3, .9 * seconds[kUvt2][3]), 2);
    expect_only_missed(planted(kTraced, 0, .9 * seconds[kUvt2][0]), 3);    // ahead of k = 2 at 1x1
    expect_only_missed(planted(kTraced, 3, 1000 * seconds[kUvt2][3]), 3);  // gains nothing from samples
}

TEST(ShapeChecks, CoarserShadingHelpsEveryRasterizer) {
    const std::vector<double> reference = {10, 20, 30, 40};
    for (size_t method = 1; method < 4; ++method) {
        std::vector<double> coarser = {9, 5, 6, 7};
        coarser[method] = .95 * reference[method];
        EXPECT_FALSE(check_of_coarser_shading("", reference, coarser, reference, reference).held) << method;
        std::vector<double> order = reference;
        order[method] = 9.9;
        EXPECT_FALSE(check_of_order("", order, reference).held) << method;
    }
}

TEST(ShapeChecks, EachOfEffectsMissesWhatIsPlanted) {
    const std::vector<std::vector<double>> good = {{3, 3, 4}, {5, 6, 12}, {8, 8, 9}, {20, 20, 20}};
    expect_held(checks_of_effects(good, good));
    auto planted = good;
    planted[2][2] = 10.1;  // k = 2 dearer for both effects
    expect_only_missed(checks_of_effects(planted, good), 0);
    planted = good, planted[1][2] = 8.9;  // INTERVAL hardly dearer for both
    expect_only_missed(checks_of_effects(planted, good), 1);
    planted = good, planted[0][2] = 6;  // as INTERVAL
    expect_only_missed(checks_of_effects(planted, good), 2);
}

TEST(ShapeChecks, EachOfStructureMissesWhatIsPlanted) {
    const std::vector<std::vector<double>> rmse = {{1, 1, 1}, {1, 1, 2}, {2, 2, 2}, {1.5, 1.5, 1.5}},
                                           together = {{3, 3, 3}, {3.2, 3.1, 9}, {12, 14, 16}, {5, 5, 6}};
    expect_held(checks_of_structure(rmse, together));
    auto planted = together;
    planted[1][1] = 3.4;  // INTERVAL aliases with motion blur alone
    expect_only_missed(checks_of_structure(rmse, planted), 0);
    planted = together, planted[1][2] = 3.3;  // nor with both
    expect_only_missed(checks_of_structure(rmse, planted), 1);
    planted = together, planted[3][0] = 12.1;  // k = 4 as k = 2 with one of the effects
    expect_only_missed(checks_of_structure(rmse, planted), 2);
    planted = together, planted[3][2] = 2.9;  // k = 4 less than ray tracing
    expect_only_missed(checks_of_structure(rmse, planted), 2);
    planted = rmse, planted[3][1] = 1;  // k = 4 with no more noise
    expect_only_missed(checks_of_structure(planted, together), 3);
}

TEST(ShapeChecks, EachOfASweepMissesWhatIsPlanted) {
    const std::vector<std::vector<double>> good = {{4, 5, 6}, {4, 6, 8}, {20, 20, 20}};
    const std::vector<double> alone = {100, 120, 130};
    expect_held(checks_of_sweep("", good, alone));
    auto planted = good;
    planted[1][2] = 6;  // INTERVAL grows no more
    expect_only_missed(checks_of_sweep("", planted, alone), 0);
    planted = good, planted[2][1] = 4.9;  // k = 4 ahead in the middle
    expect_only_missed(checks_of_sweep("", planted, alone), 1);
    planted = good, planted[0][1] = 10.1;  // dear in the middle
    expect_only_missed(checks_of_sweep("", planted, alone), 2);
    expect_only_missed(checks_of_sweep("", good, {100, 251, 130}), 3);
}

TEST(ShapeChecks, EachOfSplitsAndBoundsMissesWhatIsPlanted) {
    const SplitCosts good{-.01, .6, .95};
    expect_held(checks_of_splits(good, good));
    expect_only_missed(checks_of_splits({.001, .6, .95}, good), 0);
    expect_only_missed(checks_of_splits({-.01, .5, .95}, good), 1);
    expect_only_missed(checks_of_splits({-.01, .6, .89}, good), 2);
    EXPECT_TRUE(check_of_bounds("", "AABBs", 1.5, 1.4).held);
    EXPECT_FALSE(check_of_bounds("", "AABBs", 1.39, 1.4).held);
    EXPECT_TRUE(check_of_parametric_splits("", {2.1, .95}, {3, 1}).held);
    EXPECT_FALSE(check_of_parametric_splits("", {2, .95}, {3, 1}).held) << "builds as fast";
    EXPECT_FALSE(check_of_parametric_splits("", {2.1, .94}, {3, 1}).held) << "traces slower";
}

TEST(ShapeChecks, EachOfGrowthMissesWhatIsPlanted) {
    const std::vector<double> counts = {1e5, 1e6, 1e7};
    const GrowthSeries alone{"", counts, {500, 600, 700}, {20, 24, 28}};
    expect_held(checks_of_growth({"", counts, {9, 9, 9}, {3, 3, 3}}, alone));
    expect_only_missed(
        checks_of_growth({"", counts, {9, 9, 9}, {3, 3, 3}}, {"", counts, {500, 600, 450}, {20, 24, 28}}), 0);
    expect_only_missed(checks_of_growth({"", counts, {9, 20, 60}, {3, 3, 3}}, alone), 1);
    expect_only_missed(checks_of_growth({"", counts, {9, 601, 9}, {3, 3, 3}}, alone), 2);
}

TEST(ShapeChecks, BlurOfAnySizeCounts) {
    EXPECT_TRUE(check_of_blur("", {4, 6, 5}).held);
    EXPECT_FALSE(check_of_blur("", {4, 12, 5}).held) << "in the middle";
}

TEST(ShapeChecks, WhatIsIllegibleIsNotCompared) {
    RateSeries car{"Car", {1, 16, 64, 529}, {}};
    for (const auto& row : paper::kTable5[3]) car.seconds.emplace_back(row, row + 4);
    for (const StudyCheck& check : checks_of_rates(furball(), car)) EXPECT_EQ(check.paper, "-");
}

}  // namespace
}  // namespace trapeze
