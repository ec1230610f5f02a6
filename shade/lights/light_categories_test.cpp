#include "shade/lights/light_categories.h"

#include <gtest/gtest.h>

namespace trapeze {
namespace {

/// Which of four lights a list takes, by their letters. They are in the categories "key,rim", "key", "fill"
/// and none.
std::string taken(std::string_view wanted) {
    const LightCategories lights[] = {{"key,rim"}, {" key "}, {"fill"}, {""}};
    std::string result;
    for (size_t i = 0; i < std::size(lights); ++i)
        if (lights[i].fit(wanted)) result += static_cast<char>('a' + i);
    return result;
}

TEST(LightCategories, CommasAreOr) {
    EXPECT_EQ(taken(""), "abcd");
    EXPECT_EQ(taken("key"), "ab");
    EXPECT_EQ(taken("rim,fill"), "ac");
    EXPECT_EQ(taken(" rim , fill "), "ac");
    EXPECT_EQ(taken("ke"), "");
}

TEST(LightCategories, ALeadingMinusIsOfTheWholeList) {
    EXPECT_EQ(taken("-key"), "cd");
    EXPECT_EQ(taken("-rim,fill"), "bd");
    EXPECT_EQ(taken(" - rim, fill"), "bd");
}

TEST(LightCategories, AmpersandsBindCloser) {
    EXPECT_EQ(taken("key&rim"), "a");
    EXPECT_EQ(taken("key & -rim"), "b");
    EXPECT_EQ(taken("-key&-fill"), "d");
    EXPECT_EQ(taken("fill,key&rim"), "ac");
    EXPECT_EQ(taken("-key&-fill,rim"), "ad");
    EXPECT_EQ(taken("key&fill"), "");
}

TEST(LightCategories, SomeAreImplied) {
    const LightCategories plain{"key"}, soft{"", false, true, false}, bright{"", false, false, true};
    const LightCategories ambient{"", true}, named{"specular"}, two{"ambient,key"};
    EXPECT_TRUE(plain.has("diffuse") && plain.has("specular") && !plain.has("ambient"));
    EXPECT_TRUE(soft.has("diffuse") && !soft.has("specular"));
    EXPECT_TRUE(!bright.has("diffuse") && bright.has("specular"));
    EXPECT_TRUE(ambient.has("ambient") && !ambient.has("diffuse") && !ambient.has("specular"));
    EXPECT_TRUE(named.has("specular") && !named.has("diffuse"));
    EXPECT_TRUE(two.has("ambient") && two.has("key") && !two.has("diffuse") && !two.has("specular"));
    EXPECT_TRUE(plain.fit("diffuse&-indirect") && !plain.fit("diffuse&-key"));
}

TEST(LightCategories, AmbientOnesAreAskedForByName) {
    for (const char* list : {"ambient", "key, ambient", "ambient&-key", " ambient "})
        EXPECT_TRUE(names_ambient(list)) << list;
    for (const char* list : {"", "key", "-key", "-ambient", "-key,ambient", "key&-ambient", "ambients"})
        EXPECT_FALSE(names_ambient(list)) << list;
}

}  // namespace
}  // namespace trapeze
