#include "pipeline/cli/arguments.h"

#include <gtest/gtest.h>

#include "pipeline/cli/exit_codes.h"

namespace trapeze {
namespace {

using Words = std::vector<std::string>;

std::optional<int> parse(Words words, Arguments& arguments) {
    words.insert(words.begin(), "trapeze");
    std::vector<char*> argv;
    for (std::string& word : words) argv.push_back(word.data());
    return parse_arguments(static_cast<int>(argv.size()), argv.data(), arguments);
}

TEST(Arguments, RenderManSpellingsBecomeOurs) {
    EXPECT_EQ(modern_spelling({"-Progress", "-t:4", "-res", "320", "200", "a.rib"}),
              (Words{"render", "--progress=prman", "--threads=4", "--resolution=320x200", "a.rib"}));
    EXPECT_EQ(modern_spelling({"render", "-frames", "1", "5", "-recover", "1", "a.rib"}),
              (Words{"render", "--frames=1-5", "a.rib"}));
    EXPECT_EQ(modern_spelling({"render", "-t:all", "-framelist", "1,3-9", "a.rib"}),
              (Words{"render", "--threads=0", "--frames=1,3-9", "a.rib"}));
    EXPECT_EQ(modern_spelling({"--version"}), (Words{"--version"}));
}

TEST(Arguments, AllRenderOptionsArrive) {
    Arguments a;
    ASSERT_FALSE(parse({"render",
                        "a.rib",
                        "b.rib",
                        "-o",
                        "x.exr",
                        "-r",
                        "64x48",
                        "--crop",
                        "0",
                        "0.5",
                        "0.25",
                        "1",
                        "-t",
                        "-1",
                        "--samples",
                        "4x2",
                        "--shading-rate",
                        "0.5",
                        "--sampler",
                        "bruteforce",
                        "--seed",
                        "7",
                        "-f",
                        "1-3",
                        "--progress",
                        "json",
                        "--stats",
                        "s.json",
                        "--memory",
                        "1G",
                        "--strict"},
                       a));
    EXPECT_EQ(a.inputs, (Words{"a.rib", "b.rib"}));
    EXPECT_EQ(a.output, "x.exr");
    EXPECT_EQ(a.resolution, (std::pair{64, 48}));
    EXPECT_EQ(*a.crop, (std::array<float, 4>{0, 0.5f, 0.25f, 1}));
    EXPECT_EQ(a.threads, -1);
    EXPECT_EQ(a.samples, (std::pair{4, 2}));
    EXPECT_EQ(a.shading_rate, 0.5f);
    EXPECT_EQ(a.sampler, "bruteforce");
    EXPECT_EQ(a.seed, 7u);
    EXPECT_EQ(a.frames->size(), 1u);
    EXPECT_EQ(a.progress, "json");
    EXPECT_EQ(a.memory_bytes, size_t{1} << 30);
    EXPECT_TRUE(a.strict);
}

TEST(Arguments, AllCompareOptionsArrive) {
    Arguments a;
    ASSERT_FALSE(parse({"compare",   "a.rib",   "--samplers",  "raytrace:tree=paper,bundle=off; interval",
                        "--samples", "1x1,4x2", "--reference", "8",
                        "--repeat",  "5",       "--report",    "r.html",
                        "--json",    "r.json",  "-o",          "out",
                        "-r",        "64x48",   "--seed",      "3",
                        "-t",        "1"},
                       a));
    EXPECT_EQ(a.command, Command::Compare);
    EXPECT_EQ(a.compare.samplers, "raytrace:tree=paper,bundle=off; interval");
    EXPECT_EQ(a.compare.samples, (std::vector<std::pair<int, int>>{{1, 1}, {4, 2}}));
    EXPECT_EQ(a.compare.reference_side, 8);
    EXPECT_EQ(a.compare.rounds, 5);
    EXPECT_EQ(a.compare.report, "r.html");
    EXPECT_EQ(a.compare.json, "r.json");
    EXPECT_EQ(a.compare.folder, "out");
    EXPECT_EQ(a.resolution, (std::pair{64, 48}));
    EXPECT_EQ(a.seed, 3u);
}

TEST(Arguments, BadOnesAreUsageErrors) {
    for (const Words& words : {Words{},
                               {"render"},
                               {"render", "a.rib", "--sampler", "magic"},
                               {"render", "a.rib", "-r", "5"},
                               {"render", "a.rib", "--memory", "lots"},
                               {"render", "a.rib", "--frobnicate"},
                               {"compare", "a.rib", "--samplers", "raytrace magic"},
                               {"compare", "a.rib", "--samplers", "interleaveuvt", "--pattern", "stratified"},
                               {"compare", "a.rib", "--samples", "4x4,many"},
                               {"compare", "a.rib", "--reference", "0"}}) {
        Arguments a;
        EXPECT_EQ(parse(words, a), kExitUsage);
    }
}

}  // namespace
}  // namespace trapeze
