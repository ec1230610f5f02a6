/// Ctrl-C and SIGTERM: work is asked to stop; if it has not within most of a second, the process ends at
/// once. Outputs that are being written are temporary files until they are renamed, and those are
/// removed; programs that scenes have started are ended.
#pragma once

#include <atomic>
#include <thread>

namespace trapeze {

/// At most one at a time in a process.
class Interrupt {
  public:
    Interrupt();
    ~Interrupt();
    Interrupt(const Interrupt&) = delete;
    Interrupt& operator=(const Interrupt&) = delete;

    const std::atomic<bool>& requested() const { return requested_; }
    int exit_code() const;  ///< 130 or 143 once requested

  private:
    void watch();

    std::atomic<bool> requested_{false}, done_{false};
    std::thread watcher_;
};

}  // namespace trapeze
