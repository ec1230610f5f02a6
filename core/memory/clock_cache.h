/// Things that are made when they are asked for and forgotten when memory is short.
#pragma once

#include <atomic>
#include <cstddef>
#include <memory>
#include <mutex>
#include <vector>

namespace trapeze {

/// A fixed number of places for things of type T, which tells the bytes() that it takes. A hand goes around
/// the places and forgets what nobody has asked for since it last came by. Threads share it.
template <class T>
class ClockCache {
  public:
    /// Things that are kept take `most_bytes`; those in use may be more.
    ClockCache(size_t count, size_t most_bytes) : most_bytes_(most_bytes), slots_(count) {}

    /// The thing with a number, below size(). make(): a shared pointer to it; it is called where the thing is
    /// not there, once for all who ask meanwhile, and must not wait for another thing of this.
    template <class Make>
    std::shared_ptr<const T> get(size_t number, const Make& make) {
        Slot& slot = slots_[number];
        std::shared_ptr<const T> made;
        {
            const std::lock_guard hold(slot.lock);
            slot.used.store(true, std::memory_order_relaxed);
            if (slot.thing) return slot.thing;
            slot.thing = made = make();
            bytes_.fetch_add(made->bytes());
        }
        if (bytes_.load() > most_bytes_) make_room();
        return made;
    }

    size_t size() const { return slots_.size(); }
    bool has(size_t number) {
        const std::lock_guard hold(slots_[number].lock);
        return slots_[number].thing != nullptr;
    }
    /// Of all that is kept, and of the places.
    size_t bytes() const { return place_bytes(slots_.size()) + bytes_.load(); }
    static constexpr size_t place_bytes(size_t count) { return count * sizeof(Slot); }

  private:
    struct Slot {
        std::mutex lock;  ///< of `thing`; held while it is made, so that it is made once
        std::shared_ptr<const T> thing;
        std::atomic<bool> used{false};  ///< since the hand came by
    };

    /// Goes around until the rest is within the budget. Places that are held are left alone; those that
    /// others keep asking for are not, the third time around.
    void make_room() {
        const std::unique_lock hold(making_room_, std::try_to_lock);
        if (!hold.owns_lock()) return;
        for (size_t seen = 0; seen < 3 * slots_.size() && bytes_.load() > most_bytes_; ++seen) {
            Slot& slot = slots_[hand_];
            hand_ = (hand_ + 1) % slots_.size();
            const std::unique_lock slot_hold(slot.lock, std::try_to_lock);
            if (!slot_hold.owns_lock() || !slot.thing) continue;
            if (slot.used.exchange(false) && seen < 2 * slots_.size()) continue;
            bytes_.fetch_sub(slot.thing->bytes());
            slot.thing.reset();
        }
    }

    const size_t most_bytes_;
    std::vector<Slot> slots_;
    std::atomic<size_t> bytes_{0};  ///< of things that are kept
    std::mutex making_room_;
    size_t hand_ = 0;  ///< the place that is looked at next when room is made
};

}  // namespace trapeze
