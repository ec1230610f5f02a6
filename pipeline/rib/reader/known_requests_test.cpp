#include "pipeline/rib/reader/known_requests.h"

#include <gtest/gtest.h>

#include "pipeline/rib/reader/name_counts.h"

namespace trapeze::rib {
namespace {

TEST(KnownRequests, AreFoundByTheirNamesAndNoOthers) {
    const std::vector<std::string> names = request_names();
    ASSERT_GT(names.size(), 100u);
    for (size_t i = 0; i < names.size(); ++i) {
        const Request* const found = find_request(names[i]);
        ASSERT_TRUE(found) << names[i];
        EXPECT_EQ(found->name, names[i]);
        EXPECT_EQ(found->number, i);
        EXPECT_FALSE(is_request(names[i] + "x"));

        std::string other = names[i];
        other[other.size() / 2] ^= 0x20;
        EXPECT_FALSE(is_request(other)) << other;
    }
    EXPECT_FALSE(is_request(""));
}

/// More names than are remembered, and names that are remembered in one place.
TEST(NameCounts, CountEachNameByItself) {
    NameCounts remembered;
    std::map<std::string, uint64_t> counts;
    for (int round = 0; round < 3; ++round)
        for (int i = 0; i < 500; ++i) remembered.of(counts, "name " + std::to_string(i)) += 1;
    EXPECT_EQ(counts.size(), 500u);
    for (const auto& [name, count] : counts) EXPECT_EQ(count, 3u) << name;
    remembered.of(counts, "") += 1;
    EXPECT_EQ(counts[""], 1u);
}

}  // namespace
}  // namespace trapeze::rib
