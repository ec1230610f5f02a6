#include "pipeline/study/moving_checks.h"

#include <gtest/gtest.h>

namespace trapeze {
namespace {

void expect_all(const std::vector<StudyCheck>& checks, bool held) {
    for (const StudyCheck& check : checks) EXPECT_EQ(check.held, held) << check.claim << ": " << check.here;
}

TEST(MovingChecks, ThePapersOwnFiguresHoldThem) {
    for (int scene = 0; scene < paper::kMovingScenes; ++scene) {
        expect_all(checks_of_spatial_splits("", paper::kMsbvh[scene], paper::kMsbvh[scene]), true);
        expect_all(checks_of_kd_tree("", paper::kMbkd[scene], paper::kMsbvh[scene], paper::kMbkd[scene],
                                     paper::kMsbvh[scene]),
                   true);
    }
    for (const paper::SequenceClaims& report : {paper::kFalling, paper::kKitchen, paper::kMuseum}) {
        expect_all(checks_of_updates("", report.costs, report), true);
        EXPECT_EQ(checks_of_updates("", report.costs, report).size(), report.least_loose_total > 0 ? 4u : 3u);
    }
    const std::vector<double> refitted{10, 12, 15, 19, 24}, rebuilt{10, 10, 11, 10, 10};
    EXPECT_TRUE(check_of_refitting("", refitted, rebuilt).held);
    expect_all(checks_of_kd_variants("", {88, 100, 101, 93, 100}), true);
}

TEST(MovingChecks, CanMiss) {
    const paper::TreeRatios bad{3, 3, .9, 1, 1, 3, 3, 1}, msbvh{2, 2, .5, 1, .9, 2, 1, .9};
    expect_all(checks_of_spatial_splits("", bad, paper::kMsbvh[0]), false);
    expect_all(checks_of_kd_tree("", bad, msbvh, paper::kMbkd[0], paper::kMsbvh[0]), false);
    expect_all(checks_of_kd_variants("", {98, 100, 99, 98, 100}), false);
    const paper::SequenceCosts slow[3] = {{1, 1}, {.9, 1}, {.9, 1}};
    for (const paper::SequenceClaims& report : {paper::kFalling, paper::kKitchen, paper::kMuseum})
        expect_all(checks_of_updates("", slow, report), false);
    const std::vector<double> jumps{10, 20, 12, 14, 13}, rebuilt{10, 10, 10, 10, 10}, none{};
    EXPECT_FALSE(check_of_refitting("", jumps, rebuilt).held);
    EXPECT_FALSE(check_of_refitting("", rebuilt, rebuilt).held);
    EXPECT_FALSE(check_of_refitting("", none, none).held);
}

/// What was not measured holds nothing.
TEST(MovingChecks, OfNaiveClippingNeedsLostHitsOfItAlone) {
    EXPECT_TRUE(check_of_naive_clipping("", {12, 0, 100}).held);
    EXPECT_FALSE(check_of_naive_clipping("", {0, 0, 100}).held);
    EXPECT_FALSE(check_of_naive_clipping("", {12, 1, 100}).held);
}

TEST(MovingChecks, AreOfWhatThePaperHasFiguresOf) {
    using paper::kMsbvh, paper::kMbkd;
    EXPECT_EQ(checks_of_spatial_splits("", kMsbvh[0], kMsbvh[paper::kHairball]).size(), 4u);
    EXPECT_EQ(checks_of_spatial_splits("", kMsbvh[0], kMsbvh[paper::kBubs]).size(), 3u);
    EXPECT_EQ(checks_of_spatial_splits("", kMsbvh[0], kMsbvh[paper::kHand]).size(), 2u);
    EXPECT_EQ(checks_of_kd_tree("", kMbkd[0], kMsbvh[0], kMbkd[paper::kHand], kMsbvh[paper::kHand]).size(),
              4u);
    EXPECT_EQ(checks_of_kd_tree("", kMbkd[0], kMsbvh[0], kMbkd[paper::kFlake], kMsbvh[paper::kFlake]).size(),
              1u);
    EXPECT_TRUE(
        checks_of_kd_tree("", kMbkd[0], kMsbvh[0], kMbkd[paper::kCroc], kMsbvh[paper::kCroc]).empty());
}

TEST(MovingChecks, NumbersThatAreNoneHoldNothing) {
    const double nan = paper::kNoFigure;
    const paper::TreeRatios none{nan, nan, nan, nan, nan, nan, nan, nan};
    expect_all(checks_of_spatial_splits("", none, paper::kMsbvh[0]), false);
    expect_all(checks_of_kd_tree("", none, none, paper::kMbkd[0], paper::kMsbvh[0]), false);
    expect_all(checks_of_kd_variants("", {nan, nan, nan, nan, nan}), false);
}

}  // namespace
}  // namespace trapeze
