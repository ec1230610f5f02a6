/// Ctrl-C and SIGTERM: work is asked to stop; if it has not within most of a second, the process ends at
/// once. Outputs that are being written are temporary files until they are renamed, and those are removed.
#pragma once

#include <atomic>
#include <functional>
#include <thread>

namespace trapeze {

/// At most one at a time in a process.
class Interrupt {
  public:
    /// `clean_up` is called before a forced end, from a thread of its own.
    explicit Interrupt(std::function<void()> clean_up);
    ~Interrupt();
    Interrupt(const Interrupt&) = delete;
    Interrupt& operator=(const Interrupt&) = delete;

    const std::atomic<bool>& requested() const { return requested_; }
    int exit_code() const;  ///< 130 or 143 once requested

  private:
    void watch();

    std::function<void()> clean_up_;
    std::atomic<bool> requested_{false}, done_{false};
    std::thread watcher_;
};

}  // namespace trapeze
