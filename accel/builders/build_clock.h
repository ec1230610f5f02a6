/// How builders tell their phases [BuildPhases].
#pragma once

#include <atomic>
#include <chrono>
#include <cstdint>

namespace trapeze {

/// Tells phases that follow each other.
class PhaseClock {
  public:
    /// Seconds since the last phase ended, or since the clock was made.
    double end_phase() {
        const auto now = std::chrono::steady_clock::now();
        const double seconds = std::chrono::duration<double>(now - begin_).count();
        begin_ = now;
        return seconds;
    }

  private:
    std::chrono::steady_clock::time_point begin_ = std::chrono::steady_clock::now();
};

/// The work of all threads on something.
class WorkSum {
  public:
    /// Adds what passes while it lives. It costs some 50 ns: too much for a micropolygon, little for a node.
    class Span {
      public:
        explicit Span(WorkSum& sum) : sum_(sum) {}
        ~Span() {
            const auto passed = std::chrono::steady_clock::now() - begin_;
            sum_.nanoseconds_.fetch_add(std::chrono::nanoseconds(passed).count(), std::memory_order_relaxed);
        }
        Span(const Span&) = delete;
        Span& operator=(const Span&) = delete;

      private:
        WorkSum& sum_;
        std::chrono::steady_clock::time_point begin_ = std::chrono::steady_clock::now();
    };

    /// Of spans that have ended; more than the time that has passed where several threads work at once.
    double seconds() const {
        return static_cast<double>(nanoseconds_.load(std::memory_order_relaxed)) * 1e-9;
    }

  private:
    std::atomic<int64_t> nanoseconds_{0};
};

}  // namespace trapeze
