#include "core/scene/user_values.h"

#include <gtest/gtest.h>

namespace trapeze {
namespace {

Parameter user_value(float value) {
    return {"a", {StorageClass::Uniform, ValueType::Float, 1}, {value}, {}};
}

TEST(CategoryValues, LaterValuesOfANameReplaceEarlierOnes) {
    CategoryValues values;
    EXPECT_EQ(values.find("a"), nullptr);
    values.set({"b", {StorageClass::Uniform, ValueType::String, 1}, {}, {"text"}});
    values.set(user_value(1));
    values.set(user_value(2));
    EXPECT_EQ(values.find("a")->floats, std::vector<float>{2});
    EXPECT_EQ(values.float_or("a", 0), 2);
    EXPECT_EQ(values.float_or("b", 5), 5) << "it has no number";
    EXPECT_EQ(values.string_or("b", ""), "text");
    EXPECT_EQ(std::distance(values.begin(), values.end()), 2);
}

TEST(UserValues, CopiesDoNotSeeEachOthersChanges) {
    UserValues first;
    EXPECT_TRUE(first.empty());
    EXPECT_FALSE(first.contains("user"));
    first.change("user").set(user_value(1));
    UserValues second = first;
    EXPECT_EQ(&first.at("user"), &second.at("user")) << "shared until one changes";
    second.change("user").set(user_value(2));
    second.change("other").set(user_value(3));
    EXPECT_EQ(first.at("user").float_or("a", 0), 1);
    EXPECT_EQ(second.at("user").float_or("a", 0), 2);
    EXPECT_EQ(first.find("other"), first.end());
    EXPECT_NE(second.find("other"), second.end());
    const UserValues third = first;
    first.change("user").set(user_value(4));
    EXPECT_EQ(third.at("user").float_or("a", 0), 1);
}

}  // namespace
}  // namespace trapeze
