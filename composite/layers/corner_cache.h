/// What hits on micropolygons are interpolated from, kept for the next hits: samples of a tile see the same
/// few hundred micropolygons again and again, whose numbers lie all over memory.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <vector>

namespace trapeze {

/// Four corners' numbers, in the order of Grid::quad(): coordinates at a segment's first key and on to its
/// next, which are 0 where nothing moves; colours, and opacities, which are not there where the grid is
/// opaque.
struct alignas(64) MicropolygonCorners {
    float start[3][4], delta[3][4], color[3][4], opacity[3][4];
};

/// Corners by a key, in a table without lists: the later one stays. One a thread; all of the same grids until
/// forget().
class CornerCache {
  public:
    static constexpr size_t kMostInBatch = 16;

    CornerCache()
        : keys_(kEntries, kNone),
          batches_(kEntries),
          corners_(std::make_unique_for_overwrite<MicropolygonCorners[]>(kEntries + kMostInBatch)) {}

    void forget() { std::ranges::fill(keys_, kNone); }

    /// Corners that find() has handed out before may now be overwritten.
    void begin_batch() {
        ++batch_;
        spare_ = kEntries;
    }
    /// The corners of a key, which fill(corners) writes where they are not known. A batch asks for
    /// kMostInBatch at most.
    template <class Fill>
    const MicropolygonCorners* find(uint64_t key, const Fill& fill) {
        const size_t entry = key * 0x9E3779B97F4A7C15u >> (64 - kEntryBits);
        MicropolygonCorners* corners = &corners_[entry];
        if (keys_[entry] != key) {
            if (batches_[entry] == batch_) {  // somebody still needs what is there
                corners = &corners_[spare_++];
                fill(*corners);
                return corners;
            }
            keys_[entry] = key;
            fill(*corners);
        }
        batches_[entry] = batch_;
        return corners;
    }

  private:
    static constexpr int kEntryBits = 9;
    static constexpr size_t kEntries = size_t{1} << kEntryBits;  ///< 100 KB, for the second cache
    static constexpr uint64_t kNone = ~uint64_t{0};

    std::vector<uint64_t> keys_;
    std::vector<uint32_t> batches_;  ///< in which an entry was last asked for
    std::unique_ptr<MicropolygonCorners[]> corners_;
    uint32_t batch_ = 0;
    size_t spare_ = kEntries;
};

}  // namespace trapeze
