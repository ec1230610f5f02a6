/// Programs that run beside the reader. Each is the leader of a process group of its own: what it starts ends
/// with it, and a key pressed in our terminal does not reach it.
#include "pipeline/rib/programs/programs.h"

#include <fcntl.h>
#include <signal.h>
#include <spawn.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <atomic>
#include <cerrno>
#include <chrono>
#include <cstring>
#include <utility>

#include "pipeline/rib/programs/find_program.h"

extern char** environ;

namespace trapeze::rib {
namespace {

using Clock = std::chrono::steady_clock;

/// The most programs of one reading; a scene that names more is a mistake or worse.
constexpr size_t kMostPrograms = 64;
constexpr std::chrono::milliseconds kTimeToEnd{500};  ///< after its input is closed

/// Process groups of the programs that this process runs; 0: a free place. A forced end finds them here. Four
/// readings at once have room; what finds no place is only missed by a forced end.
std::array<std::atomic<pid_t>, 4 * kMostPrograms> g_groups;

/// Takes or frees a place without a lock: a signal handler may read at any time.
void note_group(pid_t from, pid_t to) {
    for (std::atomic<pid_t>& group : g_groups)
        if (pid_t expected = from; group.compare_exchange_strong(expected, to)) return;
}

}  // namespace

/// A file's descriptor, closed at the end. Moved by exchange: the one that was held goes to the other, and is
/// closed with it.
class Descriptor {
  public:
    explicit Descriptor(int fd = -1) : fd_(fd) {}
    Descriptor(Descriptor&& other) noexcept : fd_(std::exchange(other.fd_, -1)) {}
    Descriptor& operator=(Descriptor&& other) noexcept {
        std::swap(fd_, other.fd_);
        return *this;
    }
    ~Descriptor() { close(); }
    void close() {
        if (fd_ >= 0) ::close(std::exchange(fd_, -1));
    }
    int get() const { return fd_; }

  private:
    int fd_;
};

/// One program that runs, or has been ended.
class Programs::Program {
  public:
    /// Why it cannot be started, or nothing.
    std::string start(Command words, const std::vector<std::string>& folders);
    ProgramAnswer ask(const std::string& request, const AnswerLimits& limits) {
        return ask_program(input_.get(), output_.get(), request, limits);
    }
    ~Program() { stop(kTimeToEnd); }

  private:
    void stop(std::chrono::milliseconds time);

    // The number is the child's and its group's alike, as it leads one; -1: not running.
    pid_t pid_ = -1;
    Descriptor input_,
        output_;  ///< the program's; its input is a socket, which can be written without a signal
};

/// Descriptors close on exec but for the two that become its standard input and output; its standard error is
/// ours.
std::string Programs::Program::start(Command words, const std::vector<std::string>& folders) {
    if (words.empty()) return "there is no command";
    const std::string path = program_path(words[0], folders);
    int ends[2], pipe_ends[2];
    if (socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0, ends) != 0) return std::strerror(errno);
    input_ = Descriptor(ends[0]);
    const Descriptor its_input(ends[1]);
    if (pipe2(pipe_ends, O_CLOEXEC) != 0) return std::strerror(errno);
    output_ = Descriptor(pipe_ends[0]);
    const Descriptor its_output(pipe_ends[1]);

    posix_spawn_file_actions_t actions;
    posix_spawn_file_actions_init(&actions);
    posix_spawn_file_actions_adddup2(&actions, its_input.get(), STDIN_FILENO);
    posix_spawn_file_actions_adddup2(&actions, its_output.get(), STDOUT_FILENO);
    posix_spawnattr_t attributes;
    posix_spawnattr_init(&attributes);
    posix_spawnattr_setflags(&attributes, POSIX_SPAWN_SETPGROUP);
    std::vector<char*> arguments;
    for (std::string& word : words) arguments.push_back(word.data());
    arguments.push_back(nullptr);
    const int error = posix_spawnp(&pid_, path.c_str(), &actions, &attributes, arguments.data(), environ);
    posix_spawnattr_destroy(&attributes);
    posix_spawn_file_actions_destroy(&actions);
    if (error == 0) {
        note_group(0, pid_);
        return {};
    }
    pid_ = -1;
    return std::strerror(error);
}

/// Ends the program and its process group: closes its pipes, waits up to `time` for it to leave by itself,
/// then kills the group.
void Programs::Program::stop(std::chrono::milliseconds time) {
    input_.close();
    output_.close();
    if (pid_ < 0) return;
    bool ended = false;
    for (const auto until = Clock::now() + time; !ended && Clock::now() < until;) {
        ended = waitpid(pid_, nullptr, WNOHANG) == pid_;
        if (!ended) usleep(2000);
    }
    kill(-pid_, SIGKILL);
    note_group(pid_, 0);
    if (!ended) waitpid(pid_, nullptr, 0);
    pid_ = -1;
}

Programs::Programs() = default;
Programs::~Programs() = default;

/// A program that failed once is not asked again: each failure may cost the whole time limit.
ProgramAnswer Programs::ask(const Command& command, const std::string& request,
                            const std::vector<std::string>& folders, const AnswerLimits& limits) {
    const auto known = programs_.find(command);
    if (known != programs_.end() && !known->second) return {{}, "has failed before"};
    if (known == programs_.end()) {
        if (programs_.size() >= kMostPrograms)
            return {{}, "is one of more than " + std::to_string(kMostPrograms) + " programs"};
        auto program = std::make_unique<Program>();
        if (const std::string problem = program->start(command, folders); !problem.empty()) {
            programs_[command] = nullptr;
            return {{}, "cannot be started: " + problem};
        }
        programs_[command] = std::move(program);
    }
    ProgramAnswer answer = programs_[command]->ask(request, limits);
    if (!answer.problem.empty()) programs_[command] = nullptr;
    return answer;
}

/// Safe in a signal handler: it takes no lock and allocates nothing.
void end_all_programs() {
    for (const std::atomic<pid_t>& group : g_groups)
        if (const pid_t leader = group; leader > 0) kill(-leader, SIGKILL);
}

}  // namespace trapeze::rib
