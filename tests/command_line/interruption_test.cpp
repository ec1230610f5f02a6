/// Commands that a signal or their time limit ends leave nothing behind: no files, no programs.
#include <sys/stat.h>

#include <chrono>
#include <csignal>
#include <thread>

#include "tests/command_line/command_line_harness.h"

namespace trapeze::testing {
namespace {

/// A scene that takes minutes, for interrupting.
constexpr const char* kSlow = R"(Format 1920 1080 1
PixelSamples 32 32
Projection "perspective" "fov" 40
Display "slow.exr" "openexr" "rgba"
Translate 0 0 3
WorldBegin
ShadingRate 0.05
Sphere 1 -1 1 360
WorldEnd
)";

TEST(Interruption, LeavesNothingHalfWritten) {
    for (const auto& [signal, code] : {std::pair{"INT", 130}, {"TERM", 143}}) {
        WorkFolder folder;
        folder.write("slow.rib", kSlow);
        // `timeout` sends the signal and, with --preserve-status, passes on the program's own exit code.
        const std::string command = "cd '" + folder.path().string() + "' && timeout --preserve-status -s " +
                                    signal + " 1 '" TRAPEZE_PROGRAM "' render slow.rib >.stdout 2>.stderr";
        const auto start = std::chrono::steady_clock::now();
        const int status = std::system(command.c_str());
        const double seconds =
            std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
        EXPECT_EQ(WEXITSTATUS(status), code);
        EXPECT_EQ(files_in(folder), "slow.rib ");
        RecordProperty("seconds", std::to_string(seconds));
    }
}

/// A program that sleeps through the end of its input writes its number before.
TEST(Interruption, EndsTheProgramsOfScenes) {
    WorkFolder folder;
    folder.write("hang.sh", "read request; echo $$ >pid; exec sleep 60");
    folder.write("a.rib",
                 "WorldBegin Procedural \"RunProgram\" [\"sh hang.sh\" \"\"] [-1 1 -1 1 -1 1] WorldEnd");
    for (const char* name : {"render", "check"}) {
        const std::string command = "cd '" + folder.path().string() +
                                    "' && timeout --preserve-status -s TERM 1 '" TRAPEZE_PROGRAM "' " + name +
                                    " --allow-programs a.rib >.stdout 2>.stderr";
        EXPECT_EQ(WEXITSTATUS(std::system(command.c_str())), 143);
        const std::string pid = file_text(folder / "pid");
        ASSERT_FALSE(pid.empty());
        // Whoever inherits it may take a moment to notice its end.
        bool runs = true;
        for (int i = 0; i < 200 && runs; ++i) {
            const std::string state = file_text("/proc/" + pid.substr(0, pid.find('\n')) + "/stat");
            runs = !state.empty() && state.find(") Z ") == std::string::npos;
            if (runs) std::this_thread::sleep_for(std::chrono::milliseconds(10));
        }
        EXPECT_FALSE(runs) << name;
    }
}

TEST(Interruption, CompareCanBeInterrupted) {
    WorkFolder folder;
    folder.write("slow.rib", kSlow);
    const std::string command = "cd '" + folder.path().string() +
                                "' && timeout --preserve-status -s INT 1 '" TRAPEZE_PROGRAM
                                "' compare slow.rib --json c.json --report r.html >.stdout 2>.stderr";
    EXPECT_EQ(WEXITSTATUS(std::system(command.c_str())), 130);
    EXPECT_EQ(files_in(folder), "slow.rib ");
}

TEST(Interruption, AStudyCanBeInterrupted) {
    WorkFolder folder;
    const std::string command = "cd '" + folder.path().string() +
                                "' && timeout --preserve-status -s INT 1 '" TRAPEZE_PROGRAM
                                "' study table1 --json c.json >.stdout 2>.stderr";
    EXPECT_EQ(WEXITSTATUS(std::system(command.c_str())), 130);
    EXPECT_EQ(files_in(folder), "");
}

/// Hours of shading, of tracing and of waiting for a file.
TEST(TimeLimit, EndsTheWorkWhereverItIs) {
    WorkFolder folder;
    folder.write(
        "loop.sl",
        "surface loop() { float i, j, k = 0; for (i = 0; i < 1e5; i += 1) for (j = 0; j < 1e5; j += 1)"
        " k += noise(P * j); Ci = k; }\n");
    folder.write("shade.rib",
                 "Format 2000 2000 1\nWorldBegin\nShadingRate .05\nSurface \"loop\"\n"
                 "Sphere 1 -1 1 360\nWorldEnd\n");
    folder.write("trace.rib",
                 "Format 1920 1080 1\nPixelSamples 32 32\nWorldBegin\nShadingRate .05\n"
                 "Sphere 1 -1 1 360\nWorldEnd\n");
    ASSERT_EQ(mkfifo((folder / "pipe").c_str(), 0600), 0);
    const std::string before = files_in(folder);
    for (const char* arguments : {"render shade.rib", "render trace.rib", "render pipe", "check pipe",
                                  "cat pipe", "info pipe", "compare trace.rib"}) {
        const Outcome run = run_program(folder, std::string(arguments) + " --time-limit 0.5s");
        EXPECT_EQ(run.exit_code, 8) << arguments << run.err;
        EXPECT_TRUE(run.err.find("error: the time limit is reached") != std::string::npos)
            << arguments << run.err;
        EXPECT_EQ(files_in(folder), before) << arguments;
    }
}

TEST(TimeLimit, LeavesWhatIsInTimeAlone) {
    WorkFolder folder;
    folder.write("a.rib", kSphereScene);
    EXPECT_EQ(run_program(folder, "render a.rib --time-limit 1h").exit_code, 0);
    EXPECT_EQ(run_program(folder, "render a.rib --time-limit soon").exit_code, 2);
    EXPECT_EQ(run_program(folder, "render a.rib --time-limit 0").exit_code, 2);
}

}  // namespace
}  // namespace trapeze::testing
