#include "pipeline/rib/programs/end_of_answer.h"

#include <gtest/gtest.h>

#include <string>

namespace trapeze::rib {
namespace {

/// The end, looked for after each byte; the same at once.
std::optional<size_t> end_of(const std::string& bytes) {
    EndOfAnswer slow, fast;
    std::optional<size_t> place;
    for (size_t length = 0; length <= bytes.size() && !place; ++length)
        place = slow.find(std::string_view(bytes).substr(0, length));
    EXPECT_EQ(fast.find(bytes), place);
    return place;
}

TEST(EndOfAnswer, IsTheByte0377) {
    EXPECT_EQ(end_of("Sphere 1 -1 1 360\n\xff"), 18u);
    EXPECT_EQ(end_of("\xff more"), 0u);
    EXPECT_EQ(end_of("Sphere 1"), std::nullopt);
}

/// As Python's print("\377") has it, say.
TEST(EndOfAnswer, IsThatCharacterInUtf8) {
    EXPECT_EQ(end_of("Sphere 1 -1 1 360\n\xc3\xbf\n"), 18u);
    EXPECT_EQ(end_of("\xc3\xbf"), 0u);
    EXPECT_EQ(end_of("Sphere 1\xc3"), std::nullopt);
    EXPECT_EQ(end_of("\"\xc3\xbf\" # \xc3\xbf\n\xc3\xbf"), 10u);
    EXPECT_EQ(end_of("\xc3\xc3\xbf"), 1u);
}

TEST(EndOfAnswer, IsNotWithinStringsAndComments) {
    EXPECT_EQ(end_of("\"\xff\" \xff"), 4u);
    EXPECT_EQ(end_of("\"\\\"\xff\" \xff"), 6u);
    EXPECT_EQ(end_of("# \xff \"\n\xff"), 6u);
    EXPECT_EQ(end_of("\"# \\\\\"\xff"), 6u);
    EXPECT_EQ(end_of("\"\xff"), std::nullopt);
}

TEST(EndOfAnswer, IsNotWithinEncodedValues) {
    EXPECT_EQ(end_of("\x80\xff\xff"), 2u);                                // an integer of one byte
    EXPECT_EQ(end_of("\xc8\x01\xff\xff\xff\xff\xff"), 6u);                // an array of one float
    EXPECT_EQ(end_of("\xa0\x02\xff\xff\xff"), 4u);                        // a string of two
    EXPECT_EQ(end_of("\xcb\xff\xff\xff\xff\xff\xff\xff"), std::nullopt);  // longer than all there is
}

}  // namespace
}  // namespace trapeze::rib
