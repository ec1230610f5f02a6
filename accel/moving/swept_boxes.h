/// Boxes of all micropolygons at the motion keys of their grids: where each of them is at any time.
#pragma once

#include <span>
#include <vector>

#include "accel/builders/grid_summary.h"
#include "core/grid.h"
#include "core/memory/large_pages.h"

namespace trapeze {

/// Where things are at mid-shutter: the middles of their boxes, and the box of these.
struct MiddlePoints {
    UnsetVector<V3f> at;
    Box3f box;
};

/// Micropolygons count in the order of grids and then of rows. At most 2^32 places, of which those of two
/// keys have eight each.
class SweptBoxes {
  public:
    /// Of those that can be bounded, by `summaries` of all grids; others are left out. Boxes are grown so
    /// that they hold micropolygons at all times where they are taken to move linearly in between. In
    /// parallel.
    SweptBoxes(const Grids& grids, const std::vector<GridSummary>& summaries);
    /// Of all, as they are at the keys, not grown. Boxes of grids that cannot be bounded are infinite. Reads
    /// vertices once, in parallel. Sets *middles, if asked for; of what cannot be bounded to the origin.
    explicit SweptBoxes(const Grids& grids, MiddlePoints* middles = nullptr);

    size_t size() const { return size_; }
    MicropolygonId id(size_t index) const { return id_at(place(index)); }
    /// Of a SweptBoxes of all.
    size_t index_of(const MicropolygonId& id, const GridShape& shape) const {
        return first_of_grid_[id.grid] + id.v * static_cast<size_t>(shape.nu) + id.u;
    }
    /// Along the axes of space.
    std::span<const Box3f> keys(size_t index) const { return keys_at(place(index)); }
    /// Linear between the keys on both sides; times are those of the shutter, in [0, 1].
    Box3f at(size_t index, float time01) const;
    /// Of the whole of its way.
    Box3f swept(size_t index) const;

    /// Where a micropolygon's boxes are; it grows with the index. Who visits micropolygons in another order
    /// looks places up before, or keeps them instead of indices, and asks memory for each before it is read.
    size_t place(size_t index) const {
        return same_keys_ > 0 ? index * record_size(same_keys_) : first_[index];
    }
    /// Of all, by index, where grids differ in their number of keys; else none, for a product finds them.
    std::span<const uint32_t> places() const { return first_; }
    MicropolygonId id_at(size_t place) const {
        const Head& head = head_at(place);
        return {head.grid, head.u, head.v};
    }
    std::span<const Box3f> keys_at(size_t place) const {
        const Head& head = head_at(place);
        return {boxes_after(head), head.key_count};
    }
    [[gnu::always_inline]] void fetch(size_t place) const {
        __builtin_prefetch(records_.data() + place * sizeof(Head));  // of two keys all
    }
    [[gnu::always_inline]] void fetch_place(size_t index) const {
        if (same_keys_ == 0) __builtin_prefetch(&first_[index]);
    }

    size_t bytes() const {
        return records_.capacity() +
               (first_.capacity() + first_of_grid_.capacity() + first_place_of_grid_.capacity()) *
                   sizeof(uint32_t);
    }

  private:
    /// What comes before a micropolygon's boxes: what asks for them wants to know whose they are.
    struct Head {
        uint32_t grid;
        uint8_t u, v;
        uint16_t key_count;
    };
    static_assert(sizeof(Box3f) == 3 * sizeof(Head), "places count heads");
    /// In heads: a micropolygon of two keys is in one line of a cache, of one key in half of one.
    static size_t record_size(size_t key_count) { return (1 + 3 * key_count + 3) / 4 * 4; }

    /// Finds places for micropolygons of those grids that `counts` says.
    template <class Counts>
    void lay_out(const Grids& grids, const Counts& counts);
    /// Sets the heads of a grid's micropolygons, and where they are.
    void set_heads(size_t grid, const Grid& of);
    /// Boxes of the micropolygons of a grid of all, and their middles, if asked for. Returns the box of
    /// these.
    Box3f set_boxes(size_t grid, const Grid& of, V3f* middles);

    const Head& head_at(size_t place) const {
        return *reinterpret_cast<const Head*>(records_.data() + place * sizeof(Head));
    }
    static const Box3f* boxes_after(const Head& head) { return reinterpret_cast<const Box3f*>(&head + 1); }
    /// The boxes of the first micropolygon of a grid; those of the next one begin record_size() heads later.
    Box3f* boxes_of_grid(size_t grid) {
        return reinterpret_cast<Box3f*>(records_.data() + (first_place_of_grid_[grid] + 1) * sizeof(Head));
    }
    /// From a micropolygon's box on to the same of the `i`th one after it in its grid.
    static Box3f* after(Box3f* box, int i, size_t key_count) {
        return reinterpret_cast<Box3f*>(reinterpret_cast<Head*>(box) +
                                        static_cast<size_t>(i) * record_size(key_count));
    }

    size_t size_ = 0;
    size_t same_keys_ = 0;                       ///< of all grids; 0: they differ
    std::vector<uint32_t> first_of_grid_;        ///< grid -> its first micropolygon
    std::vector<uint32_t> first_place_of_grid_;  ///< in heads, as all places
    UnsetVector<uint32_t> first_;                ///< micropolygon -> its place; none if keys are one number
    UnsetVector<std::byte> records_;             ///< of each micropolygon a head and its boxes at all keys
};

}  // namespace trapeze
