#include "pipeline/cli/support/arguments.h"

#include <gtest/gtest.h>

#include "pipeline/cli/support/exit_codes.h"
#include "pipeline/cli/support/modern_spelling.h"

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
    EXPECT_EQ(modern_spelling({"help"}), (Words{"--help"}));
    EXPECT_EQ(modern_spelling({"help", "check"}), (Words{"check", "--help"}));
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
    EXPECT_EQ(a.samples, (SampleRates{{}, {4, 2}}));
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

TEST(Arguments, OfARepeatedOptionTheLastCounts) {
    Arguments a;
    ASSERT_FALSE(parse(
        {"render",   "a.rib",     "-o",         "x.exr",      "-r",    "8x8",        "--crop",    "0",
         ".1",       "0",         ".1",         "--samples",  "1",     "-t",         "1",         "-f",
         "1-3",      "-q",        "--memory",   "1G",         "b.rib", "-o",         "y.exr",     "-r",
         "9x9",      "--crop",    "0",          ".5",         "0",     ".5",         "--samples", "2",
         "-t",       "2",         "-f",         "7",          "-q",    "--memory",   "2G",        "--sampler",
         "interval", "--sampler", "bruteforce", "--progress", "bar",   "--progress", "none"},
        a));
    EXPECT_EQ(a.inputs, (Words{"a.rib", "b.rib"}));
    EXPECT_EQ(a.output, "y.exr");
    EXPECT_EQ(a.resolution, (std::pair{9, 9}));
    EXPECT_EQ(*a.crop, (std::array<float, 4>{0, 0.5f, 0, 0.5f}));
    EXPECT_EQ(a.samples, (SampleRates{{}, {2, 2}}));
    EXPECT_EQ(a.threads, 2);
    ASSERT_EQ(a.frames->size(), 1u);
    EXPECT_EQ(a.frames->front().first, 7);
    EXPECT_EQ(a.memory_bytes, size_t{2} << 30);
    EXPECT_EQ(a.sampler, "bruteforce");
    EXPECT_EQ(a.progress, "none");
    for (const Words& words :
         {Words{"compare", "a.rib", "--json", "a", "--json", "b", "--repeat", "1", "--repeat", "2"},
          {"scene", "halberd", "--scale", "1", "--scale", "2", "-o", "a", "-o", "b"},
          {"study", "growth", "--json", "a", "--json", "b", "--repeat", "1", "--repeat", "2"},
          {"cat", "a.rib", "-o", "a", "-o", "b", "-b", "-b"},
          {"compliance", "--scenes", "a", "--scenes", "b"}}) {
        Arguments last;
        EXPECT_FALSE(parse(words, last)) << words.front();
    }
    Arguments shader;
    ASSERT_FALSE(parse({"shader", "a.sl", "-I", "a", "-I", "b", "-D", "X", "-D", "Y=2"}, shader));
    EXPECT_EQ(shader.shader.include_folders, (Words{"a", "b"}));
    EXPECT_EQ(shader.shader.defines, (Words{"X", "Y=2"}));
}

/// What a wrong command line is answered with.
std::string complaint(const Words& words) {
    Arguments a;
    ::testing::internal::CaptureStderr();
    EXPECT_EQ(parse(words, a), kExitUsage);
    return ::testing::internal::GetCapturedStderr();
}

TEST(Arguments, LimitsAreSaid) {
    const auto says = [](Words words, const std::vector<std::string>& parts) {
        words.insert(words.begin(), {"render", "a.rib"});
        const std::string text = complaint(words);
        for (const std::string& part : parts)
            EXPECT_NE(text.find(part), std::string::npos) << part << " is not in: " << text;
    };
    says({"-r", "70000x5"}, {"--resolution", "\"70000x5\"", "65536"});
    says({"--samples", "65"}, {"--samples", "64"});
    says({"-t", "5000"}, {"--threads", "-1024", "1024"});
    says({"-t", "2.5"}, {"--threads", "whole number"});
    says({"--shading-rate", "nan"}, {"--shading-rate", "1e+06"});
    says({"--crop", "0", "nan", "0", "1"}, {"--crop", "from 0 to 1"});
    says({"--regions", "0"}, {"--regions", "100000"});
    says({"--seed", "-1"}, {"--seed", "4294967295"});
    says({"--memory", "0"}, {"--memory", "4G"});
    says({"--frames", "3-1"}, {"--frames", "1-10,20"});
    says({"-o", ""}, {"--output", "empty"});
}

TEST(Arguments, CropsAreNotReversedOrEmpty) {
    for (const Words& crop : {Words{".6", ".4", "0", "1"}, {"0", "1", "1", "0"}, {".5", ".5", "0", "1"}}) {
        Words words{"render", "a.rib", "--crop"};
        words.insert(words.end(), crop.begin(), crop.end());
        EXPECT_NE(complaint(words).find("less than"), std::string::npos);
    }
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
