#include "pipeline/cli/support/parse_values.h"

#include <gtest/gtest.h>

namespace trapeze {
namespace {

TEST(ParseSize, ReadsUnits) {
    EXPECT_EQ(parse_size("1000"), 1000u);
    EXPECT_EQ(parse_size("512M"), 512u << 20);
    EXPECT_EQ(parse_size("1.5GiB"), size_t{3} << 29);
    EXPECT_EQ(parse_size("2gB"), size_t{2} << 30);
    for (const char* bad : {"", "M", "-1", "12Q", "1e999", "4GG", "0", "nan"})
        EXPECT_FALSE(parse_size(bad)) << bad;
}

TEST(ParseDuration, ReadsUnits) {
    EXPECT_EQ(parse_duration("90"), 90);
    EXPECT_EQ(parse_duration("30s"), 30);
    EXPECT_EQ(parse_duration("1.5m"), 90);
    EXPECT_EQ(parse_duration("2h"), 7200);
    for (const char* bad : {"", "s", "-1", "0", "5d", "1e999", "2h30m", "nan", "99999999999"})
        EXPECT_FALSE(parse_duration(bad)) << bad;
}

TEST(ParseResolution, WantsTwoPositiveNumbers) {
    EXPECT_EQ(parse_resolution("640x480"), (std::pair{640, 480}));
    for (const char* bad : {"640", "x480", "0x5", "-1x5", "640x480x2", "a x b", "99999999x1"})
        EXPECT_FALSE(parse_resolution(bad)) << bad;
}

TEST(ParseTiles, WantsTwoPositiveNumbers) {
    EXPECT_EQ(parse_tiles("4x3"), (std::pair{4, 3}));
    EXPECT_EQ(parse_tiles("4096x1"), (std::pair{4096, 1}));
    for (const char* bad : {"", "4", "4x", "0x3", "4x3x2", "4097x1", "-1x1"})
        EXPECT_FALSE(parse_tiles(bad)) << bad;
}

TEST(ParseSamples, OneNumberIsForBothAxes) {
    EXPECT_EQ(parse_samples("8"), (std::pair{8, 8}));
    EXPECT_EQ(parse_samples("8x4"), (std::pair{8, 4}));
    for (const char* bad : {"0", "65", "8x", "x", "8x0"}) EXPECT_FALSE(parse_samples(bad)) << bad;
}

TEST(ParseSampleRates, HaveLevels) {
    EXPECT_EQ(parse_sample_rates("8"), (SampleRates{{}, {8, 8}}));
    EXPECT_EQ(parse_sample_rates("4x4..16x16"), (SampleRates{std::pair{4, 4}, {16, 16}}));
    EXPECT_EQ(parse_sample_rates("4..8"), (SampleRates{std::pair{4, 4}, {8, 8}}));
    EXPECT_EQ(parse_sample_rates("4x2..8x4"), (SampleRates{std::pair{4, 2}, {8, 4}}));
    for (const char* bad :
         {"4..", "..8", "4..4", "8..4", "4..12", "4..32", "1..2", "4x4..8x16", "4...8", "32..128"})
        EXPECT_FALSE(parse_sample_rates(bad)) << bad;
}

TEST(ParseSamplesList, KeepsTheOrderAndLeavesOutRepetitions) {
    using List = std::vector<std::pair<int, int>>;
    EXPECT_EQ(parse_samples_list("1x1,4x4,8"), (List{{1, 1}, {4, 4}, {8, 8}}));
    EXPECT_EQ(parse_samples_list("8; 2x3 8x8"), (List{{8, 8}, {2, 3}}));
    for (const char* bad : {"", ",", "4x4,", "0", "4x4,x", "65"})
        EXPECT_EQ(parse_samples_list(bad).has_value(), std::string_view(bad) == "4x4,") << bad;
}

TEST(ParseFrames, ReadsListsRangesAndSteps) {
    const auto frames = parse_frames("1-10x3,20,-2--1");
    ASSERT_TRUE(frames);
    const auto has = [&](int f) {
        for (const FrameRange& r : *frames)
            if (r.has(f)) return true;
        return false;
    };
    for (const int f : {1, 4, 7, 10, 20, -2, -1}) EXPECT_TRUE(has(f)) << f;
    for (const int f : {0, 2, 3, 11, 19, 21, -3}) EXPECT_FALSE(has(f)) << f;
    for (const char* bad : {"", ",", "1,", "3-1", "1-x", "1-5x0", "a"})
        EXPECT_FALSE(parse_frames(bad)) << bad;
}

}  // namespace
}  // namespace trapeze
