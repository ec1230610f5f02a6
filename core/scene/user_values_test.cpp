#include "core/scene/user_values.h"

#include <gtest/gtest.h>

#include <map>
#include <string>

namespace trapeze {
namespace {

Parameter number(const std::string& name, float value) {
    return {name, {StorageClass::Uniform, ValueType::Float, 1}, {value}, {}};
}

TEST(UserValues, LaterValuesOfANameReplaceEarlierOnes) {
    UserValues values;
    EXPECT_TRUE(values.empty());
    EXPECT_EQ(values.find("user", "a"), nullptr);
    values.set("user", {"b", {StorageClass::Uniform, ValueType::String, 1}, {}, {"text"}});
    values.set("user", number("a", 1));
    values.set("user", number("a", 2));
    values.set("other", number("a", 3));
    EXPECT_EQ(values.find("user", "a")->floats, std::vector<float>{2});
    EXPECT_EQ(values.find("a")->floats, std::vector<float>{2});
    EXPECT_EQ(values.find("other:a")->floats, std::vector<float>{3});
    EXPECT_EQ(values.find("other:b"), nullptr);
    EXPECT_EQ(values.float_or("user", "b", 5), 5) << "it has no number";
    EXPECT_EQ(values.string_or("user", "b", ""), "text");
    EXPECT_TRUE(values.has_category("user") && values.has_category("other"));
    EXPECT_FALSE(values.has_category("oth") || values.has_category("users"));
}

TEST(UserValues, CopiesDoNotSeeEachOthersChanges) {
    UserValues first;
    first.set("user", number("a", 1));
    UserValues second = first;
    EXPECT_EQ(first.find("a"), second.find("a")) << "shared until one changes";
    second.set("user", number("a", 2));
    second.set("other", number("a", 3));
    EXPECT_EQ(first.float_or("user", "a", 0), 1);
    EXPECT_EQ(second.float_or("user", "a", 0), 2);
    EXPECT_FALSE(first.has_category("other"));
    const UserValues third = first;
    first.set("user", number("a", 4));
    EXPECT_EQ(third.float_or("user", "a", 0), 1);
}

/// In whatever order they come: as in a map, and told in its order.
TEST(UserValues, AreThoseOfAMap) {
    for (const int step : {1, 999, 357, 618}) {
        UserValues values;
        std::map<std::pair<std::string, std::string>, float> truth;
        for (int i = 0, k = 0; i < 1000; ++i, k = (k + step) % 1000) {
            const std::string category = "c" + std::to_string(k % 7), name = std::to_string(k % 500);
            const auto value = static_cast<float>(i);
            truth[{category, name}] = value;
            values.set(category, number(name, value));
        }
        auto expected = truth.begin();
        values.for_each([&](const std::string& category, const Parameter& parameter) {
            ASSERT_NE(expected, truth.end());
            EXPECT_EQ(std::pair(category, parameter.name), expected->first);
            EXPECT_EQ(parameter.floats[0], expected->second);
            EXPECT_EQ(values.find(category, parameter.name), &parameter);
            ++expected;
        });
        EXPECT_EQ(expected, truth.end());
    }
}

/// Ten thousand copies that differ from each other in a value take as many nodes as the tree is high for
/// each.
TEST(UserValues, CopiesTakeWhatTheyDifferIn) {
    std::vector<UserValues> copies(1);
    size_t bytes = 0;
    for (int i = 0; i < 10000; ++i) {
        UserValues next = copies.back();
        next.set("user", number("name" + std::to_string(i), 1));
        bytes += next.count_bytes();
        EXPECT_EQ(next.count_bytes(), 0u) << "counted once";
        copies.push_back(std::move(next));
    }
    EXPECT_LT(bytes, 10000u * 1500);
    EXPECT_GT(bytes, 10000u * 500);
}

}  // namespace
}  // namespace trapeze
