#include "sample/names/method_spec.h"

#include <gtest/gtest.h>

namespace trapeze {
namespace {

const std::vector<SpecOption> kOptions = {{"k", {"2", "1", "4"}}, {"cull", {"off", "on"}}};

TEST(MethodSpec, ReadsOptionsAndFillsInDefaults) {
    std::string error;
    auto spec = parse_spec("interleaveuvt:k=4", &error);
    ASSERT_TRUE(spec && complete_spec(*spec, kOptions, &error)) << error;
    EXPECT_EQ(spec->name, "interleaveuvt");
    EXPECT_EQ(spec->number("k"), 4);
    EXPECT_FALSE(spec->is_on("cull"));
    EXPECT_EQ(spec_text(*spec, kOptions), "interleaveuvt:k=4");
}

TEST(MethodSpec, TextLeavesOutDefaults) {
    std::string error;
    auto spec = parse_spec("a:cull=on,k=2", &error);
    ASSERT_TRUE(spec && complete_spec(*spec, kOptions, &error)) << error;
    EXPECT_EQ(spec_text(*spec, kOptions), "a:cull=on");
}

TEST(MethodSpec, WrongTextsAreRefused) {
    for (const char* text : {"a:k", "a:=4", "a:k=1,k=2", "a:k=1,,cull=on"}) {
        std::string error;
        EXPECT_FALSE(parse_spec(text, &error)) << text;
        EXPECT_FALSE(error.empty()) << text;
    }
    for (const char* text : {"a:k=3", "a:q=1", "a:cull="}) {
        std::string error;
        auto spec = parse_spec(text, &error);
        ASSERT_TRUE(spec) << text;
        EXPECT_FALSE(complete_spec(*spec, kOptions, &error)) << text;
    }
}

}  // namespace
}  // namespace trapeze
