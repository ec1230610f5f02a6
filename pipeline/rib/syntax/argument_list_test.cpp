#include <gtest/gtest.h>

#include "pipeline/rib/syntax/arguments.h"

namespace trapeze::rib {
namespace {

/// What an earlier request had must not show in a later one, nor in copies.
TEST(ArgumentList, BeginsEachRequestWithoutWhatWasBefore) {
    ArgumentList list;
    Argument& array = list.emplace_back();
    array.kind = Argument::Kind::Array;
    array.floats = {1, 2, 3};
    array.large_integers = {{0, 123456789.0}};
    Argument& text = list.emplace_back();
    text.kind = Argument::Kind::String;
    text.strings = {"name"};
    const ArgumentList copy = list;
    list.clear();
    EXPECT_TRUE(list.empty());
    for (int i = 0; i < 3; ++i) {
        const Argument& next = list.emplace_back();
        EXPECT_EQ(next.kind, Argument::Kind::Number);
        EXPECT_EQ(next.number, 0);
        EXPECT_TRUE(next.floats.empty() && next.strings.empty() && next.large_integers.empty());
    }
    list.clear();
    const ArgumentList nothing = list;
    EXPECT_EQ(nothing.begin(), nothing.end());
    ASSERT_EQ(copy.size(), 2u);
    EXPECT_EQ(copy[0].floats, (std::vector<float>{1, 2, 3}));
    EXPECT_EQ(copy.back().strings, (std::vector<std::string>{"name"}));
    ArgumentList source = copy;
    const ArgumentList taken = std::move(source);
    EXPECT_EQ(taken.size(), 2u);
    EXPECT_TRUE(source.empty());  // NOLINT: a list that was moved from is used again
}

}  // namespace
}  // namespace trapeze::rib
