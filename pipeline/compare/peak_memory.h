/// The most memory that the process takes while something is done.
#pragma once

#include <cstddef>
#include <optional>

namespace trapeze {

/// Begins when it is made. The system's own mark of the process is used, which is for one at a time; pages
/// are what it counts.
class PeakMemory {
  public:
    PeakMemory();

    /// Bytes beyond what there was at the beginning, at most at a time; nothing where the system does not
    /// tell (Linux does, where a process may write to its own /proc/self/clear_refs).
    std::optional<size_t> bytes() const;

  private:
    std::optional<size_t> before_;
};

}  // namespace trapeze
