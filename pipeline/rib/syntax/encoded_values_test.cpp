#include "pipeline/rib/syntax/encoded_values.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>

namespace trapeze::rib {
namespace {

using ::testing::ElementsAre;

/// Bytes by their octal numbers, as table C.1 has them.
std::string octal(std::initializer_list<int> bytes) {
    std::string text;
    for (const int byte : bytes) text += static_cast<char>(byte);
    return text;
}

double number(std::initializer_list<int> bytes) {
    const std::string text = octal(bytes);
    const EncodedValue value = encoded_value(text);
    EXPECT_EQ(value.length, text.size());
    return decoded_number(value, text);
}

TEST(EncodedValues, Integers) {
    EXPECT_EQ(number({0200, 5}), 5);
    EXPECT_EQ(number({0200, 0377}), -1);
    EXPECT_EQ(number({0200, 0200}), -128);
    EXPECT_EQ(number({0201, 1, 2}), 258);
    EXPECT_EQ(number({0201, 0377, 0376}), -2);
    EXPECT_EQ(number({0202, 1, 0, 0}), 65536);
    EXPECT_EQ(number({0203, 0177, 0377, 0377, 0377}), 2147483647.0);
    EXPECT_EQ(number({0203, 0200, 0, 0, 0}), -2147483648.0);
}

TEST(EncodedValues, FixedPointNumbers) {
    EXPECT_EQ(number({0204, 0100}), 0.25);  // one byte, all of it fraction
    EXPECT_EQ(number({0204, 0300}), -0.25);
    EXPECT_EQ(number({0205, 3, 0200}), 3.5);  // two bytes, one of fraction
    EXPECT_EQ(number({0205, 0377, 0200}), -0.5);
    EXPECT_EQ(number({0211, 0100, 0}), 0.25);       // two bytes, both fraction
    EXPECT_EQ(number({0217, 1, 0200, 0, 0}), 1.5);  // four bytes, three of fraction
    EXPECT_EQ(number({0214, 1}), 1.0 / (1 << 24));  // one byte, three places down
}

TEST(EncodedValues, FloatsAndDoubles) {
    EXPECT_EQ(number({0244, 0077, 0200, 0, 0}), 1);
    EXPECT_EQ(number({0244, 0300, 0040, 0, 0}), -2.5);
    EXPECT_EQ(number({0245, 0100, 0, 0, 0, 0, 0, 0, 0}), 2);
    EXPECT_EQ(number({0245, 0177, 0340, 0, 0, 0, 0, 0, 0}), std::numeric_limits<double>::infinity());
    EXPECT_FALSE(number({0244, 0177, 0300, 0, 0}) == 0);
    EXPECT_EQ(number({0244, 0177, 0200, 0, 0}), std::numeric_limits<double>::infinity());
}

TEST(EncodedValues, LengthsOfStringsAndArrays) {
    EXPECT_EQ(encoded_value(octal({0220})).length, 1u);
    EXPECT_EQ(encoded_value(octal({0237})).length, 16u);
    EXPECT_EQ(encoded_value(octal({0240, 0310})).length, 202u);
    EXPECT_EQ(encoded_value(octal({0241, 1, 0})).length, 259u);
    EXPECT_EQ(encoded_value(octal({0243, 0377, 0377, 0377, 0377})).length, 5 + uint64_t{4294967295u});
    EXPECT_EQ(encoded_value(octal({0310, 3})).length, 14u);
    EXPECT_EQ(encoded_value(octal({0313, 0377, 0377, 0377, 0377})).length, 5 + 4 * uint64_t{4294967295u});
    EXPECT_EQ(encoded_value(octal({0313})).length, 5u);  // cut off
    EXPECT_EQ(encoded_value(octal({0241, 1, 0})).header, 3u);
}

TEST(EncodedValues, Codes) {
    const auto code = [](std::initializer_list<int> bytes, Encoding encoding) {
        const std::string text = octal(bytes);
        const EncodedValue value = encoded_value(text);
        EXPECT_EQ(value.encoding, encoding);
        EXPECT_EQ(value.length, text.size());
        return decoded_code(value, text);
    };
    EXPECT_EQ(code({0246, 0377}, Encoding::Request), 255u);
    EXPECT_EQ(code({0314, 7}, Encoding::DefineRequest), 7u);
    EXPECT_EQ(code({0315, 0200}, Encoding::DefineString), 128u);
    EXPECT_EQ(code({0316, 1, 1}, Encoding::DefineString), 257u);
    EXPECT_EQ(code({0317, 9}, Encoding::DefinedString), 9u);
    EXPECT_EQ(code({0320, 2, 0}, Encoding::DefinedString), 512u);
}

TEST(EncodedValues, ReservedBytesAreNothing) {
    for (int byte = 0247; byte <= 0307; ++byte)
        EXPECT_EQ(encoded_value(octal({byte, 1, 2})).encoding, Encoding::None) << byte;
    for (int byte = 0321; byte <= 0377; ++byte)
        EXPECT_EQ(encoded_value(octal({byte, 1, 2})).encoding, Encoding::None) << byte;
    EXPECT_EQ(encoded_value(octal({0377})).length, 1u);
}

TEST(EncodedValues, ArraysOfFloats) {
    std::vector<float> floats{7};
    EXPECT_TRUE(append_floats(octal({0077, 0200, 0, 0, 0300, 0040, 0, 0, 0, 0, 0, 0}), floats));
    EXPECT_THAT(floats, ElementsAre(7, 1, -2.5f, 0));
    EXPECT_FALSE(append_floats(octal({0077, 0200, 0, 0, 0377, 0200, 0, 0}), floats));
    EXPECT_FALSE(append_floats(octal({0177, 0300, 0, 1}), floats));
    EXPECT_TRUE(append_floats("", floats));
}

}  // namespace
}  // namespace trapeze::rib
