#pragma once

#include <chrono>
#include <utility>

namespace trapeze {

/// A running clock of wall time, in seconds.
class Stopwatch {
  public:
    /// Since it was made, or since the last lap().
    double elapsed() const { return std::chrono::duration<double>(Clock::now() - start_).count(); }
    /// The same, and begins anew.
    double lap() {
        const double seconds = elapsed();
        start_ = Clock::now();
        return seconds;
    }

  private:
    using Clock = std::chrono::steady_clock;
    Clock::time_point start_ = Clock::now();
};

/// Shares a parallel loop's wall time out in the proportion of the time that its threads spent on two kinds
/// of work.
inline std::pair<double, double> shared_out(double wall, double first, double second) {
    const double sum = first + second;
    return sum > 0 ? std::pair{wall * first / sum, wall * second / sum} : std::pair{wall, 0.0};
}

}  // namespace trapeze
