#include "pipeline/cli/support/interrupt.h"

#include <poll.h>
#include <unistd.h>

#include <csignal>
#include <utility>

#include "composite/displays/write_displays.h"
#include "pipeline/cli/support/exit_codes.h"
#include "pipeline/rib/programs/programs.h"

namespace trapeze {
namespace {

// A signal handler can reach nothing but globals; these are the process's.
volatile std::sig_atomic_t g_signal = 0;
std::atomic<bool> g_requested{false};
static_assert(std::atomic<bool>::is_always_lock_free, "signal handlers may not wait");

/// Work is asked to stop at once: a signal may break off what the process waits for, a file that is being
/// written for one, and that is no failure of its own.
void on_signal(int signal) {
    g_signal = signal;
    g_requested = true;
}

/// How often the watcher looks for a signal, and how long work that has been asked to stop may take.
constexpr auto kPoll = std::chrono::milliseconds(20);
constexpr auto kPatience = std::chrono::milliseconds(700);

/// Without waiting for a reader who has gone to sleep.
void say_to_stderr(const std::string& text) {
    pollfd ready{STDERR_FILENO, POLLOUT, 0};
    if (poll(&ready, 1, 0) == 1) static_cast<void>(!write(STDERR_FILENO, text.data(), text.size()));
}

}  // namespace

std::string time_limit_message() {
    return "the time limit is reached; what was not done is left out";
}

Interrupt::Interrupt(std::optional<double> time_limit, std::function<void()> before_end)
    : before_end_(std::move(before_end)) {
    if (time_limit)
        deadline_ = Clock::now() +
                    std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(*time_limit));
    g_signal = 0;
    g_requested = false;
    std::signal(SIGINT, on_signal);
    std::signal(SIGTERM, on_signal);
    watcher_ = std::thread([this] { watch(); });
}

Interrupt::~Interrupt() {
    {
        const std::lock_guard lock(mutex_);
        done_ = true;
    }
    ended_.notify_all();
    watcher_.join();
    std::signal(SIGINT, SIG_DFL);
    std::signal(SIGTERM, SIG_DFL);
}

const std::atomic<bool>& Interrupt::requested() const {
    return g_requested;
}

int Interrupt::exit_code() const {
    if (too_late_) return kExitTimeLimit;
    return 128 + (g_signal ? static_cast<int>(g_signal) : SIGINT);
}

/// Commands take less time than is between two looks: they must not wait for the next.
void Interrupt::pause() {
    std::unique_lock lock(mutex_);
    ended_.wait_for(lock, kPoll, [this] { return done_.load(); });
}

void Interrupt::watch() {
    while (!done_ && g_signal == 0 && !(deadline_ && !unlimited_ && Clock::now() >= *deadline_)) pause();
    if (done_) return;
    too_late_ = g_signal == 0;
    g_requested = true;
    const auto asked = Clock::now();
    while (!done_ && Clock::now() - asked < kPatience) pause();
    if (done_) return;
    if (before_end_) before_end_();
    if (done_) return;
    remove_partial_outputs();
    rib::end_all_programs();
    if (too_late_) say_to_stderr("error: " + time_limit_message() + "\n");
    _exit(exit_code());
}

}  // namespace trapeze
