/// Ctrl-C, SIGTERM and the time limit: work is asked to stop; if it has not within most of a second, the
/// process ends at once. Outputs that are being written are temporary files until they are renamed, and those
/// are removed; programs that scenes have started are ended.
#pragma once

#include <atomic>
#include <chrono>
#include <condition_variable>
#include <functional>
#include <mutex>
#include <optional>
#include <string>
#include <thread>

namespace trapeze {

/// The message when the time limit ends the work.
std::string time_limit_message();

/// Watches for signals and the time limit in a thread of its own, as long as it lives. At most one in a
/// process.
class Interrupt {
  public:
    /// `time_limit`: seconds from now. `before_end` is called by the watcher where work has not stopped in
    /// time, before the process ends.
    explicit Interrupt(std::optional<double> time_limit = {}, std::function<void()> before_end = {});
    ~Interrupt();
    Interrupt(const Interrupt&) = delete;
    Interrupt& operator=(const Interrupt&) = delete;

    const std::atomic<bool>& requested() const;
    int exit_code() const;  ///< 130, 143 or 8 once requested
    /// The work is done: what is left to do has no time limit.
    void lift_time_limit() { unlimited_ = true; }

  private:
    using Clock = std::chrono::steady_clock;
    void watch();
    /// Until it is time to look again, or the end.
    void pause();

    std::optional<Clock::time_point> deadline_;
    const std::function<void()> before_end_;
    std::atomic<bool> done_{false}, too_late_{false}, unlimited_{false};
    std::mutex mutex_;  ///< for the end alone
    std::condition_variable ended_;
    std::thread watcher_;
};

}  // namespace trapeze
