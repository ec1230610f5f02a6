/// The names of the files that a run has opened to read: what its result depends on.
#pragma once

#include <mutex>
#include <set>
#include <string>

namespace trapeze {

/// Thread-safe.
class ReadNames {
  public:
    void add(const std::string& name) {
        const std::lock_guard lock(mutex_);
        names_.insert(name);
    }
    std::set<std::string> names() const {
        const std::lock_guard lock(mutex_);
        return names_;
    }

  private:
    mutable std::mutex mutex_;
    std::set<std::string> names_;
};

}  // namespace trapeze
