/// Interruptions that come while an old picture is being replaced: the old one stays, or the new one is there
/// whole, nothing lies beside it, and the exit code tells of the signal.
#include <fcntl.h>
#include <unistd.h>

#include <chrono>
#include <csignal>
#include <optional>
#include <thread>

#include "tests/command_line/command_line_harness.h"

namespace trapeze::testing {
namespace {

/// Stands before the C library in the program (LD_PRELOAD): raises a signal in one call of the way that a
/// picture takes to the disk, and then does the call, does not, or does not come back.
constexpr const char* kRaise = R"(#define _GNU_SOURCE
#include <dlfcn.h>
#include <errno.h>
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

static int is(const char *variable, const char *value) {
    const char *is_set = getenv(variable);
    return is_set && !strcmp(is_set, value);
}

static int breaks_off(const char *call) {
    if (!is("RAISE_IN", call)) return 0;
    raise(atoi(getenv("RAISE_SIGNAL")));
    while (is("RAISE_THEN", "hang")) sleep(1);
    errno = EINTR;
    return is("RAISE_THEN", "fail");
}

FILE *fopen(const char *path, const char *mode) {
    if (strstr(path, ".part-") && breaks_off("fopen")) return NULL;
    return ((FILE *(*)(const char *, const char *))dlsym(RTLD_NEXT, "fopen"))(path, mode);
}

int fsync(int file) {
    return breaks_off("fsync") ? -1 : ((int (*)(int))dlsym(RTLD_NEXT, "fsync"))(file);
}

int rename(const char *from, const char *to) {
    return breaks_off("rename") ? -1 : ((int (*)(const char *, const char *))dlsym(RTLD_NEXT, "rename"))(from, to);
}
)";

/// A picture of so many pixels in floats, without compression, which takes next to no time to make.
std::string scene(int side) {
    const std::string pixels = std::to_string(side);
    return "Format " + pixels + ' ' + pixels +
           " 1\nPixelSamples 1 1\nPixelFilter \"box\" 1 1\n"
           "Display \"a.exr\" \"openexr\" \"rgbaz\" \"string exrcompression\" \"none\" "
           "\"string exrpixeltype\" \"float\"\n"
           "WorldBegin\nShadingRate 64\nSurface \"constant\"\nTranslate 0 0 5\nSphere 1 -1 1 360\nWorldEnd\n";
}

class LateInterruption : public ::testing::Test {
  protected:
    /// Of the same bytes each time: without the date.
    void SetUp() override { setenv("SOURCE_DATE_EPOCH", "0", 1); }
    void TearDown() override { unsetenv("SOURCE_DATE_EPOCH"); }

    /// Renders the picture that is to be replaced, and the one that is to replace it.
    void render_both(int side) {
        folder_.write("a.rib", scene(16));
        ASSERT_EQ(run_program(folder_, "render a.rib").exit_code, 0);
        old_ = file_text(folder_ / "a.exr");
        folder_.write("a.rib", scene(side));
        ASSERT_EQ(run_program(folder_, "render a.rib").exit_code, 0);
        whole_ = file_text(folder_ / "a.exr");
        ASSERT_NE(old_, whole_);
    }
    void put_old() { std::ofstream(folder_ / "a.exr", std::ios::binary) << old_; }
    bool is_old() const { return file_text(folder_ / "a.exr") == old_; }
    bool is_whole() const { return file_text(folder_ / "a.exr") == whole_; }
    /// Bytes of the file that is being written under another name; nothing while there is none.
    std::optional<uintmax_t> bytes_of_partial() const {
        std::error_code gone;
        for (const auto& entry : fs::directory_iterator(folder_.path()))
            if (entry.path().filename().string().find(".part-") != std::string::npos)
                if (const auto bytes = entry.file_size(gone); !gone) return bytes;
        return {};
    }
    /// `trapeze render a.rib`, not waited for.
    pid_t start() const {
        const pid_t child = fork();
        if (child != 0) return child;
        const int nothing = open("/dev/null", O_RDWR);
        if (nothing < 0 || chdir(folder_.path().c_str()) != 0) _exit(99);
        for (const int stream : {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO}) dup2(nothing, stream);
        execl(TRAPEZE_PROGRAM, TRAPEZE_PROGRAM, "render", "a.rib", nullptr);
        _exit(99);
    }

    WorkFolder folder_;
    std::string old_, whole_;
};

/// At the exact moment: as the file is made, when all is in it, before it takes its name.
TEST_F(LateInterruption, InAnyCallOfTheWriting) {
    render_both(40);
    folder_.write("raise.c", kRaise);
    const std::string library = (folder_ / "raise.so").string();
    ASSERT_EQ(std::system((TRAPEZE_CC " -shared -fPIC '" + (folder_ / "raise.c").string() + "' -o '" +
                           library + "' -ldl")
                              .c_str()),
              0);
    const std::string left = files_in(folder_);
    for (const auto& [signal, code] : {std::pair{SIGINT, 130}, {SIGTERM, 143}})
        for (const std::string call : {"fopen", "fsync", "rename"})
            for (const std::string then : {"go on", "fail", "hang"}) {
                put_old();
                const std::string command =
                    "cd '" + folder_.path().string() + "' && RAISE_IN=" + call + " RAISE_THEN='" + then +
                    "' RAISE_SIGNAL=" + std::to_string(signal) + " LD_PRELOAD='" + library +
                    "' '" TRAPEZE_PROGRAM "' render a.rib >.stdout 2>.stderr";
                const std::string what = call + ", " + then + ", " + std::to_string(signal);
                EXPECT_EQ(WEXITSTATUS(std::system(command.c_str())), code) << what;
                EXPECT_EQ(file_text(folder_ / ".stderr"), "") << what;
                EXPECT_TRUE(is_old() || (then == "go on" && is_whole())) << what;
                EXPECT_EQ(files_in(folder_), left) << what;
            }
}

/// At many moments of a render that writes 45 MB: some before it writes, others when a part is there.
TEST_F(LateInterruption, AtManyMomentsOfALargeFile) {
    constexpr int kMoments = 8;  ///< of each of the two kinds
    render_both(1500);
    const std::string left = files_in(folder_);
    int stopped_while_writing = 0;
    for (int moment = 0; moment < 2 * kMoments; ++moment) {
        put_old();
        const bool waits_for_part = moment >= kMoments;
        const pid_t child = start();
        ASSERT_GT(child, 0);
        int status = 0;
        bool has_ended = false;
        std::optional<uintmax_t> there;
        const auto begin = std::chrono::steady_clock::now();
        const auto is_now = [&] {
            if (!waits_for_part)
                return std::chrono::steady_clock::now() - begin >= std::chrono::milliseconds(10 * moment);
            there = bytes_of_partial();
            return there && *there >= whole_.size() * static_cast<size_t>(moment - kMoments) / kMoments;
        };
        while (!has_ended && !is_now()) {
            std::this_thread::sleep_for(std::chrono::microseconds(200));
            has_ended = waitpid(child, &status, WNOHANG) == child;
        }
        if (!has_ended) {
            kill(child, moment % 2 ? SIGINT : SIGTERM);
            ASSERT_EQ(waitpid(child, &status, 0), child);
        }
        // Before it listens to signals, they end it by themselves.
        const int code = WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
        const int of_signal = moment % 2 ? 130 : 143;
        EXPECT_TRUE(code == of_signal ? is_old() || is_whole() : code == 0 && is_whole())
            << "moment " << moment << ", exit code " << code;
        EXPECT_EQ(files_in(folder_), left) << moment;
        stopped_while_writing += there && code == of_signal && is_old();
    }
    EXPECT_GT(stopped_while_writing, 0);
}

}  // namespace
}  // namespace trapeze::testing
