/// How far a frame is.
#pragma once

#include <atomic>
#include <functional>
#include <mutex>

namespace trapeze {

/// The part of the frame that is done, 0 to 1. step() may be called from any thread; it calls back at most
/// about a hundred times a part, one call at a time, and never with a smaller number than before.
class Progress {
  public:
    explicit Progress(const std::function<void(double)>& on_progress) : on_progress_(on_progress) {}

    /// The steps to come, `steps` of them, are those from one part of the frame to another.
    void begin_part(double from, double to, size_t steps) {
        from_ = from, to_ = to, steps_ = std::max<size_t>(1, steps), done_ = 0;
    }
    void step() {
        const size_t done = done_.fetch_add(1, std::memory_order_relaxed) + 1;
        if (!on_progress_ || (done * 100 / steps_ == (done - 1) * 100 / steps_)) return;
        const std::lock_guard lock(mutex_);
        const double fraction =
            from_ + (to_ - from_) * static_cast<double>(done) / static_cast<double>(steps_);
        if (fraction < last_) return;
        last_ = fraction;
        on_progress_(fraction);
    }

  private:
    const std::function<void(double)>& on_progress_;
    std::atomic<size_t> done_{0};
    double from_ = 0, to_ = 1, last_ = 0;
    size_t steps_ = 1;
    std::mutex mutex_;
};

}  // namespace trapeze
