#include "pipeline/preview/preview_board.h"

#include <algorithm>

namespace trapeze {

void PreviewBoard::begin_picture(PreviewEntry entry) {
    {
        const std::lock_guard lock(mutex_);
        entry.number = ++count_;
        pictures_.push_back(entry);
        forget_old_pictures();
        status_.entry = std::move(entry);
        status_.fraction = 0, status_.stage.clear();
        begun_ = std::chrono::steady_clock::now();
        ++status_.version;
    }
    changed_.notify_all();
}

void PreviewBoard::forget_old_pictures() {
    size_t bytes = 0, kept = 1;
    while (kept < std::min(pictures_.size(), kPicturesKept)) {
        bytes += pictures_[pictures_.size() - 1 - kept].picture->bytes();
        if (bytes > most_bytes_) break;
        ++kept;
    }
    while (pictures_.size() > kept) pictures_.pop_front();
}

void PreviewBoard::begin_stage(std::string_view name) {
    {
        const std::lock_guard lock(mutex_);
        status_.stage = name;
        ++status_.version;
    }
    changed_.notify_all();
}

void PreviewBoard::progress(double fraction) {
    {
        const std::lock_guard lock(mutex_);
        status_.fraction = fraction;
        ++status_.version;
    }
    changed_.notify_all();
}

void PreviewBoard::note_change() {
    {
        const std::lock_guard lock(mutex_);
        ++status_.version;
    }
    changed_.notify_all();
}

void PreviewBoard::end() {
    {
        const std::lock_guard lock(mutex_);
        if (!status_.ended) ended_at_ = std::chrono::steady_clock::now();
        status_.ended = true;
        ++status_.version;
    }
    changed_.notify_all();
}

PreviewStatus PreviewBoard::status_now() const {
    PreviewStatus now = status_;
    if (count_ > 0)
        now.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begun_).count();
    return now;
}

PreviewStatus PreviewBoard::status() const {
    const std::lock_guard lock(mutex_);
    return status_now();
}

std::chrono::milliseconds PreviewBoard::time_for_viewers() const {
    using namespace std::chrono;
    const std::lock_guard lock(mutex_);
    if (!status_.ended) return longest_end_;
    const auto left = duration_cast<milliseconds>(ended_at_ + longest_end_ - steady_clock::now());
    return std::max(left, milliseconds(0));
}

PreviewEntry PreviewBoard::picture(int number) const {
    const std::lock_guard lock(mutex_);
    for (const PreviewEntry& entry : pictures_)
        if (entry.number == number) return entry;
    return {};
}

PreviewStatus PreviewBoard::wait(uint64_t version, std::chrono::milliseconds at_most) const {
    std::unique_lock lock(mutex_);
    changed_.wait_for(lock, at_most, [&] { return status_.version > version || status_.ended; });
    return status_now();
}

PreviewEntry PreviewBoard::wait_for_picture_after(int number) const {
    std::unique_lock lock(mutex_);
    changed_.wait(lock, [&] { return count_ > number || status_.ended; });
    for (const PreviewEntry& entry : pictures_)
        if (entry.number > number) return entry;
    return {};
}

}  // namespace trapeze
