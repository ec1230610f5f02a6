#include "pipeline/study/aff/aff_animation.h"

#include <gtest/gtest.h>

namespace trapeze {
namespace {

std::vector<std::pair<double, double>> ends_of(const AffSpans& spans) {
    std::vector<std::pair<double, double>> ends;
    for (const AffSpan& span : spans) ends.emplace_back(span.begin, span.end);
    return ends;
}

using Ends = std::vector<std::pair<double, double>>;
constexpr double kEver = std::numeric_limits<double>::infinity();

TEST(AffSpans, AreWhatVisibilityKeysSay) {
    EXPECT_EQ(ends_of(visible_spans({})), (Ends{{-kEver, kEver}}));
    EXPECT_EQ(ends_of(visible_spans({{.5, false}, {2, true}})), (Ends{{-kEver, .5}, {2, kEver}}));
    EXPECT_EQ(ends_of(visible_spans({{0, true}, {1, true}, {3, false}, {4, false}})), (Ends{{-kEver, 3}}));
    // What is so for no time is not.
    EXPECT_EQ(ends_of(visible_spans({{1, false}, {1, true}})), (Ends{{-kEver, kEver}}));
    EXPECT_EQ(ends_of(visible_spans({{1, false}, {2, true}, {2, false}, {3, true}})),
              (Ends{{-kEver, 1}, {3, kEver}}));
}

TEST(AffSpans, InCommonAreWhatIsInBoth) {
    const AffSpans a = {{0, 2}, {4, 6}, {8, kEver}}, b = {{-kEver, 1}, {5, 9}};
    EXPECT_EQ(ends_of(common_spans(a, b)), (Ends{{0, 1}, {5, 6}, {8, 9}}));
    EXPECT_EQ(ends_of(common_spans(b, a)), ends_of(common_spans(a, b)));
    EXPECT_TRUE(common_spans({{0, 1}}, {{1, 2}}).empty());
}

TEST(AffSpans, NearestIsTheTimeItselfWithinThem) {
    const AffSpans spans = {{0, 2}, {4, 6}};
    for (const double inside : {0.0, 1.0, 2.0, 4.5}) EXPECT_EQ(nearest_in_spans(spans, inside), inside);
    EXPECT_EQ(nearest_in_spans(spans, -3), 0);
    EXPECT_EQ(nearest_in_spans(spans, 2.9), 2);
    EXPECT_EQ(nearest_in_spans(spans, 3), 2);
    EXPECT_EQ(nearest_in_spans(spans, 3.1), 4);
    EXPECT_EQ(nearest_in_spans(spans, 9), 6);
    EXPECT_EQ(nearest_in_spans({}, 9), 9);
}

}  // namespace
}  // namespace trapeze
