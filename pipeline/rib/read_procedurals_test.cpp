/// Procedural: archives, programs and what is refused.
#include <chrono>

#include "pipeline/rib/reading_harness.h"

namespace trapeze::testing {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

const std::string kUnitBound = "[-1 1 -1 1 -1 1] ";

TEST(ReadProcedurals, ArchivesAreReadInABlock) {
    const Folder folder;
    folder.write("ball.rib", "Color 1 0 0 Translate 5 0 0 " + kSphere);
    const ReadOutcome outcome = read_files(
        folder, {folder.write("a.rib", "WorldBegin Procedural \"DelayedReadArchive\" [\"ball.rib\"] " +
                                           kUnitBound + kSphere +
                                           "Procedural2 \"DelayedReadArchive2\" \"SimpleBound\" "
                                           "\"string filename\" [\"ball.rib\"] \"float[6] __bound\" " +
                                           kUnitBound + "WorldEnd")});
    EXPECT_THAT(outcome.messages, IsEmpty());
    ASSERT_EQ(outcome.count(), 3u);
    EXPECT_EQ(outcome.attributes(0).color, V3f(1, 0, 0));
    EXPECT_EQ(outcome.attributes(1).color, V3f(1, 1, 1));
    EXPECT_EQ(outcome.primitive(1).camera_from_object[0][3][0], 0);
    EXPECT_EQ(outcome.primitive(2).camera_from_object[0][3][0], 5);
}

TEST(ReadProcedurals, BlocksOfArchivesEndWithThem) {
    const ReadOutcome outcome = read_world(
        "ArchiveBegin \"open\" AttributeBegin TransformBegin ArchiveEnd\n"
        "ArchiveBegin \"close\" AttributeEnd Color 1 0 0 ArchiveEnd\n"
        "AttributeBegin Color 0 1 0 Procedural \"DelayedReadArchive\" [\"open\"] " +
        kUnitBound + kSphere + "Procedural \"DelayedReadArchive\" [\"close\"] " + kUnitBound + kSphere +
        "AttributeEnd");
    ASSERT_EQ(outcome.count(), 2u);
    EXPECT_EQ(outcome.attributes(0).color, V3f(0, 1, 0));
    ASSERT_EQ(outcome.messages.size(), 2u);
    EXPECT_THAT(outcome.messages[0], HasSubstr("TransformBegin of line 2 is still open; closed here"));
    EXPECT_THAT(outcome.messages[1], HasSubstr("AttributeBegin of line 2 is still open; closed here"));
}

TEST(ReadProcedurals, WhatCannotBeIsRefused) {
    const ReadOutcome outcome =
        read_world("Procedural \"DynamicLoad\" [\"a.so\" \"\"] " + kUnitBound +
                   "\nProcedural \"Magic\" [\"a\"] " + kUnitBound +
                   "\nProcedural \"DelayedReadArchive\" [\"none.rib\"] [0 1]\n"
                   "Procedural \"DelayedReadArchive\" [\"none.rib\"] " +
                   kUnitBound + "\nProcedural2 \"DelayedReadArchive2\" \"SimpleBound\"\n" +
                   "MotionBegin [0 1] Procedural \"DelayedReadArchive\" [\"none.rib\"] " + kUnitBound +
                   "MotionEnd " + kSphere);
    EXPECT_THAT(
        outcome.messages,
        ElementsAre(HasSubstr("\"DynamicLoad\" is not supported here"), HasSubstr("no procedural \"Magic\""),
                    HasSubstr("the bound has 2 numbers"), HasSubstr("\"none.rib\" is not found"),
                    HasSubstr("\"filename\" is missing"), HasSubstr("inside a motion block")));
    EXPECT_EQ(outcome.count(), 1u);
}

TEST(ReadProcedurals, ProgramsRunOnlyWhereAllowed) {
    const Folder folder;
    const std::string scene = "WorldBegin Procedural \"RunProgram\" [\"touch " + folder.path() +
                              "/made\" \"\"] " + kUnitBound + "Procedural \"RunProgram\" [\"touch\" \"\"] " +
                              kUnitBound + kSphere + "WorldEnd";
    const ReadOutcome outcome = read_files(folder, {folder.write("a.rib", scene)});
    EXPECT_THAT(outcome.messages, ElementsAre(HasSubstr("programs are run only where that is allowed")));
    EXPECT_EQ(outcome.summary.unsupported.at("Procedural"), 2u);
    EXPECT_EQ(outcome.count(), 1u);
    EXPECT_FALSE(std::filesystem::exists(folder.path() + "/made"));
}

TEST(ReadProcedurals, WhatIsNotThereIsAnErrorWhereItWouldNotRunEither) {
    ReadOptions options;
    options.procedural_host = {"host"};
    const Folder folder;
    const std::string scene = "WorldBegin Procedural \"RunProgram\" [\"no-such-program 1\" \"\"] " +
                              kUnitBound + "Procedural \"RunProgram\" [\"no-such-program 1\" \"\"] " +
                              kUnitBound + "Procedural \"DynamicLoad\" [\"no-library\" \"\"] " + kUnitBound +
                              "Procedural2 \"ProcDynamicLoad\" \"BoundProc\" \"string dsoname\" "
                              "[\"none-either\"] \"string data\" [\"\"] Procedural2 \"ProcDynamicLoad\" "
                              "\"BoundProc\" WorldEnd";
    const ReadOutcome outcome = read_files(folder, {folder.write("a.rib", scene)}, options);
    EXPECT_THAT(outcome.messages,
                ElementsAre(HasSubstr("error: Procedural: the program \"no-such-program 1\" is not found"),
                            HasSubstr("programs are run only where that is allowed"),
                            HasSubstr("error: Procedural: the procedural \"no-library\" is not found"),
                            HasSubstr("error: Procedural2: the procedural \"none-either\" is not found"),
                            HasSubstr("\"dsoname\" is missing")));
}

/// A program beside the scene, which is asked `requests` times.
class RunProgram : public ::testing::Test {
  protected:
    ReadOutcome run(const std::string& script, const std::string& world = "") {
        const std::string program = folder_.write("generate", "#!/bin/sh\n" + script);
        std::filesystem::permissions(program, std::filesystem::perms::owner_all);
        options_.allow_programs = true;
        return read_files(
            folder_,
            {folder_.write("a.rib", "Format 100 100 1 Projection \"orthographic\" WorldBegin\n" +
                                        (world.empty() ? ask("x") : world) + kSphere + "WorldEnd")},
            options_);
    }
    static std::string ask(const std::string& data) {
        return "Procedural \"RunProgram\" [\"generate one two\" \"" + data + "\"] [-0.5 0.5 -1 1 0 0]\n";
    }

    Folder folder_;
    ReadOptions options_;
};

TEST_F(RunProgram, AnswersEachRequestInABlock) {
    const ReadOutcome outcome =
        run("while read detail data; do\n"
            "echo \"Surface \\\"$1$2_${data}_$detail\\\" Sphere 1 -1 1 360\"\n"
            "printf '\\377'\ndone",
            ask("a") + ask("b") + ask("a"));
    EXPECT_THAT(outcome.messages, IsEmpty());
    ASSERT_EQ(outcome.count(), 4u);
    EXPECT_EQ(outcome.attributes(0).surface->name, "onetwo_a_5000");  // 50 x 100 pixels
    EXPECT_EQ(outcome.attributes(1).surface->name, "onetwo_b_5000");
    EXPECT_EQ(outcome.attributes(2).surface->name, "onetwo_a_5000");
    EXPECT_EQ(outcome.attributes(3).surface, nullptr);
}

TEST_F(RunProgram, MessagesNameTheAnswersPlace) {
    const ReadOutcome outcome = run("read line; printf '\\nSphere 1\\n\\377'; sleep 0.1");
    EXPECT_THAT(
        outcome.messages,
        ElementsAre("<program generate one two>:2:1: error: Sphere: has 1 numbers, needs 4; primitive "
                    "skipped\n    included from a.rib:2:1"));
}

/// As programs write it whose output is text.
TEST_F(RunProgram, MayEndItsAnswersInUtf8) {
    const ReadOutcome outcome =
        run("while read line; do echo 'Sphere 1 -1 1 360'; printf '\\303\\277'; done", ask("a") + ask("b"));
    EXPECT_THAT(outcome.messages, IsEmpty());
    EXPECT_EQ(outcome.count(), 3u);
}

TEST_F(RunProgram, ThatSaysNothingIsSaid) {
    options_.program_seconds = 1.1;
    std::vector<std::string> waits;
    options_.on_wait = [&](const std::string& what, int seconds) {
        waits.push_back(what + " " + std::to_string(seconds));
    };
    run("sleep 100");
    EXPECT_THAT(waits, ElementsAre("the program \"generate one two\" 1"));
}

TEST_F(RunProgram, IsNotWaitedForWhenTheReadingEnds) {
    options_.program_seconds = 1000;
    std::atomic<bool> cancelled = true;
    options_.cancelled = &cancelled;
    EXPECT_EQ(run("sleep 1000").count(), 0u);
}

TEST_F(RunProgram, ThatHangsIsEnded) {
    options_.program_seconds = 0.2;
    const auto begin = std::chrono::steady_clock::now();
    const ReadOutcome outcome = run("echo 'Sphere 1 -1 1 360'; sleep 100", ask("x") + ask("y"));
    EXPECT_LT(std::chrono::steady_clock::now() - begin, std::chrono::seconds(20));
    EXPECT_THAT(outcome.messages,
                ElementsAre(HasSubstr("Procedural: the program \"generate one two\" does not answer"),
                            HasSubstr("has failed before")));
    EXPECT_EQ(outcome.count(), 2u);  // what came is used
}

TEST_F(RunProgram, ThatDiesIsSaid) {
    EXPECT_THAT(run("exit 3").messages, ElementsAre(HasSubstr("ended before its answer did")));
    const ReadOutcome missing = run("", "Procedural \"RunProgram\" [\"no/such/program\" \"\"] " + kUnitBound +
                                            "Procedural \"RunProgram\" [\"\" \"\"] " + kUnitBound);
    EXPECT_THAT(missing.messages, ElementsAre(HasSubstr("cannot be started: No such file"),
                                              HasSubstr("cannot be started: there is no command")));
}

TEST_F(RunProgram, ThatFloodsIsEnded) {
    options_.max_source_bytes = 1 << 20;
    const ReadOutcome outcome = run("while true; do echo '# 0123456789012345678901234567890123456789'; done");
    EXPECT_THAT(outcome.messages, ElementsAre(HasSubstr("answers with too much")));
    EXPECT_EQ(outcome.count(), 1u);
}

TEST_F(RunProgram, MayAskForItself) {
    options_.most_archives_read = 20;
    const ReadOutcome outcome =
        run("while read detail data; do\n"
            "if [ ${#data} -lt 3 ]; then\n"
            "echo \"Procedural \\\"RunProgram\\\" [\\\"generate one two\\\" \\\"x$data\\\"] [0 1 0 1 0 1]\"\n"
            "fi\necho 'Sphere 1 -1 1 360'\nprintf '\\377'\ndone");
    EXPECT_THAT(outcome.messages, IsEmpty());
    EXPECT_EQ(outcome.count(), 4u);
}

}  // namespace
}  // namespace trapeze::testing
