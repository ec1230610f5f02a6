#include "pipeline/cli/interrupt.h"

#include <unistd.h>

#include <chrono>
#include <csignal>

#include "composite/write_displays.h"
#include "pipeline/rib/programs.h"

namespace trapeze {
namespace {

// A signal handler can reach nothing but a global; this is the process's one.
volatile std::sig_atomic_t g_signal = 0;

void on_signal(int signal) {
    g_signal = signal;
}

constexpr auto kPoll = std::chrono::milliseconds(20);
constexpr auto kPatience = std::chrono::milliseconds(700);

}  // namespace

Interrupt::Interrupt() {
    g_signal = 0;
    std::signal(SIGINT, on_signal);
    std::signal(SIGTERM, on_signal);
    watcher_ = std::thread([this] { watch(); });
}

Interrupt::~Interrupt() {
    done_ = true;
    watcher_.join();
    std::signal(SIGINT, SIG_DFL);
    std::signal(SIGTERM, SIG_DFL);
}

int Interrupt::exit_code() const {
    return 128 + (g_signal ? static_cast<int>(g_signal) : SIGINT);
}

void Interrupt::watch() {
    while (!done_ && g_signal == 0) std::this_thread::sleep_for(kPoll);
    if (done_) return;
    requested_ = true;
    const auto asked = std::chrono::steady_clock::now();
    while (!done_ && std::chrono::steady_clock::now() - asked < kPatience) std::this_thread::sleep_for(kPoll);
    if (done_) return;
    remove_partial_outputs();
    rib::end_all_programs();
    _exit(exit_code());
}

}  // namespace trapeze
