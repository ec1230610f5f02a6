/// COMPLIANCE.md says what the program does.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include "pipeline/cli/commands/compliance_page.h"
#include "shade/rsl/analysis/builtins.h"
#include "tests/program_harness.h"

namespace trapeze::testing {
namespace {

TEST(Compliance, ThePageIsWhatTheProgramWrites) {
    const WorkFolder folder;
    const std::string source = TRAPEZE_SOURCE_DIR;
    const Outcome outcome = run_program(folder, "compliance --scenes " + source + "/scenes");
    EXPECT_EQ(outcome.exit_code, 0);
    EXPECT_EQ(outcome.out, file_text(source + "/COMPLIANCE.md"))
        << "write it anew: build/bin/trapeze compliance > COMPLIANCE.md";
}

TEST(Compliance, NotesAreOfWhatThereIs) {
    for (const std::string& name : notes_without_request()) ADD_FAILURE() << name;
}

/// Functions of later renderers compile with a warning and do nothing: nobody shall read that they work.
TEST(Compliance, FunctionsThatDoNothingAreListedAsSuch) {
    const std::string page = file_text(TRAPEZE_SOURCE_DIR "/COMPLIANCE.md");
    for (const rsl::Builtin& builtin : rsl::builtins()) {
        const size_t at = page.find(fmt::format("\n| {} | ", builtin.name));
        ASSERT_NE(at, std::string::npos) << builtin.name;
        const std::string row = page.substr(at + 1, page.find('\n', at + 1) - at - 1);
        EXPECT_EQ(row.find("| not there") != std::string::npos, builtin.op == rsl::Op::Unavailable) << row;
    }
}

/// Whatever RISpec defines and the program carries out has a scene. Environments made from panoramas alone
/// have none: shade/maps/make_maps_test.cpp shows them.
TEST(Compliance, EverySupportedRequestOfRISpecIsShown) {
    const std::string page = file_text(TRAPEZE_SOURCE_DIR "/COMPLIANCE.md");
    const size_t begin = page.find("## Requests of RISpec 3.2"), end = page.find("## Requests of later");
    ASSERT_NE(begin, std::string::npos);
    for (size_t at = begin; (at = page.find("\n| ", at + 1)) < end;) {
        const std::string row = page.substr(at + 1, page.find('\n', at + 1) - at - 1);
        if (row.starts_with("| MakeLatLongEnvironment ")) continue;
        EXPECT_FALSE(row.ends_with("|  |") && row.find("skipped") == std::string::npos) << row;
    }
}

}  // namespace
}  // namespace trapeze::testing
