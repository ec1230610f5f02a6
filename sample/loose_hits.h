/// Hits of a tile's samples as methods find them, in whatever order, and as few of them as are wanted: the
/// nearest ones of each sample, behind where an earlier pass has ended, within a bound of memory
/// [decision 0032].
#pragma once

#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include "core/hit_buffer.h"
#include "core/scene/layer_limit.h"

namespace trapeze {

/// The place behind every hit: a sample that wants hits behind it wants none.
inline constexpr Hit kBehindAll{std::numeric_limits<float>::infinity(), MicropolygonId::kNone};
/// The place in front of every hit.
inline constexpr Hit kInFrontOfAll{-std::numeric_limits<float>::infinity(), 0};

/// Which hits of a tile's samples a method is to find. Methods may find more, but then all that there are:
/// LooseHits::cut_at() tells.
struct LayerWindow {
    std::span<const Hit> behind;  ///< sample -> only hits behind this count; empty: all do
    uint32_t most = kAllLayers;   ///< of each sample only so many count, the nearest
    /// Hits that may be held at once, of all samples together. At least one for each sample is kept.
    size_t room = std::numeric_limits<size_t>::max();

    /// Whether anything is wanted of a sample.
    bool wants(size_t sample) const { return behind.empty() || behind[sample].id != MicropolygonId::kNone; }
};

/// One a thread. Holds all hits until there is no room for more; then what lies behind the nearest few of
/// each sample is dropped, and nothing behind these is taken in again.
class LooseHits {
  public:
    /// A hit with the sample that it belongs to; in the order in which they came.
    struct Entry {
        float depth;
        uint32_t sample;
        uint64_t id;

        Hit hit() const { return {depth, id}; }
    };

    /// Forgets all; `window` is kept as it is, with what its span refers to.
    void begin(size_t sample_count, const LayerWindow& window = {});

    void add(uint32_t sample, const Hit& hit) {
        if (!window_.behind.empty() && !in_front(window_.behind[sample], hit)) return;
        if (!cut_at_.empty() && in_front(cut_at_[sample], hit)) return;
        if (entries_.size() >= full_ && !make_room(sample, hit)) return;
        entries_.push_back({hit.depth, sample, hit.id});
    }

    /// Says that of a sample nothing behind this hit was looked for.
    void cut(uint32_t sample, const Hit& at);
    /// Says that nothing lies behind what was found of a sample.
    void close(size_t sample) {
        if (!cut_at_.empty()) cut_at_[sample] = kBehindAll;
    }

    const LayerWindow& window() const { return window_; }
    std::span<const Entry> entries() const { return entries_; }
    /// Of a sample: the hit behind which nothing was looked for; kBehindAll where all was found.
    Hit cut_at(size_t sample) const { return cut_at_.empty() ? kBehindAll : cut_at_[sample]; }
    bool is_cut() const { return !cut_at_.empty(); }
    size_t bytes() const { return entries_.capacity() * sizeof(Entry); }

  private:
    /// Whether the hit may be added; what is far goes first when there are too many.
    bool make_room(uint32_t sample, const Hit& hit);
    void drop_far();

    LayerWindow window_;
    size_t sample_count_ = 0;
    size_t room_ = 0;  ///< entries that there may be
    size_t full_ = 0;  ///< entries at which room must be made: by memory, or by dropping some
    std::vector<Entry> entries_;
    std::vector<Hit> cut_at_;  ///< by sample; empty until one is cut
};

}  // namespace trapeze
