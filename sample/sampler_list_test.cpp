#include "sample/sampler_list.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace trapeze {
namespace {

std::vector<std::string> names(const std::vector<Sampler>& samplers) {
    std::vector<std::string> found;
    for (const Sampler& sampler : samplers) found.push_back(sampler.name());
    return found;
}

TEST(SamplerList, IsSeparatedBySpacesAndSemicolons) {
    std::string error;
    const auto samplers =
        parse_samplers(" raytrace:tree=paper,bundle=off; interval\tbruteforce ", "", &error);
    ASSERT_TRUE(samplers) << error;
    EXPECT_THAT(names(*samplers),
                ::testing::ElementsAre("raytrace:tree=paper,bundle=off", "interval", "bruteforce"));
    EXPECT_EQ((*samplers)[1].pattern.name, "interval");
}

TEST(SamplerList, SaysWhatIsWrong) {
    std::string error;
    EXPECT_FALSE(parse_samplers("raytrace magic", "", &error));
    EXPECT_THAT(error, ::testing::HasSubstr("magic"));
    EXPECT_FALSE(parse_samplers(" ; ", "", &error));
    EXPECT_THAT(error, ::testing::HasSubstr("empty"));
    EXPECT_FALSE(parse_samplers("interleaveuvt", "stratified", &error)) << "it cannot";
}

TEST(SamplerList, WithoutReferencesNoneOfThatKindIsLeft) {
    for (const Sampler& sampler : default_samplers("", false))
        EXPECT_NE(find_named(visibility_methods(), sampler.method.name)->kind, MethodKind::Reference);
}

TEST(SamplerList, TheDefaultIsAllThatHonourThePattern) {
    const auto all = names(default_samplers("", true));
    EXPECT_EQ(all.size(), visibility_methods().size());
    const auto without = names(default_samplers("", false));
    EXPECT_EQ(without.size() + 1, all.size());
    EXPECT_THAT(names(default_samplers("stratified", true)),
                ::testing::Not(::testing::Contains("interleaveuvt")));
}

}  // namespace
}  // namespace trapeze
