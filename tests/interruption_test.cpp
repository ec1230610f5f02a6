/// Commands that a signal ends leave nothing behind: no files, no programs.
#include <chrono>
#include <csignal>
#include <thread>

#include "tests/command_line.h"

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
        const std::string pid = text_of(folder / "pid");
        ASSERT_FALSE(pid.empty());
        // Whoever inherits it may take a moment to notice its end.
        bool runs = true;
        for (int i = 0; i < 200 && runs; ++i) {
            const std::string state = text_of("/proc/" + pid.substr(0, pid.find('\n')) + "/stat");
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

}  // namespace
}  // namespace trapeze::testing
