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

/// Micropolygons count in the order of grids and then of rows. At most 2^30 boxes.
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
    MicropolygonId id(size_t index) const {
        const Head& head = head_of(index);
        return {head.grid, head.u, head.v};
    }
    /// Of a SweptBoxes of all.
    size_t index_of(const MicropolygonId& id, const GridShape& shape) const {
        return first_of_grid_[id.grid] + id.v * static_cast<size_t>(shape.nu) + id.u;
    }
    /// Along the axes of space.
    std::span<const Box3f> keys(size_t index) const {
        const Head& head = head_of(index);
        return {boxes_after(head), head.key_count};
    }
    /// Linear between the keys on both sides; times are those of the shutter, in [0, 1].
    Box3f at(size_t index, float time01) const;
    /// Of the whole of its way.
    Box3f swept(size_t index) const;

    /// Asks memory for what id() and keys() of a micropolygon read; before that, for what fetch() reads.
    void fetch_place(size_t index) const {
        if (same_keys_ == 0) __builtin_prefetch(&first_[index]);
    }
    void fetch(size_t index) const {
        const std::byte* const record = records_.data() + place(index) * sizeof(Head);
        __builtin_prefetch(record);
        __builtin_prefetch(record + sizeof(Head) + 2 * sizeof(Box3f) - 1);  // of two keys the last byte
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
    static size_t record_size(size_t key_count) { return 1 + 3 * key_count; }  ///< heads

    /// Finds places for micropolygons of those grids that `counts` says.
    template <class Counts>
    void lay_out(const Grids& grids, const Counts& counts);
    /// Sets the heads of a grid's micropolygons, and where they are.
    void set_heads(size_t grid, const Grid& of);
    /// Boxes of the micropolygons of a grid of all, and their middles, if asked for. Returns the box of
    /// these.
    Box3f set_boxes(size_t grid, const Grid& of, V3f* middles);

    size_t place(size_t index) const {
        return same_keys_ > 0 ? index * record_size(same_keys_) : first_[index];
    }
    const Head& head_of(size_t index) const {
        return *reinterpret_cast<const Head*>(records_.data() + place(index) * sizeof(Head));
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
