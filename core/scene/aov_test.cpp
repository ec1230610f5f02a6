#include "core/scene/aov.h"

#include <gtest/gtest.h>

namespace trapeze {
namespace {

Display display_of(const char* name, ValueType type) {
    Display display;
    display.variable = DisplayVariable{name, type};
    return display;
}

TEST(AovLayout, EachVariableStandsOnceInTheOrderOfTheDisplays) {
    Options options;
    options.displays = {Display{}, display_of("N", ValueType::Normal), display_of("s", ValueType::Float),
                        display_of("N", ValueType::Vector),  // the same three numbers
                        display_of("s", ValueType::Color)};  // not the same
    const AovLayout layout = aov_layout(options);
    ASSERT_EQ(layout.aovs.size(), 3u);
    EXPECT_EQ(layout.channel_count, 3 + 1 + 3);
    EXPECT_EQ(layout.aovs[0].name, "N");
    EXPECT_EQ(layout.aovs[0].offset, 0);
    EXPECT_EQ(layout.aovs[1].offset, 3);
    EXPECT_EQ(layout.aovs[1].channels, 1);
    EXPECT_EQ(layout.aovs[2].offset, 4);
    EXPECT_EQ(layout.find({"N", ValueType::Point}), &layout.aovs[0]);
    EXPECT_EQ(layout.find({"s", ValueType::Color}), &layout.aovs[2]);
    // Opacity by channel is for colours alone.
    EXPECT_FALSE(layout.aovs[0].is_color);
    EXPECT_TRUE(layout.aovs[2].is_color);
    EXPECT_EQ(layout.find({"N", ValueType::Color}), nullptr);
    EXPECT_EQ(layout.find({"s", ValueType::Normal}), nullptr);
    EXPECT_EQ(layout.find({"t", ValueType::Float}), nullptr);
}

TEST(AovLayout, FiltersTellVariablesApart) {
    Options options;
    options.displays = {display_of("N", ValueType::Normal), display_of("N", ValueType::Normal),
                        display_of("N", ValueType::Normal)};
    options.displays[1].variable->filter = options.displays[2].variable->filter = VariableFilter::Nearest;
    const AovLayout layout = aov_layout(options);
    ASSERT_EQ(layout.aovs.size(), 2u);
    EXPECT_EQ(layout.find({"N", ValueType::Normal, VariableFilter::Nearest}), &layout.aovs[1]);
    EXPECT_EQ(layout.find({"N", ValueType::Normal}), &layout.aovs[0]);
    EXPECT_FALSE(layout.all_summed());
}

TEST(AovLayout, NothingIsAskedForByColourAndDepth) {
    Options options;
    options.displays = {Display{}, display_of("z", ValueType::Float)};
    EXPECT_TRUE(aov_layout(options).empty());
    EXPECT_TRUE(is_depth({"z", ValueType::Float}));
    EXPECT_FALSE(is_depth({"z", ValueType::Color}));
}

TEST(AovLayout, NobodySeesWhatNullDisplaysShow) {
    Options options;
    options.displays = {Display{}, display_of("N", ValueType::Normal), display_of("s", ValueType::Float)};
    options.displays[1].type = "Null";
    const AovLayout layout = aov_layout(options);
    EXPECT_EQ(layout.find({"N", ValueType::Normal}), nullptr);
    EXPECT_EQ(layout.channel_count, 1);
}

TEST(AovLayout, ItsChannelsAreBounded) {
    Options options;
    for (int i = 0; i < 100; ++i)
        options.displays.push_back(display_of(("v" + std::to_string(i)).c_str(), ValueType::Color));
    options.displays.push_back(display_of("v3", ValueType::Color));
    const AovLayout layout = aov_layout(options);
    EXPECT_EQ(layout.channel_count, kMostAovChannels);
    EXPECT_NE(layout.find({"v63", ValueType::Color}), nullptr);
    EXPECT_EQ(layout.find({"v64", ValueType::Color}), nullptr);
}

}  // namespace
}  // namespace trapeze
