#include "tessellate/surfaces/nurbs/knot_spans.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace trapeze {
namespace {

/// A cubic of seven points with a double knot inside, of which a part is kept: spans 1..2, 2..4, 4..4.5.
const std::vector<float> kKnots{0, 0, 0, 0, 2, 2, 4, 5, 5, 5, 5};
constexpr int kOrder = 4;
KnotSpans part() {
    return {kKnots, kOrder, 1, 4.5f};
}

TEST(KnotSpans, LeaveOutEmptyIntervals) {
    const KnotSpans spans = part();
    ASSERT_EQ(spans.count(), 3);
    EXPECT_EQ(spans.segment(0), 0);
    EXPECT_EQ(spans.segment(1), 2);  // the empty interval counts
    EXPECT_EQ(spans.segment(2), 3);
    EXPECT_EQ(spans.parameter(0, 0), 1);
    EXPECT_EQ(spans.parameter(0, 1), 2);
    EXPECT_EQ(spans.parameter(1, .5f), 3);
    EXPECT_EQ(spans.parameter(2, 1), 4.5);
    EXPECT_EQ(spans.total_length(), 3.5);
}

TEST(KnotSpans, SharesAreOfTheRangeAndOfTheKnotInterval) {
    const KnotSpans spans = part();
    EXPECT_FLOAT_EQ(spans.share_of_range(1, .5f), 2 / 3.5f);
    EXPECT_FLOAT_EQ(spans.share_of_segment(0, 0), .5f);
    EXPECT_FLOAT_EQ(spans.share_of_segment(2, 1), .5f);
    for (int span = 0; span < spans.count(); ++span)
        for (const float t : {0.f, .25f, .75f})
            EXPECT_NEAR(spans.spans_before(spans.share_of_range(span, t)), static_cast<float>(span) + t,
                        1e-6);
    EXPECT_NEAR(spans.spans_before(-1 / 3.5), -1, 1e-12);
    EXPECT_NEAR(spans.spans_before(1 + .25 / 3.5), 3.5, 1e-12);
}

/// The definition, by recursion; the value of basis function i of an order at x.
double by_definition(int i, int order, double x) {
    const auto knot = [](int k) { return static_cast<double>(kKnots[static_cast<size_t>(k)]); };
    if (order == 1) return knot(i) <= x && x < knot(i + 1) ? 1 : 0;
    double value = 0;
    if (knot(i + order - 1) > knot(i))
        value += (x - knot(i)) / (knot(i + order - 1) - knot(i)) * by_definition(i, order - 1, x);
    if (knot(i + order) > knot(i + 1))
        value += (knot(i + order) - x) / (knot(i + order) - knot(i + 1)) * by_definition(i + 1, order - 1, x);
    return value;
}

TEST(KnotSpans, BasisIsThatOfTheDefinition) {
    const KnotSpans spans = part();
    for (int span = 0; span < spans.count(); ++span)
        for (const float t : {0.f, .125f, .5f, .9375f}) {
            const BasisValues basis = spans.basis(span, t);
            EXPECT_EQ(basis.first, spans.first_point(span));
            double sum = 0, slopes = 0;
            for (size_t i = 0; i < kOrder; ++i) {
                const int point = basis.first + static_cast<int>(i);
                EXPECT_NEAR(basis.value[i], by_definition(point, kOrder, spans.parameter(span, t)), 1e-12);
                sum += basis.value[i], slopes += basis.slope[i];
            }
            EXPECT_NEAR(sum, 1, 1e-12);
            EXPECT_NEAR(slopes, 0, 1e-12);
        }
}

TEST(KnotSpans, SlopesAreDifferencesOfValues) {
    const KnotSpans spans = part();
    constexpr float kStep = 0x1p-10f;
    for (int span = 0; span < spans.count(); ++span) {
        const BasisValues at = spans.basis(span, .5f), before = spans.basis(span, .5f - kStep),
                          after = spans.basis(span, .5f + kStep);
        for (size_t i = 0; i < kOrder; ++i)
            EXPECT_NEAR(at.slope[i], (after.value[i] - before.value[i]) / (2 * static_cast<double>(kStep)),
                        1e-5);
    }
}

/// A Bezier curve of the weights is the spline.
TEST(KnotSpans, BezierWeightsAreThoseOfTheSpline) {
    const KnotSpans spans = part();
    constexpr float kLow = .25f, kHigh = .75f;
    for (int span = 0; span < spans.count(); ++span) {
        std::array<double, kOrder * kOrder> weights;
        spans.bezier_weights(span, kLow, kHigh, weights);
        for (const double t : {0., .25, .5, 1.}) {
            const std::array<double, 4> bernstein{std::pow(1 - t, 3), 3 * t * std::pow(1 - t, 2),
                                                  3 * t * t * (1 - t), t * t * t};
            const BasisValues basis = spans.basis(span, kLow + (kHigh - kLow) * static_cast<float>(t));
            for (size_t i = 0; i < kOrder; ++i) {
                double weight = 0;
                for (size_t j = 0; j < kOrder; ++j) weight += bernstein[j] * weights[j * kOrder + i];
                EXPECT_NEAR(weight, basis.value[i], 1e-12);
            }
        }
    }
}

}  // namespace
}  // namespace trapeze
