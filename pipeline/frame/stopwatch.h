#pragma once

#include <chrono>

namespace trapeze {

/// Wall seconds since it was made or lapped.
class Stopwatch {
  public:
    double elapsed() const { return std::chrono::duration<double>(Clock::now() - start_).count(); }
    double lap() {
        const double seconds = elapsed();
        start_ = Clock::now();
        return seconds;
    }

  private:
    using Clock = std::chrono::steady_clock;
    Clock::time_point start_ = Clock::now();
};

}  // namespace trapeze
