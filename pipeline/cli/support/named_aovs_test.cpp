#include "pipeline/cli/support/named_aovs.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace trapeze {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

std::vector<std::string> modes_of_aovs(const std::string& list) {
    std::string error;
    std::vector<std::string> modes;
    for (const Display& display : displays_of_aovs(list, &error)) modes.push_back(display.mode);
    EXPECT_EQ(error, "");
    return modes;
}

TEST(NamedAovs, AreModesAndVariables) {
    EXPECT_THAT(modes_of_aovs("albedo, N,uv ,z,id,alpha,crypto_object"),
                ElementsAre("albedo", "N", "u", "v", "z", "id", "a", "crypto_object"));
    std::string error;
    const auto displays = displays_of_aovs("float wet,P,vector  pref,lit", &error);
    ASSERT_EQ(displays.size(), 4u);
    EXPECT_EQ(displays[0].variable->type, ValueType::Float);
    EXPECT_EQ(displays[1].variable->filter, VariableFilter::Nearest);
    EXPECT_EQ(displays[2].variable->name, "pref");
    EXPECT_EQ(displays[2].variable->type, ValueType::Vector);
    EXPECT_EQ(displays[3].variable->type, ValueType::Color);
    EXPECT_EQ(displays[3].variable->filter, VariableFilter::Picture);
}

TEST(NamedAovs, WrongNamesAreErrors) {
    for (const char* list : {"", "N,,z", "crypto_shader", "string foo", "a-b", "color ", "N;z"}) {
        std::string error;
        EXPECT_THAT(displays_of_aovs(list, &error), IsEmpty()) << list;
        EXPECT_THAT(error, HasSubstr("is none of albedo")) << list;
    }
}

TEST(NamedAovs, BecomeLayersOfTheFirstFileUnlessItHasThem) {
    std::string error;
    const auto aovs = displays_of_aovs("N,z,alpha,id", &error);
    std::vector<Display> displays = {{"a.exr", "file", "rgbaz", {}, {}}, {"b.exr", "file", "id", {}, {}}};
    EXPECT_EQ(add_aovs(aovs, {}, displays), "a.exr");
    ASSERT_EQ(displays.size(), 4u);
    EXPECT_EQ(displays[2].mode, "N");
    EXPECT_EQ(displays[2].name, "a.exr");
    EXPECT_EQ(displays[3].mode, "id");
    EXPECT_EQ(add_aovs(aovs, {}, displays), "a.exr");
    EXPECT_EQ(displays.size(), 4u) << "all are there";
}

TEST(NamedAovs, LightGroupsAreThoseOfTheScene) {
    std::string error;
    std::vector<Display> displays = {{"a.exr", "file", "rgba", {}, {}}};
    add_aovs(displays_of_aovs("z,lightgroups", &error), {"default", "key"}, displays);
    ASSERT_EQ(displays.size(), 5u);
    EXPECT_EQ(displays[2].variable->name, "lightgroup:default");
    EXPECT_EQ(displays[3].variable->name, "lightgroup:key");
    EXPECT_EQ(displays[4].variable->name, "lightgroup:unlit");
    EXPECT_EQ(displays[4].variable->type, ValueType::Color);
}

TEST(NamedAovs, PicturesOfOtherFormatsHaveThemBeside) {
    std::string error;
    const auto aovs = displays_of_aovs("N,alpha", &error);
    std::vector<Display> displays = {{"dir/a.png", "png", "rgba", {}, {}}};
    EXPECT_EQ(add_aovs(aovs, {}, displays), "dir/a.exr");
    ASSERT_EQ(displays.size(), 3u);
    EXPECT_EQ(displays[1].name, "dir/a.exr");
    EXPECT_EQ(displays[1].type, "file");
    for (const char* type : {"null", "framebuffer", "openexr"}) {
        displays = {{"a", type, "rgba", {}, {}}};
        EXPECT_EQ(add_aovs(aovs, {}, displays), "a");
        EXPECT_EQ(displays.size(), 2u) << "alpha is there";
        EXPECT_EQ(displays.back().type, type);
    }
    // A deep picture shares no file.
    displays = {{"a.exr", "deepexr", "rgba", {}, {}}};
    EXPECT_EQ(add_aovs(aovs, {}, displays), "a.layers.exr");
    EXPECT_EQ(displays.back().type, "file");
}

}  // namespace
}  // namespace trapeze
