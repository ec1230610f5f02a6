#include "sample/loose_hits.h"

#include <algorithm>

namespace trapeze {
namespace {

/// Lists are not cut before they hold this much.
constexpr size_t kLeastRoom = 4096;

}  // namespace

/// The room is the window's, or less where few layers are wanted. `full_` starts at the capacity that is
/// there already, so that no tile allocates what an earlier one has.
void LooseHits::begin(size_t sample_count, const LayerWindow& window) {
    window_ = window;
    sample_count_ = sample_count;
    // Twice what is wanted: each time that there is no room, half of it goes at least.
    room_ = window.room;
    if (const size_t wanted = size_t{window.most} * sample_count; wanted < window.room / 2)
        room_ = std::max(2 * wanted, std::min(kLeastRoom, window.room));
    full_ = std::min(entries_.capacity(), room_);
    entries_.clear();
    cut_at_.clear();
}

/// Makes room for a hit; false when the hit does not count any more. Memory is taken by doubling up to the
/// limit; only then are far hits given up, which costs another pass.
bool LooseHits::make_room(uint32_t sample, const Hit& hit) {
    if (entries_.capacity() < room_) {
        entries_.reserve(std::min(room_, std::max(kLeastRoom, 2 * entries_.capacity())));
        full_ = std::min(entries_.capacity(), room_);
        return true;
    }
    drop_far();
    return cut_at_.empty() || !in_front(cut_at_[sample], hit);
}

/// Keeps as many hits of each sample as half of the room has place for, the nearest; one at least. Half of
/// the room, so that the sort is not needed again after a few more hits.
void LooseHits::drop_far() {
    std::sort(entries_.begin(), entries_.end(), [](const Entry& a, const Entry& b) {
        return a.sample != b.sample ? a.sample < b.sample : in_front(a.hit(), b.hit());
    });
    size_t samples = 0;
    for (size_t i = 0; i < entries_.size(); ++i)
        samples += i == 0 || entries_[i].sample != entries_[i - 1].sample;
    const size_t most = std::min<size_t>(window_.most, std::max<size_t>(1, room_ / 2 / samples));
    size_t kept = 0;
    for (size_t i = 0; i < entries_.size();) {
        const uint32_t sample = entries_[i].sample;
        const size_t first = i, last = std::min(entries_.size(), first + most);
        for (; i < entries_.size() && entries_[i].sample == sample; ++i)
            if (i < last) entries_[kept++] = entries_[i];
        if (i > last) cut(sample, entries_[kept - 1].hit());
    }
    entries_.resize(kept);
    // One of each sample may be more than half of the room.
    room_ = std::max(room_, 2 * kept);
    full_ = std::min(entries_.capacity(), room_);
    if (kept >= full_) {
        entries_.reserve(room_);
        full_ = room_;
    }
}

/// The nearest of all cuts of a sample counts: what was dropped behind it cannot be told from what was never
/// found.
void LooseHits::cut(uint32_t sample, const Hit& at) {
    if (cut_at_.empty()) cut_at_.assign(sample_count_, kBehindAll);
    if (in_front(at, cut_at_[sample])) cut_at_[sample] = at;
}

}  // namespace trapeze
