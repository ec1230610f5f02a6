#include "composite/film/pixel_variables.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace trapeze {
namespace {

using ::testing::ElementsAre;

/// A colour that is summed, and a float by each of the other filters.
AovLayout layout_of_all() {
    AovLayout layout;
    layout.aovs = {{"c", 3, 0, VariableFilter::Picture},
                   {"f", 1, 3, VariableFilter::Min},
                   {"f", 1, 4, VariableFilter::Max},
                   {"f", 1, 5, VariableFilter::Nearest},
                   {"f", 1, 6, VariableFilter::Farthest}};
    layout.channel_count = 7;
    return layout;
}

TEST(PixelVariables, OneSampleStandsForThePixel) {
    const AovLayout layout = layout_of_all();
    PixelVariables kept(layout);
    for (int pixel = 0; pixel < 2; ++pixel) {
        kept.begin();
        EXPECT_THAT(kept.values(), ElementsAre(0, 0, 0, 0, 0, 0, 0));
        const struct {
            float value, depth;
        } samples[] = {{5, 7}, {-3, 9}, {8, 2}, {99, kInfinity}, {6, 2}, {4, 9}};
        for (const auto& sample : samples) {
            float values[] = {1, 2, 3, sample.value, sample.value, sample.value, sample.value};
            kept.take(values, sample.depth);
            EXPECT_THAT(values, ElementsAre(1, 2, 3, 0, 0, 0, 0));
        }
        EXPECT_THAT(kept.values(), ElementsAre(0, 0, 0, -3, 8, 8, -3));
    }
}

TEST(PixelVariables, PixelsThatSeeNothingAreZero) {
    const AovLayout layout = layout_of_all();
    PixelVariables kept(layout);
    kept.begin();
    float values[] = {1, 2, 3, 4, 5, 6, 7};
    kept.take(values, kInfinity);
    EXPECT_THAT(kept.values(), ElementsAre(0, 0, 0, 0, 0, 0, 0));
}

}  // namespace
}  // namespace trapeze
