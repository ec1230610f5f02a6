/// Boxes of all micropolygons at the motion keys of their grids: where each of them is at any time.
#pragma once

#include <span>
#include <vector>

#include "accel/builders/grid_summary.h"
#include "core/grid.h"

namespace trapeze {

/// Micropolygons count in the order of grids and then of rows. Those of grids that cannot be bounded are left
/// out.
class SweptBoxes {
  public:
    /// `summaries`: of all grids. In parallel. At most 2^32 boxes.
    SweptBoxes(const Grids& grids, const std::vector<GridSummary>& summaries);

    size_t size() const { return ids_.size(); }
    const MicropolygonId& id(size_t index) const { return ids_[index]; }
    /// Along the axes of space, grown so that they hold it at all times where they are taken to move linearly
    /// in between.
    std::span<const Box3f> keys(size_t index) const {
        return {boxes_.data() + first_[index], first_[index + 1] - first_[index]};
    }
    Box3f at(size_t index, float time01) const;
    /// Of the whole of its way.
    Box3f swept(size_t index) const;

    size_t bytes() const {
        return ids_.capacity() * sizeof(MicropolygonId) + first_.capacity() * sizeof(uint32_t) +
               boxes_.capacity() * sizeof(Box3f);
    }

  private:
    std::vector<MicropolygonId> ids_;
    std::vector<uint32_t> first_;  ///< micropolygon -> its first box; one more than micropolygons
    std::vector<Box3f> boxes_;
};

}  // namespace trapeze
