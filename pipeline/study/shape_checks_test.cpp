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
