/// Boxes of all micropolygons at the motion keys of their grids: where each of them is at any time.
#pragma once

#include <span>
#include <vector>

#include "accel/builders/grid_summary.h"
#include "accel/builders/unset_array.h"
#include "core/grid.h"

namespace trapeze {

/// Micropolygons count in the order of grids and then of rows. At most 2^32 boxes.
class SweptBoxes {
  public:
    /// Of those that can be bounded, by `summaries` of all grids; others are left out. Boxes are grown so
    /// that they hold micropolygons at all times where they are taken to move linearly in between. In
    /// parallel.
    SweptBoxes(const Grids& grids, const std::vector<GridSummary>& summaries);
    /// Of all, as they are at the keys, not grown. Boxes of grids that cannot be bounded are infinite. Reads
    /// vertices once, in parallel.
    explicit SweptBoxes(const Grids& grids);

    size_t size() const { return ids_.size(); }
    const MicropolygonId& id(size_t index) const { return ids_[index]; }
    /// Of a SweptBoxes of all.
    size_t index_of(const MicropolygonId& id, const GridShape& shape) const {
        return first_of_grid_[id.grid] + id.v * static_cast<size_t>(shape.nu) + id.u;
    }
    /// Along the axes of space.
    std::span<const Box3f> keys(size_t index) const {
        const size_t first = first_box(index);
        return {boxes_.data() + first, first_box(index + 1) - first};
    }
    /// Linear between the keys on both sides; times are those of the shutter, in [0, 1].
    Box3f at(size_t index, float time01) const;
    /// Of the whole of its way.
    Box3f swept(size_t index) const;

    /// Asks memory for what id() and keys() of a micropolygon read.
    void fetch(size_t index) const {
        const auto* const boxes = reinterpret_cast<const char*>(boxes_.data() + first_box(index));
        __builtin_prefetch(&ids_[index]);
        __builtin_prefetch(boxes);
        __builtin_prefetch(boxes + 47);  // the last byte of two keys, which may be in another line
    }

    size_t bytes() const {
        return ids_.bytes() + first_.bytes() + boxes_.bytes() + first_of_grid_.capacity() * sizeof(uint32_t);
    }

  private:
    /// Finds places for micropolygons of those grids that `counts` says.
    template <class Counts>
    void lay_out(const Grids& grids, const Counts& counts);
    size_t first_box(size_t index) const { return same_keys_ > 0 ? index * same_keys_ : first_[index]; }

    size_t same_keys_ = 0;                 ///< of all grids; 0: they differ
    std::vector<uint32_t> first_of_grid_;  ///< grid -> its first micropolygon
    std::vector<uint32_t> first_box_of_grid_;
    UnsetArray<MicropolygonId> ids_;
    UnsetArray<uint32_t>
        first_;  ///< micropolygon -> its first box, one more than those; none if keys are one number
    UnsetArray<Box3f> boxes_;
};

}  // namespace trapeze
