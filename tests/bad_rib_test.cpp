/// Files that are wrong in one way each: what must be said (`#expect` lines, parts of messages) and how many
/// primitives must survive (`#primitives`) stands in the files themselves.
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>

#include "pipeline/rib/read_rib.h"
#include "tests/program_harness.h"

namespace trapeze::testing {
namespace {

namespace fs = std::filesystem;

const fs::path kFolder = TRAPEZE_SOURCE_DIR "/tests/bad_rib";

std::vector<std::string> bad_files() {
    std::vector<std::string> names;
    for (const auto& entry : fs::directory_iterator(kFolder))
        if (entry.path().extension() == ".rib") names.push_back(entry.path().stem().string());
    std::sort(names.begin(), names.end());
    return names;
}

struct Expectations {
    std::vector<std::string> messages;
    size_t primitives = 0;
};

Expectations expectations_of(const fs::path& file) {
    Expectations expected;
    std::ifstream stream(file);
    for (std::string line; std::getline(stream, line);) {
        if (line.starts_with("#expect ")) expected.messages.push_back(line.substr(8));
        if (line.starts_with("#primitives ")) expected.primitives = std::stoul(line.substr(12));
    }
    return expected;
}

class BadRib : public ::testing::TestWithParam<std::string> {};

TEST_P(BadRib, IsReportedAndTheRestIsRead) {
    const fs::path file = kFolder / (GetParam() + ".rib");
    const Expectations expected = expectations_of(file);
    ASSERT_FALSE(expected.messages.empty());
    std::string said;
    Diagnostics diagnostics([&](const Diagnostic& diagnostic) { said += to_string(diagnostic) + "\n"; });
    size_t primitives = 0;
    const std::vector<std::string> files{file.string()};
    read_rib(files, ReadOptions{}, diagnostics,
             [&](Scene&& scene) { primitives += scene.primitives.size(); });
    for (const std::string& message : expected.messages)
        EXPECT_NE(said.find(message), std::string::npos) << "not said: " << message << "\nbut:\n" << said;
    EXPECT_EQ(primitives, expected.primitives) << said;
}

TEST_P(BadRib, MakesCheckFailUnlessItIsOnlyUnsupported) {
    WorkFolder folder;
    const Outcome outcome = run_program(folder, "check '" + (kFolder / (GetParam() + ".rib")).string() + "'");
    EXPECT_EQ(outcome.exit_code, GetParam() == "unsupported_request" ? 0 : 1) << outcome.err;
}

INSTANTIATE_TEST_SUITE_P(Files, BadRib, ::testing::ValuesIn(bad_files()),
                         [](const auto& file) { return file.param; });

/// Input made by rules rather than kept as files.
std::string messages_for(const std::string& text, size_t* primitives) {
    WorkFolder folder;
    folder.write("made.rib", text);
    std::string said;
    Diagnostics diagnostics([&](const Diagnostic& diagnostic) { said += to_string(diagnostic) + "\n"; });
    const std::vector<std::string> files{(folder / "made.rib").string()};
    *primitives = 0;
    read_rib(files, ReadOptions{}, diagnostics,
             [&](Scene&& scene) { *primitives += scene.primitives.size(); });
    return said;
}

TEST(MadeRib, BlocksNestedTooDeepEndWithAnError) {
    std::string text = "WorldBegin\n";
    for (int i = 0; i < 20000; ++i) text += "AttributeBegin\n";
    size_t primitives = 0;
    const std::string said = messages_for(text + "Sphere 1 -1 1 360\n", &primitives);
    EXPECT_NE(said.find("blocks are nested more than"), std::string::npos);
    EXPECT_EQ(primitives, 1u);
}

TEST(MadeRib, BinaryBytesAreSkippedToTheNextRequest) {
    size_t primitives = 0;
    const std::string said =
        messages_for("WorldBegin\nColor 1\n\x80\x90\xff\xfe Sphere 1 -1 1 360\nWorldEnd\n", &primitives);
    EXPECT_NE(said.find("error"), std::string::npos);
    EXPECT_EQ(primitives, 1u);
}

TEST(MadeRib, DamagedGzipIsReadAsFarAsItGoes) {
    size_t primitives = 0;
    EXPECT_NE(messages_for("\x1f\x8b\x08\x01garbage that is no deflate stream", &primitives).find("gzip"),
              std::string::npos);
    EXPECT_EQ(primitives, 0u);
}

TEST(MadeRib, EveryPrefixOfAFileEndsWithoutHarm) {
    const std::string whole =
        file_text(kFolder / "absurd_sizes.rib") + file_text(kFolder / "motion_mismatch.rib");
    size_t primitives = 0;
    for (size_t length = 0; length < whole.size(); length += 7)
        messages_for(whole.substr(0, length), &primitives);
    EXPECT_LE(primitives, 4u);
}

}  // namespace
}  // namespace trapeze::testing
